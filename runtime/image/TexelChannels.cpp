//===- TexelChannels.cpp - channels of texels as numbers ------------------===//
#include "runtime/image/Texels.h"

#include "runtime/image/Image.h"

#include <half.h>

#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

namespace rtsl::runtime {

namespace {

template <typename Number>
Number load(const std::uint8_t *bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

template <typename Number>
void store(Number number, std::uint8_t *bytes) {
  std::memcpy(bytes, &number, sizeof number);
}

} // namespace

ChannelCodec::ChannelCodec(TexelFormat format) : format(format) {
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = decodeSrgb(static_cast<float>(i) / 255.0f);
}

double ChannelCodec::decode(const std::uint8_t *bytes, bool isAlpha) const {
  switch (format) {
  case TexelFormat::Unorm8:
    return *bytes / 255.0;
  case TexelFormat::Srgb8:
    return isAlpha ? *bytes / 255.0 : double(linear[*bytes]);
  case TexelFormat::Unorm16:
    return load<std::uint16_t>(bytes) / 65535.0;
  case TexelFormat::Float16: {
    half value;
    value.setBits(load<std::uint16_t>(bytes));
    return double(float(value));
  }
  case TexelFormat::Float32:
    return double(load<float>(bytes));
  }
  return 0;
}

void ChannelCodec::encode(double value, bool isAlpha, std::uint8_t *bytes) const {
  switch (format) {
  case TexelFormat::Unorm8:
    *bytes = static_cast<std::uint8_t>(std::nearbyint(value * 255.0));
    break;
  case TexelFormat::Srgb8: {
    const double encoded = isAlpha ? value : double(encodeSrgb(static_cast<float>(value)));
    *bytes = static_cast<std::uint8_t>(std::nearbyint(encoded * 255.0));
    break;
  }
  case TexelFormat::Unorm16:
    store(static_cast<std::uint16_t>(std::nearbyint(value * 65535.0)), bytes);
    break;
  case TexelFormat::Float16:
    store(half(static_cast<float>(value)).bits(), bytes);
    break;
  case TexelFormat::Float32:
    store(static_cast<float>(value), bytes);
    break;
  }
}

void dropChannels(Texels &texels, std::uint32_t read) {
  constexpr std::uint32_t colors = 7, alpha = 8;
  if (texels.channels == 1)
    return;
  const bool hasAlpha = read & alpha;
  std::uint32_t first = 0; // the color that is kept
  if (texels.channels == 4) {
    while (first < 3 && !(read >> first & 1))
      ++first;
    if ((read & colors & ~(1u << first)) != 0)
      return;
    first %= 3; // none is read: any
  } else if (hasAlpha) {
    return; // grey and alpha
  }
  const std::uint32_t channels = hasAlpha ? 2 : 1, bytes = bytesOf(texels.format);
  const std::size_t count = std::size_t(texels.width) * texels.height * texels.depth;
  const std::size_t texelBytes = std::size_t(texels.channels) * bytes;
  std::vector<std::uint32_t> words((count * channels * bytes + 3) / 4);
  const auto *from = reinterpret_cast<const std::uint8_t *>(texels.words.data());
  auto *to = reinterpret_cast<std::uint8_t *>(words.data());
  for (std::size_t i = 0; i < count; ++i, from += texelBytes) {
    std::memcpy(to, from + std::size_t(first) * bytes, bytes);
    to += bytes;
    if (hasAlpha) {
      std::memcpy(to, from + texelBytes - bytes, bytes);
      to += bytes;
    }
  }
  texels.words = std::move(words);
  texels.channels = channels;
}

} // namespace rtsl::runtime
