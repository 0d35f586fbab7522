//===- ImageClaim.h - whether a file can hold the image that it claims ----===//
//
// A header of some hundred bytes can claim gigabytes, for which readers get memory before they find
// that the pixels are not there. What it claims is compared with the size of the file first.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace rtsl::runtime {

/// What the header of an image file says, of all channels that are decoded. Names of formats and
/// compressions are those of OpenImageIO.
struct ImageClaim {
  std::string format, compression;
  std::uint64_t width = 0, height = 0, depth = 1;
  std::uint64_t channels = 0;
  std::uint64_t pixelBytes = 0;                               // when decoded
  std::uint64_t bitsPerSample = 8;                            // in the file
  std::uint64_t tileWidth = 0, tileHeight = 0, tileDepth = 1; // 0: no tiles
};

/// How many bytes of a file whyStartWrong takes.
constexpr std::size_t startBytes = 36;

/// Why a file of this size cannot begin so; empty if it can. For what readers get memory before
/// they give the size of the image: the user data of DPX.
std::string whyStartWrong(const std::array<unsigned char, startBytes> &start,
                          std::uint64_t fileBytes);

/// Why a file of this size cannot hold what it claims; empty if it can.
std::string whyFileTooSmall(const ImageClaim &claim, std::uint64_t fileBytes);

/// Bytes that reading takes: those of the pixels that are kept, of which each has `keptBytes`, and
/// those of the rows that are decoded at once. In floating point, as products of what a header
/// claims overflow integers.
double memoryToRead(const ImageClaim &claim, std::uint64_t keptBytes);

} // namespace rtsl::runtime
