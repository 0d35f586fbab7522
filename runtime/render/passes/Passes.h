//===- Passes.h - renderings that go on until the picture is good enough ---===//
#pragma once

#include "runtime/render/RenderOptions.h"
#include "runtime/render/passes/PixelSums.h"

#include <cstdint>
#include <functional>
#include <limits>

namespace rtsl::runtime {

/// How far a rendering in passes is.
struct PassState {
  std::uint32_t samplesPerPixel = 0; // that every pixel has which needs them
  double seconds = 0;
  /// The estimated relative error of the picture: the root of the mean over the pixels of the
  /// variance of their means, divided by the mean of the picture. A pixel's value is the mean of
  /// its components, its variance the sample variance divided by the number of samples, as if these
  /// were independent: they are spread evenly, so the true error is smaller. Measured at
  /// certain numbers of samples, which do not depend on time; infinite before the first of them.
  /// In an adaptive rendering it is the same measure, by Adaptive.h.
  double error = std::numeric_limits<double>::infinity();
};

/// All that a rendering needs to be continued.
struct PartialRendering {
  PassState state;
  PixelSums sums;
  /// What rays and samples have met, and the first samples that are not finite. Counts that follow
  /// from the sums are 0.
  RenderStatistics met;
};

/// A rendering in passes of samples, which ends at the first of these limits, or at
/// RenderOptions::samplesPerPixel. Sample indices go on from one pass to the next, so n samples per
/// pixel have the bits of a rendering with n samples per pixel.
struct PassOptions {
  double seconds = std::numeric_limits<double>::infinity(); // no pass begins later
  /// PassState::error; 0: no limit. With RenderOptions::isAdaptive there must be one.
  double error = 0;
  double secondsBetweenPictures = 10;
  /// Called after a pass if the last call is as long ago; not after the last pass.
  std::function<void(const Image &)> picture;

  double secondsBetweenCheckpoints = 30;
  /// Called with a rendering that can be resumed: at these intervals, and at the end with true.
  /// Passes are interrupted for it.
  std::function<void(const PartialRendering &, bool isLast)> checkpoint;

  /// Is the error of the picture measured, or may it be when its checkpoint is resumed?
  bool isMeasured() const { return error > 0 || checkpoint; }

  /// How long a pass may go on after RenderOptions::cancel was set, so that all pixels have the
  /// same number of samples, and none is black. Without effect on what a checkpoint resumes.
  double secondsToEndPass() const { return checkpoint ? 0 : 2; }
};

/// What is good for a machine.
struct PassSizes {
  /// Samples per pixel of the first pass, if there is no limit of time.
  std::uint32_t first = 1;
  /// Later passes end at a multiple of it, if they reach one.
  std::uint32_t multiple = 1;
  /// A pass with all samples, if it does not last, takes less time than several.
  bool prefersWhole = true;
  /// A single pass of several samples takes less time without sums of the host's.
  bool prefersNoSums = false;
};

/// How many samples per pixel the next pass takes; `most` is the limit of all passes. Passes are
/// short, so that the limits are met and Ctrl-C need not wait, and long enough, and so few, that
/// starting threads costs nothing. None passes a number of samples at which the error is measured.
std::uint32_t samplesOfPass(const PassState &state, const PassOptions &passes,
                            const PassSizes &sizes, std::uint32_t most);

/// The next number of samples at which the error is measured: 16, 20, 25, ...
std::uint32_t nextMeasurement(std::uint32_t samples);

} // namespace rtsl::runtime
