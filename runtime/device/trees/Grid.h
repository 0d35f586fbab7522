//===- Grid.h - boxes on the grid of a node -------------------------------===//
//
// Rounded outwards, decided exactly: traversal relies on it (docs/gpu.md, "The picture does not
// depend on the grid").
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device::build {

/// a - b for floats, as a sum of two doubles: the rounded difference and its error.
struct Difference {
  double rounded, error;

  Difference(double a, double b) : rounded(a - b) {
    const double part = rounded - a;
    error = (a - (rounded - part)) - (b + part);
  }
};

/// A step of 2^(exponent - 127) along an axis. Products with powers of two are exact.
struct GridStep {
  double size, inverse;

  explicit GridStep(unsigned exponent)
      : size(power(int(exponent) - 127)), inverse(power(127 - int(exponent))) {}

  /// The largest number of steps from `origin` that does not go beyond `side`.
  double below(double origin, double side) const {
    const Difference distance(side, origin);
    const double steps = __builtin_floor(distance.rounded * inverse);
    return steps * size == distance.rounded && distance.error < 0 ? steps - 1 : steps;
  }
  /// The smallest number of steps that reaches `side`.
  double above(double origin, double side) const {
    const Difference distance(side, origin);
    const double steps = __builtin_ceil(distance.rounded * inverse);
    return steps * size == distance.rounded && distance.error > 0 ? steps + 1 : steps;
  }

private:
  static double power(int exponent) {
    const uint64_t bits = uint64_t(exponent + 1023) << 52;
    double number;
    __builtin_memcpy(&number, &bits, sizeof number);
    return number;
  }
};

/// The exponent of the finest grid of 255 steps that reaches from `lower` to `upper`, or nearly.
inline unsigned gridExponent(float lower, float upper) {
  const double size = double(upper) - double(lower);
  if (!(size > 0))
    return 1;
  uint64_t bits;
  __builtin_memcpy(&bits, &size, sizeof bits);
  const int wanted = int(bits >> 52) - 1023 - 7 + 127; // the size is below 2^8 steps
  const unsigned exponent = wanted < 1 ? 1 : unsigned(wanted);
  // ... and 255 may be too few.
  return GridStep(exponent).above(lower, upper) > 255 ? exponent + 1 : exponent;
}

/// Sets the grid of a node for boxes within `all`.
inline void setGrid(RtslBvhNode &node, const RtslBox &all) {
  for (int axis = 0; axis < 3; ++axis) {
    node.origin[axis] = all.lower[axis];
    node.exponent[axis] = uint8_t(gridExponent(all.lower[axis], all.upper[axis]));
  }
}

/// Sets the box of the child in a slot, within those bounds.
inline void setBox(RtslBvhNode &node, unsigned slot, const RtslBox &box) {
  for (int axis = 0; axis < 3; ++axis) {
    const GridStep step(node.exponent[axis]);
    node.lower[axis][slot] = uint8_t(step.below(node.origin[axis], box.lower[axis]));
    node.upper[axis][slot] = uint8_t(step.above(node.origin[axis], box.upper[axis]));
  }
}

} // namespace rtsl::device::build
