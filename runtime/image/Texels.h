//===- Texels.h - images as samplers read them ----------------------------===//
//
// The memory of library/std/images/ImageTexels.rtsl: texels of 1, 2 or 4 channels, packed into
// words, rows from the bottom, slices from the front, with the smaller levels after the image.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "support/Error.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// The numbers are those of ImageTexels.rtsl.
enum class TexelFormat : std::uint8_t { Unorm8 = 0, Srgb8, Unorm16, Float16, Float32 };

/// 1, 2 or 4.
std::uint32_t bytesOf(TexelFormat format);

/// Converts a channel of a texel to a number, and back.
class ChannelCodec {
public:
  explicit ChannelCodec(TexelFormat format);

  /// Linear.
  double decode(const std::uint8_t *bytes, bool isAlpha) const;
  void encode(double value, bool isAlpha, std::uint8_t *bytes) const;

private:
  TexelFormat format;
  std::array<float, 256> linear; // by value in sRGB
};

struct Texels {
  TexelFormat format = TexelFormat::Float32;
  std::uint32_t width = 1, height = 1, depth = 1;
  std::uint32_t channels = 4;
  std::vector<std::uint32_t> words;
  std::vector<std::uint32_t> levelStarts = {0}; // by level: the number of texels before it
};

/// The most bytes of the pixels of a file.
constexpr std::uint64_t mostImageBytes = std::uint64_t(1) << 33;

enum class ColorSpace : std::uint8_t { ByFile, Linear, Srgb };

/// A plane of pixels, rows from the top, channels of a pixel side by side.
struct Pixels {
  TexelFormat format = TexelFormat::Float32;
  std::uint32_t width = 0, height = 0, channels = 0;
  bool isSecondAlpha = false; // of two channels
  std::vector<std::uint8_t> bytes;
};

/// Reads an image file in any format of OpenImageIO: PNG, JPEG, TIFF, Radiance HDR, OpenEXR and
/// others. Channels keep 8 or 16 bits, half or float. ColorSpace::ByFile: what the file says, or
/// its format implies; otherwise 8 bits are sRGB and all others linear. sRGB of 16 bits becomes
/// float. Throws FileNotFound,
/// FileUnreadable, BadImage, OutOfRange.
Pixels readPixels(const std::string &path, ColorSpace space);
/// The same for the bytes of a file in memory, in a format that OpenImageIO reads from there: PNG,
/// JPEG and some others. `name` is for messages.
Pixels decodePixels(const std::string &bytes, const std::string &name, ColorSpace space);

/// The slices of an image, of equal size and kind, from front to back. Three channels get an alpha
/// of 1, two without alpha a third one of 0, too; of more than four the first four are taken.
/// Throws OutOfRange if there are more than 2^31 - 1 texels or words.
Texels texelsOf(const std::vector<Pixels> &slices);

/// Texels of as many bytes as the shape has, little-endian, in the order of texels. Throws
/// OutOfRange, like texelsOf.
Texels texelsOfBytes(const void *bytes, Texels shape);

/// The bytes of a file as texels, little-endian, in their order. Throws BadImage if there are more
/// or fewer, and the errors of reading a file.
Texels readRawTexels(const std::string &path, Texels shape);

/// Channels of texels that are not finite: how many, and the first one, with its value, its name,
/// such as "red", and its column and row from the upper left corner of its slice.
struct NotFiniteTexels {
  std::size_t count = 0;
  float value = 0;
  const char *channel = "";
  std::uint32_t column = 0, row = 0, slice = 0;
};
/// Sets them to 0, and says which they were.
NotFiniteTexels dropNotFinite(Texels &texels);

/// Texels with a color (not alpha) below 0: how many, the lowest value, and the first one, by its
/// column and row from the upper left corner.
struct NegativeTexels {
  std::size_t count = 0;
  float lowest = 0;
  std::uint32_t column = 0, row = 0;
};
/// Those of the first slice. Formats that are no floats have none.
NegativeTexels negativeTexels(const Texels &texels);

/// Leaves out channels that nothing reads, before levels are added: `read` has bits 0 to 3 for red,
/// green, blue and alpha. What is read has the same values and bits. An image of which one color is
/// read becomes a grey one of that color, with alpha if that is read, too; others stay as they are.
void dropChannels(Texels &texels, std::uint32_t read);

/// Adds levels until one has a single texel. A texel is the mean of the area that it covers in the
/// level before, of linear values, rounded to the format. Throws OutOfRange, like texelsOf.
void addLevels(Texels &texels);

} // namespace rtsl::runtime
