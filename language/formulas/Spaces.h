//===- Spaces.h - points, vectors and normals between two spaces ----------===//
//
// `toWorld` and `toObject` are the columns of rt_ObjectToWorld and rt_WorldToObject.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "language/formulas/Matrices.h"

namespace rtsl::formulas {

/// The first three components of a column.
template <typename Number>
Number direction(Number column) {
  return Number::vector({column[0], column[1], column[2]});
}

/// A direction or a difference of points: the linear part times v.
template <typename Number>
Number transformVector(const Columns<Number> &m, Number v) {
  return multiply(Columns<Number>{direction(m[0]), direction(m[1]), direction(m[2])}, v);
}

template <typename Number>
Number pointToWorld(const Columns<Number> &toWorld, Number p) {
  return transformVector(toWorld, p) + direction(toWorld[3]);
}

/// The translation is subtracted first, so that far from the origin no digits are lost.
template <typename Number>
Number pointToObject(const Columns<Number> &toWorld, const Columns<Number> &toObject, Number p) {
  return transformVector(toObject, p - direction(toWorld[3]));
}

/// A normal, by the matrix of the other direction: its transpose times n.
template <typename Number>
Number transformNormal(const Columns<Number> &inverse, Number n) {
  return multiply(
      n, Columns<Number>{direction(inverse[0]), direction(inverse[1]), direction(inverse[2])});
}

} // namespace rtsl::formulas
