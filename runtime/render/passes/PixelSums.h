//===- PixelSums.h - the sums of a rendering that goes on -----------------===//
#pragma once

#include "runtime/device/organisations/Job.h"
#include "runtime/image/Image.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

/// The exact sums of the samples of each pixel, in the order of the samples. A rendering that goes
/// on with them has the bits of one that was never interrupted. RtslPixelSums, as it is owned: the
/// samples of an adaptive rendering are in two halves.
struct PixelSums {
  std::vector<double> colors;         // as many as a color has components
  std::vector<double> squares;        // of the values of samples: the means of their components.
                                      // Empty if no error will be measured
  std::vector<std::uint32_t> counted; // finite samples in `colors`
  std::vector<std::uint32_t> taken;   // all samples

  // Of an adaptive rendering; otherwise empty.
  std::vector<double> values;          // of the samples in `squares`
  std::vector<std::uint32_t> deciding; // their number
  std::vector<std::uint32_t> closed;   // bit h: half h of the pixel is complete

  static constexpr std::uint32_t allClosed = 3;

  /// Sums without samples. Throws OutOfMemory.
  static PixelSums make(std::uint64_t pixels, std::uint32_t components, bool isAdaptive = false,
                        bool isMeasured = true);

  RtslPixelSums pointers();
  std::size_t pixels() const { return taken.size(); }
  bool isEmpty() const { return taken.empty(); }
  bool isAdaptive() const { return !closed.empty(); }
  bool isMeasured() const { return !squares.empty(); }
  std::uint32_t halves() const { return isAdaptive() ? 2 : 1; }
  /// Whether the pixel takes samples.
  bool isOpen(std::size_t pixel) const { return !isAdaptive() || closed[pixel] != allClosed; }
};

/// Calls visit(list, ...) for each list of the sums: with those of several, and of RtslPixelSums,
/// at once. Lists that only some renderings have are empty, or null, in others. Checkpoints have
/// this order.
template <typename Visit, typename... Sums>
void forEachList(Visit visit, Sums &...sums) {
  visit(sums.colors...);
  visit(sums.squares...);
  visit(sums.counted...);
  visit(sums.taken...);
  visit(sums.values...);
  visit(sums.deciding...);
  visit(sums.closed...);
}

/// Calls visit(elements, those of `copy`, bytes) for `count` pixels from `first` on of each list
/// that there is. `copy` may be in the memory of a device.
template <typename Visit, typename Sums>
void forEachPart(Visit visit, Sums &sums, const RtslPixelSums &copy, std::size_t first,
                 std::size_t count) {
  const auto ofList = [&](auto &values, auto *there) {
    const std::size_t ofPixel = values.size() / sums.pixels();
    const std::size_t from = first * ofPixel;
    if (ofPixel > 0)
      visit(values.data() + from, there + from, count * ofPixel * sizeof values[0]);
  };
  forEachList(ofList, sums, copy);
}

/// How many samples have been taken.
struct SampleCounts {
  std::uint64_t samples = 0, notFinite = 0, pixelsWithoutSample = 0;
  // Of a pixel that takes samples; of any pixel, if none does.
  std::uint32_t least = 0, most = 0;
  std::uint64_t openPixels = 0;     // that take samples
  std::uint64_t pixelsWithMost = 0; // of these
};
SampleCounts countSamples(const PixelSums &sums);

/// Writes the means of the pixels to a picture of the same size: black where there is no sample,
/// `withoutSample` where none was finite. The mean of two halves is that of their means, so that
/// it does not depend on which one has more samples. On so many threads; 0: one per core.
void resolve(const PixelSums &sums, float withoutSample, Image &picture, unsigned threads);

/// The estimate of PassState::error. Infinite if no pixel has two samples; 0 for a black picture
/// without variance.
double relativeError(const PixelSums &sums, std::uint32_t components);

} // namespace rtsl::runtime
