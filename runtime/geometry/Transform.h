//===- Transform.h - affine maps ------------------------------------------===//
#pragma once

#include <array>

namespace rtsl::runtime {

/// An affine map: four columns of three, the last one the translation. x' = c0 x + c1 y + c2 z +
/// c3.
struct Transform {
  std::array<std::array<double, 3>, 4> columns{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

  static Transform translate(double x, double y, double z);
  static Transform scale(double x, double y, double z);
  /// Rotates by `degrees` about `axis` (of any length but zero), counter-clockwise when the axis
  /// points at the viewer.
  static Transform rotate(const std::array<double, 3> &axis, double degrees);

  /// First `*this`, then `next`.
  Transform then(const Transform &next) const;
  double determinant() const;
  bool isIdentity() const { return columns == Transform().columns; }
};

/// The inverse of the linear part, and how far it can be trusted.
struct LinearInverse {
  std::array<std::array<double, 3>, 3> columns;
  /// The condition number of the linear part: the product of its Frobenius norm and that of the
  /// inverse, at least 3; infinite if there is no inverse.
  double condition;
};

LinearInverse invertLinear(const Transform &transform);

/// A multiple of the inverse transpose of the linear part, as columns, which maps a normal to the
/// same side of the surface: its cofactors, times the sign of the determinant.
std::array<std::array<double, 3>, 3> normalTransform(const Transform &transform);

} // namespace rtsl::runtime
