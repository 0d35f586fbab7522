// Bilinear lookups in an image of 8 bits in sRGB, decoded by a table, as one writes them by hand.
#include "bench/images/Lookups.h"

#include <cmath>
#include <fstream>
#include <vector>

namespace {

std::vector<std::uint32_t> texels(imageSize *imageSize);
float decoded[256];

void add(int x, int y, float weight, float *sum) {
  const std::uint32_t texel = texels[std::size_t(y * imageSize + x)];
  sum[0] += weight * decoded[texel & 255];
  sum[1] += weight * decoded[texel >> 8 & 255];
  sum[2] += weight * decoded[texel >> 16 & 255];
}

int wrapped(int i) {
  return i < 0 ? imageSize - 1 : i >= imageSize ? 0 : i;
}

void lookup(float u, float v, float *sum) {
  const float x = (u - std::floor(u)) * imageSize - 0.5f;
  const float y = (v - std::floor(v)) * imageSize - 0.5f;
  const float left = std::floor(x), lower = std::floor(y);
  const float a = x - left, b = y - lower;
  const int x0 = wrapped(int(left)), x1 = wrapped(int(left) + 1);
  const int y0 = wrapped(int(lower)), y1 = wrapped(int(lower) + 1);
  add(x0, y0, (1 - a) * (1 - b), sum);
  add(x1, y0, a * (1 - b), sum);
  add(x0, y1, (1 - a) * b, sum);
  add(x1, y1, a * b, sum);
}

} // namespace

int main(int, char **arguments) {
  std::ifstream(arguments[1], std::ios::binary)
      .read(reinterpret_cast<char *>(texels.data()), std::streamsize(4 * texels.size()));
  for (int i = 0; i < 256; ++i)
    decoded[i] = float(i <= 10 ? i / 255.0 / 12.92 : std::pow((i / 255.0 + 0.055) / 1.055, 2.4));
  measure(lookup);
}
