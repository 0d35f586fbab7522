#include "runtime/image/ToneMapping.h"

#include "language/ColorBasis.h"

#include <cmath>

namespace rtsl::runtime {

namespace {

/// The luminance that becomes 1: the brightest parts of most pictures stay below it.
constexpr double whiteOfReinhard = 4;

/// Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, equation 4.
double reinhardFactor(double luminance) {
  return (1 + luminance / (whiteOfReinhard * whiteOfReinhard)) / (1 + luminance);
}

/// Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
double filmic(double x) {
  return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

} // namespace

Image toneMapped(const Image &image, const ToneMapping &mapping) {
  Image mapped = toRgb(image);
  const double exposure = std::exp2(mapping.stops);
  for (std::size_t i = 0; i + 2 < mapped.pixels.size(); i += 3) {
    float *pixel = &mapped.pixels[i];
    double factor = exposure;
    if (mapping.curve == ToneCurve::Reinhard) {
      double luminance = 0;
      for (int c = 0; c < 3; ++c)
        luminance += luminanceWeights[c] * exposure * double(pixel[c]);
      factor *= reinhardFactor(luminance);
    }
    for (int c = 0; c < 3; ++c) {
      const double value = factor * double(pixel[c]);
      pixel[c] = float(mapping.curve == ToneCurve::Filmic ? filmic(value) : value);
    }
  }
  return mapped;
}

} // namespace rtsl::runtime
