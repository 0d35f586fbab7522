#include "runtime/scene/lights/DirectionChances.h"

#include <algorithm>
#include <cmath>

namespace rtsl::runtime {

namespace {

/// The luminance of each texel, from 0 on.
std::vector<double> luminances(const Texels &texels) {
  const ChannelCodec codec(texels.format);
  const std::size_t channelBytes = bytesOf(texels.format);
  const auto *bytes = reinterpret_cast<const std::uint8_t *>(texels.words.data());
  std::vector<double> all(std::size_t(texels.width) * texels.height);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto channel = [&](std::size_t c) {
      return codec.decode(bytes + (i * texels.channels + c) * channelBytes, /*isAlpha=*/false);
    };
    const double value = texels.channels < 4
                             ? channel(0)
                             : 0.2126 * channel(0) + 0.7152 * channel(1) + 0.0722 * channel(2);
    all[i] = std::max(value, 0.0);
  }
  return all;
}

/// The number of a texel beside the image, which has the value that is there; -1: black.
std::int64_t wrapped(std::int64_t i, std::int64_t size, Wrap wrap) {
  if (i >= 0 && i < size)
    return i;
  switch (wrap) {
  case Wrap::Repeat:
    return i < 0 ? size - 1 : 0;
  case Wrap::Mirror:
  case Wrap::Clamp:
    return std::clamp<std::int64_t>(i, 0, size - 1);
  case Wrap::Black:
    return -1;
  }
  return -1;
}

/// Replaces values along an axis by the means, over each texel, of lines between their centres.
void spread(std::vector<double> &values, std::size_t start, std::size_t step, std::uint32_t size,
            Wrap wrap, std::vector<double> &line) {
  line.resize(size);
  for (std::uint32_t i = 0; i < size; ++i)
    line[i] = values[start + i * step];
  const auto at = [&](std::int64_t i) {
    const std::int64_t known = wrapped(i, size, wrap);
    return known < 0 ? 0.0 : line[std::size_t(known)];
  };
  for (std::uint32_t i = 0; i < size; ++i)
    values[start + i * step] = 0.125 * at(std::int64_t(i) - 1) + 0.75 * line[i] + 0.125 * at(i + 1);
}

/// Writes the ascending sums of values over the last one. False if that is 0.
bool accumulate(const double *values, std::size_t count, float *chances, double &total) {
  total = 0;
  for (std::size_t i = 0; i < count; ++i)
    total += values[i];
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += values[i];
    chances[i] = total > 0 && i + 1 != count ? static_cast<float>(sum / total) : 1.0f;
  }
  return total > 0;
}

} // namespace

std::vector<float> directionChances(const Texels &texels, const Sampling &sampling) {
  const std::uint32_t width = texels.width, height = texels.height;
  std::vector<double> weights = luminances(texels);
  if (sampling.filter != Filter::Nearest) {
    std::vector<double> line;
    for (std::uint32_t y = 0; y < height; ++y)
      spread(weights, std::size_t(y) * width, 1, width, sampling.wrap[0], line);
    for (std::uint32_t x = 0; x < width; ++x)
      spread(weights, x, width, height, sampling.wrap[1], line);
  }
  std::vector<float> chances(height + weights.size());
  std::vector<double> rows(height);
  const double step = std::acos(-1.0) / height; // of latitude
  for (std::uint32_t y = 0; y < height; ++y) {
    accumulate(&weights[std::size_t(y) * width], width, &chances[height + std::size_t(y) * width],
               rows[y]);
    rows[y] *= std::cos((y + 0.5) * step - std::acos(0.0)); // in proportion to the solid angle
  }
  double total = 0;
  if (!accumulate(rows.data(), height, chances.data(), total))
    chances.clear();
  return chances;
}

} // namespace rtsl::runtime
