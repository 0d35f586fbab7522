#include "runtime/image/Texels.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <string>

using namespace rtsl::runtime;

namespace {

constexpr unsigned alpha = 3;

Texels randomTexels(TexelFormat format, std::uint32_t channels) {
  Texels texels;
  texels.format = format;
  texels.width = 7;
  texels.height = 5;
  texels.channels = channels;
  std::mt19937 random(1);
  std::vector<std::uint8_t> bytes(7 * 5 * channels * bytesOf(format));
  for (std::uint8_t &byte : bytes)
    byte = std::uint8_t(random() % 60); // halves and floats are finite
  texels.words.resize((bytes.size() + 3) / 4);
  std::memcpy(texels.words.data(), bytes.data(), bytes.size());
  return texels;
}

/// A channel of a texel, as the numbers of the format: 0 to 2 are the colors, which are equal in a
/// grey image.
std::string channelOf(const Texels &texels, std::size_t texel, unsigned channel) {
  const unsigned bytes = bytesOf(texels.format), last = texels.channels - 1;
  const unsigned place = channel == alpha ? last : texels.channels == 4 ? channel : 0;
  return std::string(reinterpret_cast<const char *>(texels.words.data()) +
                         (texel * texels.channels + place) * bytes,
                     bytes);
}

} // namespace

TEST(TexelChannels, WhatIsReadKeepsItsBitsOnAllLevels) {
  for (const TexelFormat format : {TexelFormat::Unorm8, TexelFormat::Srgb8, TexelFormat::Unorm16,
                                   TexelFormat::Float16, TexelFormat::Float32})
    for (const std::uint32_t channels : {1u, 2u, 4u})
      for (std::uint32_t read = 0; read < 16; ++read) {
        Texels all = randomTexels(format, channels), kept = all;
        dropChannels(kept, read);
        const bool hasAlpha = read >> alpha & 1;
        const unsigned colors = unsigned(__builtin_popcount(read & 7u));
        EXPECT_EQ(kept.channels, channels == 4 && colors > 1  ? 4
                                 : channels == 1 || !hasAlpha ? 1
                                                              : 2)
            << channels << " " << read;
        addLevels(all);
        addLevels(kept);
        ASSERT_EQ(kept.levelStarts, all.levelStarts);
        for (std::size_t texel = 0; texel <= all.levelStarts.back(); ++texel)
          for (unsigned channel = 0; channel < 4; ++channel)
            if ((read >> channel & 1) && (channel != alpha || channels != 1)) {
              EXPECT_EQ(channelOf(kept, texel, channel), channelOf(all, texel, channel))
                  << channels << " " << read << " " << texel << " " << channel;
            }
      }
}

/// Infinite values at random places of three slices: of those that were put in, the first one by
/// slice, row from the top, column and channel.
TEST(TexelChannels, TheFirstThatIsNotFiniteIsNamed) {
  std::mt19937 random(2);
  for (const TexelFormat format : {TexelFormat::Float16, TexelFormat::Float32})
    for (const std::uint32_t channels : {1u, 2u, 4u})
      for (unsigned count = 0; count < 8; ++count) {
        Texels texels;
        texels.format = format;
        texels.width = 7;
        texels.height = 5;
        texels.depth = 3;
        texels.channels = channels;
        const unsigned bytes = bytesOf(format), all = 7 * 5 * 3 * channels;
        texels.words.resize((all * bytes + 3) / 4);
        std::set<std::array<unsigned, 4>> places;
        while (places.size() < count) {
          const std::array<unsigned, 4> place = {unsigned(random() % 3), unsigned(random() % 5),
                                                 unsigned(random() % 7),
                                                 unsigned(random() % channels)};
          const auto [slice, row, column, channel] = place;
          const std::uint32_t infinite = bytes == 2 ? 0x7c00 : 0x7f800000;
          std::memcpy(reinterpret_cast<char *>(texels.words.data()) +
                          (((slice * 5 + 4 - row) * 7 + column) * channels + channel) * bytes,
                      &infinite, bytes);
          places.insert(place);
        }
        const NotFiniteTexels found = dropNotFinite(texels);
        EXPECT_EQ(found.count, count);
        EXPECT_EQ(dropNotFinite(texels).count, 0u);
        if (count == 0)
          continue;
        const auto [slice, row, column, channel] = *places.begin();
        const std::array<unsigned, 3> place = {found.slice, found.row, found.column};
        EXPECT_EQ(place, (std::array<unsigned, 3>{slice, row, column}));
        EXPECT_EQ(found.channel,
                  std::string(channels == 4  ? std::array{"red", "green", "blue", "alpha"}[channel]
                              : channel == 0 ? "grey"
                                             : "alpha"));
        EXPECT_EQ(found.value, std::numeric_limits<float>::infinity());
      }
}
