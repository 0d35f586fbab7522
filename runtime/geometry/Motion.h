//===- Motion.h - affine maps that depend on time -------------------------===//
//
// Time runs from 0 to 1 while the shutter of a camera may be open. A moving map is a product of
// factors. An affine factor has a map at each of its keys, between which all twelve numbers are
// interpolated linearly. A rotation turns about one axis, at a steady speed, from each key to the
// next: scale, rotation and translation with keys are three factors. Before its first key and after
// its last one a factor rests.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/geometry/Transform.h"

#include <array>
#include <utility>
#include <vector>

namespace rtsl::runtime {

/// An orientation: a unit quaternion (w, x, y, z).
using Quaternion = std::array<double, 4>;

Quaternion axisRotation(const std::array<double, 3> &axis, double degrees);
/// First `a`, then `b`.
Quaternion product(const Quaternion &b, const Quaternion &a);
Transform rotationOf(const Quaternion &q);

/// A steady turn from an orientation: after a share s of its time it is cos(s angle) from + sin(s
/// angle) across. `across` is perpendicular to `from`, and the turn twice the angle, in radians.
struct Turn {
  Quaternion from, across;
  double angle;
};
/// The shortest turn between two orientations.
Turn turnBetween(const Quaternion &from, const Quaternion &to);
/// A turn by any number of degrees about an axis, of any length but zero.
Turn turnAbout(const std::array<double, 3> &axis, double fromDegrees, double toDegrees);

struct MotionFactor {
  std::vector<float> times;    // of the keys, ascending, in [0, 1]; one key: a constant
  std::vector<Transform> maps; // of an affine factor, at its keys
  std::vector<Turn> turns;     // of a rotation: each ends where the next one begins

  bool isRotation() const { return maps.empty(); }
  Transform at(double time) const;
};

/// An affine map that may depend on time.
class MovingTransform {
public:
  MovingTransform() = default;
  MovingTransform(const Transform &still) : atRest(still) {}
  explicit MovingTransform(MotionFactor factor) : product{std::move(factor)} {}

  bool moves() const { return !product.empty(); }
  /// If it does not move.
  const Transform &still() const { return atRest; }
  /// If it moves: the first one is applied first, and no two neighbours are constant.
  const std::vector<MotionFactor> &factors() const { return product; }

  Transform at(double time) const;
  /// The times of all keys of all factors, ascending, each once, with 0 and 1.
  std::vector<float> keyTimes() const;

  /// First `*this`, then `next`.
  MovingTransform then(const MovingTransform &next) const;

private:
  Transform atRest;
  std::vector<MotionFactor> product;
};

/// Is it a translation at all times?
bool isTranslation(const MovingTransform &transform);
/// Is it a scale along the axes, and a translation, at all times?
bool isScale(const MovingTransform &transform);
/// If it is a rotation with a uniform scale and a translation at all times, and the scale does not
/// change: the square of that; 1 if it is rigid. Otherwise 0. The product of the linear part with
/// its transpose is the identity times this number, to within a share of `mostStretch`.
double squaredScale(const MovingTransform &transform);
/// A bound that products of rotations in double stay far below; it is 2^-16 of a rounding unit of
/// floats.
constexpr double mostStretch = 0x1p-40;

bool operator==(const MovingTransform &a, const MovingTransform &b);
/// An order of any kind, for sorted containers.
bool operator<(const MovingTransform &a, const MovingTransform &b);

/// A box around all places of the box [lower, upper] at times from `begin` to `end`, in double.
/// `size` is a bound of the coordinates that occur in the computation. An infinite side stays
/// infinite.
///
/// Between two times at a distance h, a point that is accelerated by at most a is within h^2 a / 8
/// of the segment between its places at these times. So the boxes at some times, and the
/// accelerations in between, bound all places at all times. The acceleration is bounded by the
/// product rule, from the norms of the factors and of their derivatives.
struct SweptBox {
  std::array<double, 3> lower, upper, size;
};
SweptBox sweptBox(const MovingTransform &map, const float lower[3], const float upper[3],
                  float begin = 0, float end = 1);

/// The times at which a map is checked: its keys and some times between them.
std::vector<double> timesToCheck(const MovingTransform &map);

} // namespace rtsl::runtime
