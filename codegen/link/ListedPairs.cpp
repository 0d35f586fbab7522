#include "codegen/link/ListedPairs.h"

#include "runtime/device/ray/ListedPairs.h"

#include "llvm/ADT/APFloat.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace rtsl {

namespace {

/// With fewer it is not faster (docs/gpu.md): it costs more for each ray, and enters more boxes.
constexpr std::size_t fewestInPairs = 12;

/// How many times as many boxes a ray may enter, as their areas say.
constexpr double mostEntered = 1.1;

std::uint16_t halfOf(double number, llvm::RoundingMode mode) {
  llvm::APFloat half(number);
  bool isInexact;
  half.convert(llvm::APFloat::IEEEhalf(), mode, &isInexact);
  return static_cast<std::uint16_t>(half.bitcastToAPInt().getZExtValue());
}

double numberOf(std::uint16_t half) {
  llvm::APFloat number(llvm::APFloat::IEEEhalf(), llvm::APInt(16, half));
  bool isInexact;
  number.convert(llvm::APFloat::IEEEdouble(), llvm::APFloat::rmNearestTiesToEven, &isInexact);
  return number.convertToDouble();
}

bool isFinite(const RtslInstance &box) {
  return std::all_of(box.lower, box.lower + 3, [](float side) { return std::isfinite(side); }) &&
         std::all_of(box.upper, box.upper + 3, [](float side) { return std::isfinite(side); });
}

/// Where the finite boxes are.
struct Surroundings {
  float middle[3] = {0, 0, 0};
  double scale = 0; // a power of two, which brings them into [-1, 1]; 0: there are none

  explicit Surroundings(const std::vector<RtslInstance> &boxes) {
    double lower[3], upper[3], size = 0;
    std::fill_n(lower, 3, INFINITY);
    std::fill_n(upper, 3, -INFINITY);
    for (const RtslInstance &box : boxes)
      for (int axis = 0; axis < 3 && isFinite(box); ++axis) {
        lower[axis] = std::min(lower[axis], double(box.lower[axis]));
        upper[axis] = std::max(upper[axis], double(box.upper[axis]));
      }
    for (int axis = 0; axis < 3; ++axis) {
      if (!(lower[axis] <= upper[axis]))
        return;
      middle[axis] = float((lower[axis] + upper[axis]) / 2);
      size = std::max({size, upper[axis] - middle[axis], middle[axis] - lower[axis]});
    }
    if (size > 0x1p-60 && size < 0x1p60)
      scale = std::exp2(-std::ceil(std::log2(size)));
  }
};

/// Half of the area of a box with these halves of its sides.
double halfArea(const double *half) {
  return 4 * (half[0] * half[1] + half[1] * half[2] + half[2] * half[0]);
}

} // namespace

std::vector<std::int32_t> listedPairs(const std::vector<RtslInstance> &instances) {
  const Surroundings all(instances);
  if (instances.size() < fewestInPairs || all.scale == 0)
    return {};
  RtslListedPairs list{};
  list.scale = float(all.scale);
  for (int axis = 0; axis < 3; ++axis)
    list.offset[axis] = float(-all.middle[axis] * all.scale);
  const std::size_t count = device::pairCount(std::uint32_t(instances.size()));
  std::vector<RtslListedPair> pairs(count);
  double area = 0, enlarged = 0;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const RtslInstance &box = instances[i];
    double exactly[3], halves[3];
    for (int axis = 0; axis < 3; ++axis) {
      std::uint16_t middle = 0, half = halfOf(INFINITY, llvm::APFloat::rmNearestTiesToEven);
      if (isFinite(box)) {
        const double lower = (double(box.lower[axis]) - all.middle[axis]) * all.scale,
                     upper = (double(box.upper[axis]) - all.middle[axis]) * all.scale;
        middle = halfOf((lower + upper) / 2, llvm::APFloat::rmNearestTiesToEven);
        const double m = numberOf(middle), size = std::max(upper - m, m - lower);
        half = halfOf(size + 0x1.06p-11 * (4 * std::abs(m) + 3.02 * size) + 0x1p-19,
                      llvm::APFloat::rmTowardPositive);
        exactly[axis] = (upper - lower) / 2;
        halves[axis] = numberOf(half);
      }
      const unsigned shift = i < count ? 0 : 16;
      RtslListedPair &pair = pairs[i % count];
      pair.middle[axis] |= std::uint32_t(middle) << shift;
      pair.half[axis] |= std::uint32_t(half) << shift;
    }
    if (isFinite(box)) {
      area += halfArea(exactly);
      enlarged += halfArea(halves);
    }
  }
  if (!(enlarged <= mostEntered * area))
    return {};
  std::vector<std::int32_t> words((sizeof list + count * sizeof pairs[0]) / 4);
  std::memcpy(words.data(), &list, sizeof list);
  std::memcpy(words.data() + sizeof list / 4, pairs.data(), count * sizeof pairs[0]);
  return words;
}

} // namespace rtsl
