//===- ToneMapping.h - from light to what a screen shows -------------------===//
#pragma once

#include "runtime/image/Image.h"

#include <cstdint>

namespace rtsl::runtime {

enum class ToneCurve : std::uint8_t { Linear, Reinhard, Filmic };

/// For PNG files, whose values are at most 1. The curves are functions of library/std/tonemapping.
struct ToneMapping {
  double stops = 0; // brighter by so many photographic stops, before the curve
  ToneCurve curve = ToneCurve::Linear;
  bool changesNothing() const { return stops == 0 && curve == ToneCurve::Linear; }
};

/// Red, green and blue of the image, mapped. Values above 1 remain.
Image toneMapped(const Image &image, const ToneMapping &mapping);

} // namespace rtsl::runtime
