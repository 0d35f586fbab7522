//===- TexelLevels.cpp - the smaller levels of an image -------------------===//
#include "runtime/image/Texels.h"

#include "support/ErrorMessages.h"
#include "support/Parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace rtsl::runtime {

namespace {

/// The texels of a level that one of the next level covers along an axis, with the share of its
/// length in each. Twice as many, of odd sizes up to three times as many: at most four.
struct Cover {
  std::uint32_t first = 0, count = 0;
  std::array<double, 4> shares{};
};

std::vector<Cover> coversOf(std::uint32_t before, std::uint32_t after) {
  std::vector<Cover> covers(after);
  const double length = double(before) / after;
  for (std::uint32_t i = 0; i < after; ++i) {
    const double begin = i * length, end = (i + 1) * length;
    Cover &cover = covers[i];
    cover.first = static_cast<std::uint32_t>(begin);
    for (std::uint32_t at = cover.first; at < before && cover.count < cover.shares.size(); ++at) {
      const double share = std::min<double>(end, at + 1.0) - std::max<double>(begin, at);
      if (share <= 0)
        break;
      cover.shares[cover.count++] = share / length;
    }
  }
  return covers;
}

struct Level {
  std::uint32_t width, height, depth;
  std::uint8_t *bytes;
};

/// The level after one, whose memory has space.
void shrink(const Level &from, const Level &to, std::uint32_t channels, std::uint32_t channelBytes,
            const ChannelCodec &codec) {
  const std::vector<Cover> columns = coversOf(from.width, to.width);
  const std::vector<Cover> rows = coversOf(from.height, to.height);
  const std::vector<Cover> slices = coversOf(from.depth, to.depth);
  const std::size_t texelBytes = std::size_t(channels) * channelBytes;
  const auto isAlpha = [&](std::uint32_t channel) {
    return channels != 1 && channel + 1 == channels;
  };
  forEachInParallel(0, std::size_t(to.height) * to.depth, [&](std::size_t row) {
    const Cover &slice = slices[row / to.height], &line = rows[row % to.height];
    std::uint8_t *target = to.bytes + row * to.width * texelBytes;
    for (const Cover &column : columns)
      for (std::uint32_t channel = 0; channel < channels; ++channel, target += channelBytes) {
        double sum = 0;
        for (std::uint32_t z = 0; z < slice.count; ++z)
          for (std::uint32_t y = 0; y < line.count; ++y)
            for (std::uint32_t x = 0; x < column.count; ++x) {
              const std::size_t texel =
                  ((std::size_t(slice.first) + z) * from.height + line.first + y) * from.width +
                  column.first + x;
              sum += slice.shares[z] * line.shares[y] * column.shares[x] *
                     codec.decode(from.bytes + texel * texelBytes + channel * channelBytes,
                                  isAlpha(channel));
            }
        codec.encode(sum, isAlpha(channel), target);
      }
  });
}

} // namespace

void addLevels(Texels &texels) {
  std::uint64_t total = 0;
  std::vector<std::uint32_t> starts;
  std::vector<Level> levels;
  Level level = {texels.width, texels.height, texels.depth, nullptr};
  const auto half = [](std::uint32_t size) { return std::max(size / 2, 1u); };
  for (;; level = {half(level.width), half(level.height), half(level.depth), nullptr}) {
    starts.push_back(static_cast<std::uint32_t>(total));
    levels.push_back(level);
    total += std::uint64_t(level.width) * level.height * level.depth;
    if (level.width == 1 && level.height == 1 && level.depth == 1)
      break;
  }
  const std::uint32_t channelBytes = bytesOf(texels.format);
  const std::uint64_t words = (total * texels.channels * channelBytes + 3) / 4;
  if (total > 0x7fffffff || words > 0x7fffffff)
    throw Error(message::levelsTooLarge(texels.width, texels.height, texels.depth));
  texels.words.resize(words, 0);
  auto *bytes = reinterpret_cast<std::uint8_t *>(texels.words.data());
  for (std::size_t i = 0; i < levels.size(); ++i)
    levels[i].bytes = bytes + std::size_t(starts[i]) * texels.channels * channelBytes;
  const ChannelCodec codec(texels.format);
  for (std::size_t i = 1; i < levels.size(); ++i)
    shrink(levels[i - 1], levels[i], texels.channels, channelBytes, codec);
  texels.levelStarts = std::move(starts);
}

} // namespace rtsl::runtime
