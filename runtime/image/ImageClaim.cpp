//===- ImageClaim.cpp - whether a file can hold the image that it claims --===//
#include "runtime/image/ImageClaim.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace rtsl::runtime {

namespace {

/// Deflate (RFC 1951): 258 bytes for a length and a distance of one bit each.
constexpr std::uint64_t deflate = 258 * 8 / 2;
/// Where the largest number is not known, or depends on the width: no black image reached it.
constexpr std::uint64_t high = std::uint64_t(1) << 17;

struct Expansion {
  const char *name;
  std::uint64_t most;
};

/// The largest expansion by compression. Black images come close.
constexpr Expansion ofOpenExr[] = {
    {"none", 1},
    {"rle", 64}, // 128 bytes become 2
    {"zips", deflate},
    {"zip", deflate},
    {"piz", 512},               // 512 bytes become 10 bits
    {"pxr24", deflate * 4 / 3}, // of floats 24 bits are kept
    {"b44", 3},                 // 32 bytes become 14
    {"b44a", 11},               // 32 bytes become 3
    {"dwaa", high},             // four bytes for 64 pixels, then Huffman codes or deflate
    {"dwab", high},
};
constexpr Expansion ofTiff[] = {
    {"none", 1},
    {"packbits", 64}, // 128 bytes become 2
    {"lzw", 4096},    // a string of the dictionary becomes 12 bits
    {"zip", deflate},
    {"jpeg", 2048}, // see ofFormats
    {"pixarlog", 2 * deflate},
    {"sgilog", 256},
    {"sgilog24", 256},
};
constexpr Expansion ofFormats[] = {
    {"png", deflate},
    {"jpeg", 2048},   // 64 pixels of 3 or 4 channels become one bit, at least
    {"gif", 1 << 14}, // a string of the dictionary, 4 bytes a pixel, becomes 12 bits
    {"pnm", 8},       // bits become bytes
    // A run has at most 255 equal pixels, and two bytes or more.
    {"targa", 512},
    {"bmp", 512},
    {"hdr", 512},
    {"sgi", 512},
    {"psd", 512},
    {"iff", 512},
    {"rla", 512},
    {"softimage", 512},
    // A whole image of one color takes a few bytes.
    {"webp", 0},
    {"jpeg2000", 0},
    {"heif", 0},
};

template <std::size_t count>
std::uint64_t find(const Expansion (&table)[count], const std::string &name,
                   std::uint64_t otherwise) {
  for (const Expansion &row : table)
    if (name == row.name)
      return row.most;
  return otherwise;
}

/// Decoded bytes that a byte of the file may hold, at most; 0: there is no bound, as an image of
/// one color may take no bits for a pixel.
std::uint64_t mostExpansion(const ImageClaim &claim) {
  if (claim.format == "openexr")
    return find(ofOpenExr, claim.compression, high);
  if (claim.format != "tiff")
    return find(ofFormats, claim.format, 4096);
  // Indices into a palette become colors, colors of half the resolution pixels, and bits bytes.
  const std::uint64_t unpacked =
      3 * std::max<std::uint64_t>(1, 8 / std::max<std::uint64_t>(1, claim.bitsPerSample));
  return std::min(high, unpacked * find(ofTiff, claim.compression, high));
}

/// Bytes of a row of tiles, or of pixels if there are none.
double rowOfTiles(const ImageClaim &claim) {
  const std::uint64_t across =
      claim.tileWidth == 0 ? 1 : (claim.width + claim.tileWidth - 1) / claim.tileWidth;
  const std::uint64_t width = claim.tileWidth == 0 ? claim.width : across * claim.tileWidth;
  return double(width) * double(std::max<std::uint64_t>(claim.tileHeight, 1)) *
         double(claim.tileDepth) * double(claim.pixelBytes);
}

/// Bytes that OpenImageIO decodes at once before it converts them or takes some of the channels: a
/// row of tiles; of an image without tiles 64 MiB, or 256 rows if that is more.
double decodedAtOnce(const ImageClaim &claim) {
  const double row = rowOfTiles(claim);
  if (claim.tileWidth != 0)
    return row;
  constexpr double usual = 1 << 26, leastRows = 256;
  return std::min(double(claim.height) * row, std::max(usual, leastRows * row));
}

std::string sizeText(double bytes) {
  constexpr const char *units[] = {"bytes", "KiB", "MiB", "GiB"};
  std::size_t unit = 0;
  for (; bytes >= 1024 && unit < std::size(units) - 1; ++unit)
    bytes /= 1024;
  return fmt::format("{:.{}f} {}", bytes, unit == 0 ? 0 : 1, units[unit]);
}

} // namespace

std::string whyStartWrong(const std::array<unsigned char, startBytes> &start,
                          std::uint64_t fileBytes) {
  const bool isBigEndian = std::memcmp(start.data(), "SDPX", 4) == 0;
  if (!isBigEndian && std::memcmp(start.data(), "XPDS", 4) != 0)
    return "";
  constexpr std::size_t userSize = 32; // SMPTE 268M
  constexpr std::uint32_t undefined = 0xffffffff;
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < 4; ++i)
    size = size << 8 | start[userSize + (isBigEndian ? i : 3 - i)];
  if (size == undefined || size <= fileBytes)
    return "";
  return fmt::format("it claims {} of user data, but the file has {} bytes", sizeText(size),
                     fileBytes);
}

std::string whyFileTooSmall(const ImageClaim &claim, std::uint64_t fileBytes) {
  const std::uint64_t expansion = mostExpansion(claim);
  if (expansion == 0)
    return "";
  const double held = double(fileBytes) * double(expansion);
  const double all =
      double(claim.width) * double(claim.height) * double(claim.depth) * double(claim.pixelBytes);
  const std::string kind =
      claim.compression.empty() ? claim.format : claim.format + " " + claim.compression;
  const std::string limit = fmt::format("a file of {} bytes ({}) has {} of pixels at most",
                                        fileBytes, kind, sizeText(held));
  if (all > held)
    return fmt::format("it claims {} x {} pixels of {} channel{}, {}, but {}", claim.width,
                       claim.height, claim.channels, claim.channels == 1 ? "" : "s", sizeText(all),
                       limit);
  // A small image may have one large tile, of which the file has only a part.
  constexpr double harmless = 1 << 26;
  const double tiles = rowOfTiles(claim);
  if (tiles > std::max(held, harmless))
    return fmt::format("it claims tiles of {} x {} x {} pixels, {} in a row of them, but {}",
                       claim.tileWidth, claim.tileHeight, claim.tileDepth, sizeText(tiles), limit);
  return "";
}

double memoryToRead(const ImageClaim &claim, std::uint64_t keptBytes) {
  return double(claim.width) * double(claim.height) * double(keptBytes) + decodedAtOnce(claim);
}

} // namespace rtsl::runtime
