//===- PixelSums.h - the sums of a rendering that goes on -----------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/image/Image.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// The exact sums of the samples of each pixel, in the order of the samples. A rendering that goes
/// on with them has the bits of one that was never interrupted. RtslPixelSums, as it is owned.
struct PixelSums {
  std::vector<double> colors;         // as many as a color has components
  std::vector<double> squares;        // of pixel values: the means of the components
  std::vector<std::uint32_t> counted; // finite samples
  std::vector<std::uint32_t> taken;   // all samples

  /// Without samples. Throws OutOfMemory.
  static PixelSums make(std::uint64_t pixels, std::uint32_t components);

  RtslPixelSums pointers();
  std::size_t pixels() const { return taken.size(); }
  bool isEmpty() const { return taken.empty(); }
};

/// What has been taken of all samples.
struct SampleCounts {
  std::uint64_t samples = 0, notFinite = 0, pixelsWithoutSample = 0;
  std::uint32_t least = 0, most = 0; // of a pixel
};
SampleCounts countSamples(const PixelSums &sums);

/// Writes the means of the pixels to a picture of the same size: black where there is no sample,
/// `withoutSample` where none was finite.
void resolve(const PixelSums &sums, float withoutSample, Image &picture);

/// The estimate of PassState::error. Infinite if no pixel has two samples; 0 for a black picture
/// without variance.
double relativeError(const PixelSums &sums, std::uint32_t components);

} // namespace rtsl::runtime
