//===- ErrorMap.cpp -------------------------------------------------------===//
#include "report/measures/ErrorMap.h"

#include "runtime/image/ImageFormats.h"

#include <algorithm>
#include <cmath>

namespace rtsl::report {

namespace {

/// sRGB colours whose lightness increases evenly, for values 0, 1/4, ... 1.
constexpr int stops = 5;
constexpr double ramp[stops][3] = {
    {0, 0, 0}, {66, 18, 112}, {174, 47, 120}, {248, 132, 84}, {252, 250, 190}};

void paint(float *rgb, double value) {
  const double place = (value > 0 ? std::min(value, 1.0) : 0.0) * (stops - 1);
  const int stop = std::min(int(place), stops - 2);
  for (int channel = 0; channel < 3; ++channel)
    rgb[channel] = runtime::decodeSrgb(float(
        (ramp[stop][channel] + (place - stop) * (ramp[stop + 1][channel] - ramp[stop][channel])) /
        255));
}

std::string base64(const std::string &bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j)
      group = group << 8 | (i + j < bytes.size() ? std::uint8_t(bytes[i + j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      text += i + j > bytes.size() ? '=' : digits[group >> (18 - 6 * j) & 63];
  }
  return text;
}

} // namespace

runtime::Image colorFlipMap(const FlipMap &map) {
  runtime::Image image(map.width, map.height, 3);
  for (std::size_t i = 0; i < map.error.size(); ++i)
    paint(&image.pixels[3 * i], map.error[i]);
  return image;
}

runtime::Image colorLogMap(const runtime::Image &map, double low, double high) {
  runtime::Image image(map.width, map.height, 3);
  for (std::size_t i = 0; i < map.pixels.size(); ++i) // log of 0 is below the scale
    paint(&image.pixels[3 * i],
          map.pixels[i] > 0 ? std::log(map.pixels[i] / low) / std::log(high / low) : 0.0);
  return image;
}

std::string dataUrl(const runtime::Image &rgb) {
  return "data:image/png;base64," + base64(runtime::encodePng(rgb, "a part of a page"));
}

} // namespace rtsl::report
