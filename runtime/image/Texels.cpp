#include "runtime/image/Texels.h"

#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace rtsl::runtime {

namespace {

/// A channel that is 1 or 0, in the bytes of its format.
std::uint32_t bitsOf(TexelFormat format, bool isOne) {
  if (!isOne)
    return 0;
  switch (format) {
  case TexelFormat::Unorm8:
  case TexelFormat::Srgb8:
    return 0xff;
  case TexelFormat::Unorm16:
    return 0xffff;
  case TexelFormat::Float16:
    return 0x3c00;
  case TexelFormat::Float32:
    return 0x3f800000;
  }
  return 0;
}

std::size_t byteCountOf(const Texels &shape) {
  return std::size_t(shape.width) * shape.height * shape.depth * shape.channels *
         bytesOf(shape.format);
}

/// Indices of texels and words are `int` in RTSL. Throws OutOfRange if there are more.
std::uint64_t wordCountOf(const Texels &texels) {
  constexpr std::uint64_t most = 0x7fffffff;
  const std::uint64_t rows = std::uint64_t(texels.height) * texels.depth;
  const bool isTooLarge = rows > most / texels.width;
  const std::uint64_t count = isTooLarge ? 0 : rows * texels.width;
  const std::uint64_t words = (count * texels.channels * bytesOf(texels.format) + 3) / 4;
  if (isTooLarge || words > most)
    throw Error(message::texelsTooMany(texels.width, texels.height, texels.depth));
  return words;
}

/// Sets the size of the words.
void allocate(Texels &texels) {
  texels.words.assign(wordCountOf(texels), 0);
}

/// Copies a row of pixels, which may have fewer or more channels than the texels.
void copyRow(const Pixels &pixels, const std::uint8_t *from, std::uint32_t channels,
             std::uint8_t *to) {
  const std::uint32_t bytes = bytesOf(pixels.format);
  if (pixels.channels == channels) {
    std::memcpy(to, from, std::size_t(pixels.width) * channels * bytes);
    return;
  }
  const std::uint32_t shared = std::min(channels, pixels.channels);
  for (std::uint32_t x = 0; x < pixels.width; ++x) {
    std::memcpy(to, from, std::size_t(shared) * bytes);
    for (std::uint32_t channel = shared; channel < channels; ++channel) {
      const std::uint32_t bits = bitsOf(pixels.format, channel == 3);
      std::memcpy(to + std::size_t(channel) * bytes, &bits, bytes);
    }
    from += std::size_t(pixels.channels) * bytes;
    to += std::size_t(channels) * bytes;
  }
}

} // namespace

std::uint32_t bytesOf(TexelFormat format) {
  switch (format) {
  case TexelFormat::Unorm8:
  case TexelFormat::Srgb8:
    return 1;
  case TexelFormat::Unorm16:
  case TexelFormat::Float16:
    return 2;
  case TexelFormat::Float32:
    return 4;
  }
  return 4;
}

Texels texelsOf(const std::vector<Pixels> &slices) {
  const Pixels &first = slices.front();
  Texels texels;
  texels.format = first.format;
  texels.width = first.width;
  texels.height = first.height;
  texels.depth = static_cast<std::uint32_t>(slices.size());
  texels.channels =
      first.channels == 1 || (first.channels == 2 && first.isSecondAlpha) ? first.channels : 4;
  allocate(texels);
  auto *to = reinterpret_cast<std::uint8_t *>(texels.words.data());
  const std::size_t bytes = bytesOf(first.format);
  for (const Pixels &slice : slices)
    for (std::uint32_t y = slice.height; y-- > 0; to += slice.width * texels.channels * bytes)
      copyRow(slice, slice.bytes.data() + std::size_t(y) * slice.width * slice.channels * bytes,
              texels.channels, to);
  return texels;
}

Texels texelsOfBytes(const void *bytes, Texels shape) {
  allocate(shape);
  std::memcpy(shape.words.data(), bytes, byteCountOf(shape));
  return shape;
}

Texels readRawTexels(const std::string &path, Texels shape) {
  wordCountOf(shape); // before the file is read
  const std::string bytes = readFile(path);
  const std::size_t expected = byteCountOf(shape);
  if (bytes.size() != expected)
    throw Error(message::rawImageSize(path, bytes.size(), shape.width, shape.height, shape.depth,
                                      shape.channels * bytesOf(shape.format), expected));
  return texelsOfBytes(bytes.data(), std::move(shape));
}

static const char *channelName(std::uint32_t channel, std::uint32_t channels) {
  constexpr const char *grey[] = {"grey", "alpha"}, *color[] = {"red", "green", "blue", "alpha"};
  return channels <= 2 ? grey[channel] : color[channel];
}

NotFiniteTexels dropNotFinite(Texels &texels) {
  NotFiniteTexels dropped;
  const ChannelCodec codec(texels.format);
  const std::size_t channelBytes = bytesOf(texels.format);
  std::uint64_t first = std::numeric_limits<std::uint64_t>::max(); // in rows from the top
  const auto add = [&](std::size_t number, const std::uint32_t &word) {
    const std::uint64_t texel = number / texels.channels, line = texel / texels.width;
    const auto slice = std::uint32_t(line / texels.height),
               row = texels.height - 1 - std::uint32_t(line % texels.height),
               column = std::uint32_t(texel % texels.width),
               channel = std::uint32_t(number % texels.channels);
    const std::uint64_t place =
        ((std::uint64_t(slice) * texels.height + row) * texels.width + column) * texels.channels +
        channel;
    ++dropped.count;
    if (place >= first)
      return;
    first = place;
    const auto *bytes = reinterpret_cast<const std::uint8_t *>(&word);
    const double value = codec.decode(bytes + number * channelBytes % sizeof word, false);
    dropped = {dropped.count,
               static_cast<float>(value),
               channelName(channel, texels.channels),
               column,
               row,
               slice};
  };
  if (texels.format == TexelFormat::Float32) {
    for (std::size_t i = 0; i < texels.words.size(); ++i)
      if (std::uint32_t &word = texels.words[i]; (word & 0x7f800000u) == 0x7f800000u) {
        add(i, word);
        word = 0;
      }
  } else if (texels.format == TexelFormat::Float16) {
    for (std::size_t i = 0; i < texels.words.size(); ++i)
      for (const std::uint32_t half : {0u, 1u})
        if (std::uint32_t &word = texels.words[i]; (word >> 16 * half & 0x7c00u) == 0x7c00u) {
          add(2 * i + half, word);
          word &= ~(0xffffu << 16 * half);
        }
  }
  return dropped;
}

NegativeTexels negativeTexels(const Texels &texels) {
  NegativeTexels negative;
  if (texels.format != TexelFormat::Float16 && texels.format != TexelFormat::Float32)
    return negative;
  const ChannelCodec codec(texels.format);
  const std::size_t channelBytes = bytesOf(texels.format);
  const auto *bytes = reinterpret_cast<const std::uint8_t *>(texels.words.data());
  const std::uint32_t colors = texels.channels == 4 ? 3 : 1;
  for (std::uint32_t row = 0; row < texels.height; ++row)
    for (std::uint32_t column = 0; column < texels.width; ++column) {
      const std::size_t texel = std::size_t(texels.height - 1 - row) * texels.width + column;
      double lowest = 0;
      for (std::uint32_t c = 0; c < colors; ++c)
        lowest = std::min(lowest, codec.decode(bytes + (texel * texels.channels + c) * channelBytes,
                                               /*isAlpha=*/false));
      if (lowest == 0)
        continue;
      if (negative.count++ == 0) {
        negative.column = column;
        negative.row = row;
      }
      negative.lowest = std::min(negative.lowest, static_cast<float>(lowest));
    }
  return negative;
}

} // namespace rtsl::runtime
