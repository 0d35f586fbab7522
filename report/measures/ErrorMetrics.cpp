//===- ErrorMetrics.cpp ---------------------------------------------------===//
#include "report/measures/ErrorMetrics.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace rtsl::report {

namespace {

void requireSameShape(const runtime::Image &reference, const runtime::Image &test) {
  if (reference.width != test.width || reference.height != test.height ||
      reference.channels != test.channels)
    throw Error(message::picturesDiffer(reference.width, reference.height, reference.channels,
                                        test.width, test.height, test.channels));
}

double relativeSquaredError(double reference, double test) {
  const double error = test - reference;
  return error * error / (reference * reference + relMseEpsilon);
}

} // namespace

ErrorMetrics measureError(const runtime::Image &reference, const runtime::Image &test) {
  requireSameShape(reference, test);
  ErrorMetrics metrics;
  double squares = 0, relative = 0, sum = 0;
  for (std::size_t i = 0; i < test.pixels.size(); i += test.channels) {
    const float *a = &reference.pixels[i], *b = &test.pixels[i];
    const auto any = [&](const float *pixel, auto predicate) {
      return std::any_of(pixel, pixel + test.channels, predicate);
    };
    const auto isNan = [](float value) { return std::isnan(value); };
    const auto isNotFinite = [](float value) { return !std::isfinite(value); };
    const bool differs = std::memcmp(a, b, test.channels * sizeof(float)) != 0;
    metrics.pixelsThatDiffer += differs;
    if (any(b, isNan))
      ++metrics.nanPixels;
    else if (any(b, isNotFinite))
      ++metrics.infinitePixels;
    if (any(a, isNotFinite) || any(b, isNotFinite)) {
      metrics.incomparable += differs;
      continue;
    }
    ++metrics.pixels;
    for (std::uint32_t channel = 0; channel < test.channels; ++channel) {
      const double error = double(b[channel]) - a[channel];
      squares += error * error;
      relative += relativeSquaredError(a[channel], b[channel]);
      sum += error;
      metrics.largest = std::max(metrics.largest, std::abs(error));
    }
  }
  if (metrics.pixels == 0)
    return metrics;
  const double count = double(metrics.pixels) * test.channels;
  metrics.rmse = std::sqrt(squares / count);
  metrics.relMse = relative / count;
  metrics.bias = sum / count;
  return metrics;
}

runtime::Image relativeSquaredErrorMap(const runtime::Image &reference,
                                       const runtime::Image &test) {
  requireSameShape(reference, test);
  runtime::Image map(test.width, test.height, 1);
  for (std::size_t pixel = 0; pixel < map.pixels.size(); ++pixel) {
    double sum = 0;
    for (std::size_t i = pixel * test.channels; i < (pixel + 1) * test.channels; ++i)
      sum += relativeSquaredError(reference.pixels[i], test.pixels[i]);
    map.pixels[pixel] = float(sum / test.channels);
  }
  return map;
}

} // namespace rtsl::report
