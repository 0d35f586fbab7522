//===- Passes.h - renderings that go on until the picture is good enough ---===//
#pragma once

#include "runtime/image/Image.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace rtsl::runtime {

/// A rendering in passes of samples, which ends at the first of these limits, or at
/// RenderOptions::samplesPerPixel. Sample indices go on from one pass to the next, so n samples per
/// pixel have the bits of a rendering with n samples per pixel.
struct PassOptions {
  double seconds = std::numeric_limits<double>::infinity(); // no pass begins later
  double error = 0;                                         // PassState::error; 0: no limit
  double secondsBetweenPictures = 10;
  /// Called after a pass if the last call is as long ago; not after the last pass.
  std::function<void(const Image &)> picture;
};

/// How far it is.
struct PassState {
  std::uint32_t samplesPerPixel = 0;
  double seconds = 0;
  /// The estimated relative error of the picture: the root of the mean over the pixels of the
  /// variance of their means, divided by the mean of the picture. A pixel's value is the mean of its
  /// components, its variance the sample variance divided by the number of samples, as if these were
  /// independent: they are spread evenly, so the true error is smaller. Measured at
  /// certain numbers of samples, which do not depend on time; infinite before the first of them.
  double error = std::numeric_limits<double>::infinity();
};

/// The sums of each pixel between passes.
struct PixelSums {
  std::vector<double> colors;         // as many as a color has components
  std::vector<double> squares;        // of pixel values
  std::vector<std::uint32_t> counted; // finite samples
};

/// The estimate of PassState::error. Infinite if no pixel has two samples; 0 for a black picture
/// without variance.
double relativeError(const PixelSums &sums, std::uint32_t components);

/// The next number of samples at which the error is measured: 16, 20, 25, ...
std::uint32_t nextMeasurement(std::uint32_t samples);

} // namespace rtsl::runtime
