//===- Lookups.h - the lookups of bench/run images, by hand ---------------===//
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>

constexpr int imageSize = 512, width = 1024, height = 1024, samples = 4, lookups = 16;

/// Calls `lookup(u, v, sum)` for the points of bench/measure/images.py, and prints nanoseconds a
/// lookup. `sum` is a color that the lookup is added to.
template <typename Lookup>
void measure(Lookup lookup) {
  const auto start = std::chrono::steady_clock::now();
  std::uint32_t random = 1;
  float total = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int sample = 0; sample < samples; ++sample) {
        random = random * 1664525u + 1013904223u;
        const float u = (float(x) + float(random >> 8) / 16777216.0f) / width;
        random = random * 1664525u + 1013904223u;
        const float v = (float(y) + float(random >> 8) / 16777216.0f) / height;
        float sum[3] = {0, 0, 0};
        for (int i = 0; i < lookups; ++i)
          lookup(u * 7.3f + 0.37f * float(i), v * 7.3f + 0.37f * float(i), sum);
        total += sum[0] + sum[1] + sum[2];
      }
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
  const double count = double(width) * height * samples * lookups;
  std::printf("{\"nanoseconds\": %.4f, \"mean\": %.6f}\n", time.count() / count,
              double(total) / count / 3);
}
