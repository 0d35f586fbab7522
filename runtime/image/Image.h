//===- Image.h - pictures in memory and in files --------------------------===//
#pragma once

#include "support/Error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// Linear light, `channels` floats per pixel, rows from the top.
struct Image {
  std::uint32_t width = 0, height = 0, channels = 3;
  std::vector<float> pixels;

  /// For a part of a larger picture: where it begins in the whole, and the size of the whole. 0:
  /// the picture is whole.
  std::uint32_t left = 0, top = 0, wholeWidth = 0, wholeHeight = 0;

  Image() = default;
  Image(std::uint32_t width, std::uint32_t height, std::uint32_t channels)
      : width(width), height(height), channels(channels),
        pixels(std::size_t(width) * height * channels, 0.0f) {}

  float *at(std::uint32_t x, std::uint32_t y) {
    return pixels.data() + (std::size_t(y) * width + x) * channels;
  }
  const float *at(std::uint32_t x, std::uint32_t y) const {
    return pixels.data() + (std::size_t(y) * width + x) * channels;
  }
};

/// A black picture. Throws OutOfMemory.
Image newImage(std::uint32_t width, std::uint32_t height, std::uint32_t channels);

/// Red, green and blue of an image with N channels, by language/ColorBasis.h. 3: unchanged. 1:
/// grey.
Image toRgb(const Image &image);

/// The file format of a picture. ByName: by the extension of the file name; PNG for "-".
enum class PictureFormat : std::uint8_t { ByName, Png, Exr };

/// Throws FileUnwritable or UnsupportedFormat now if `writeImage(path, ...)` could not succeed
/// later: unknown extension, missing or read-only folder, a folder of that name. For use before a
/// long rendering.
void checkWritable(const std::string &path, PictureFormat format = PictureFormat::ByName);

/// Writes .exr (32-bit float, R G B, Y for one channel, or C0 C1 ... for others) or .png (8 bit,
/// sRGB, clamped to [0, 1], NaN becomes black). The file is written completely or not at all; "-"
/// is standard output. Throws FileUnwritable, UnsupportedFormat.
void writeImage(const std::string &path, const Image &image,
                PictureFormat format = PictureFormat::ByName);

/// Reads the formats of writeImage (any EXR of float or half channels, any PNG); PNG values are
/// converted to linear. "-" is standard input, whose first bytes determine the format. Throws
/// FileNotFound, FileUnreadable, UnsupportedFormat, BadImage.
Image readImage(const std::string &path);

/// Linear to sRGB and back (IEC 61966-2-1:1999), both in [0, 1].
float encodeSrgb(float linear);
float decodeSrgb(float encoded);

} // namespace rtsl::runtime
