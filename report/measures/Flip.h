//===- Flip.h - the perceived difference of two pictures ------------------===//
//
// FLIP: how strongly two pictures differ when a person flips between them on a screen.
//
// Low dynamic range: P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom,
// M. D. Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG 2020.
// High dynamic range: P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Moller, "Visualizing Errors
// in Rendered High Dynamic Range Images", Eurographics 2021 (short papers).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/image/Image.h"

#include <vector>

namespace rtsl::report {

/// The viewer of both papers: 0.7 m from a screen 0.7 m and 3840 pixels wide.
constexpr double defaultPixelsPerDegree = 67.0206;

/// A map of one error in [0, 1] a pixel, rows from the top: 0 is not seen, 1 is green beside blue.
struct FlipMap {
  std::uint32_t width = 0, height = 0;
  std::vector<float> error;

  double mean() const;
};

/// The exposures at which two pictures of high dynamic range are compared, in stops.
struct FlipExposures {
  double first = 0, last = 0;
  unsigned count = 2; // at least 2, equally spaced

  double at(unsigned i) const { return first + (last - first) * i / (count - 1); }
};

/// LDR-FLIP of two RGB pictures in linear light; values are clamped to the [0, 1] of a screen.
/// Throws BadImage if the shapes differ or a picture is not RGB or empty.
FlipMap flip(const runtime::Image &reference, const runtime::Image &test,
             double pixelsPerDegree = defaultPixelsPerDegree);

/// HDR-FLIP: the largest LDR-FLIP of each pixel over `exposures`, tone mapped with the ACES curve
/// (K. Narkowicz's fit, 2016). Values that are negative or not finite count as 0.
FlipMap flipHdr(const runtime::Image &reference, const runtime::Image &test,
                const FlipExposures &exposures, double pixelsPerDegree = defaultPixelsPerDegree);

/// The exposures for a reference (2021, section 3): from the one that maps its brightest pixel to
/// 0.85 on the screen to the one that maps its median there, a stop apart or less.
FlipExposures exposuresFor(const runtime::Image &reference);

} // namespace rtsl::report
