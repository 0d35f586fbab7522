//===- Exposure.cpp -------------------------------------------------------===//
#include "report/measures/Exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rtsl::report {

namespace {

constexpr double brightest = 0.02; // share of the pixels that may be white
constexpr double dim = 0.1;        // below, a picture is too dark to view

/// The largest channel of each pixel.
std::vector<float> peaks(const runtime::Image &rgb) {
  std::vector<float> values;
  for (std::size_t i = 0; i + 2 < rgb.pixels.size(); i += 3) {
    float peak = 0;
    for (std::size_t channel = 0; channel < 3; ++channel)
      if (const float value = rgb.pixels[i + channel]; std::isfinite(value))
        peak = std::max(peak, value);
    values.push_back(peak);
  }
  return values;
}

} // namespace

double stopsFor(const runtime::Image &rgb) {
  std::vector<float> values = peaks(rgb);
  if (values.empty())
    return 0;
  const auto place = values.begin() + std::ptrdiff_t((1 - brightest) * double(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  const double peak = *place > 0 ? *place : *std::max_element(place, values.end());
  if (peak == 0 || (peak >= dim && peak <= 1))
    return 0;
  return std::round(2 * std::log2(0.9 / peak)) / 2;
}

double shareBeyondScreen(const runtime::Image &rgb) {
  const std::vector<float> values = peaks(rgb);
  return values.empty() ? 0
                        : double(std::count_if(values.begin(), values.end(),
                                               [](float value) { return value > 1; })) /
                              double(values.size());
}

runtime::Image exposed(runtime::Image rgb, double stops) {
  for (float &value : rgb.pixels)
    value = float(value * std::exp2(stops));
  return rgb;
}

} // namespace rtsl::report
