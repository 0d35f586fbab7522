//===- Geometry.h - dot, length, normalize, ... ---------------------------===//
#pragma once

#include "language/formulas/Common.h"

#include <cfloat>

namespace rtsl::formulas {

/// ((x x' + y y') + z z') + w w', each operation rounded.
template <typename Number>
Number dot(Number a, Number b) {
  Number products = a * b;
  Number sum = products[0];
  for (unsigned i = 1; i < products.count(); ++i)
    sum = sum + products[i];
  return sum;
}

/// a b - c d within 1.5 ulp, and exactly 0 for a b == c d: Kahan's algorithm, analysed by
/// Jeannerod, Louvet and Muller, "Further analysis of Kahan's algorithm for the accurate
/// computation of 2 x 2 determinants" (2013).
template <typename Number>
Number differenceOfProducts(Number a, Number b, Number c, Number d) {
  Number product = c * d;
  Number error = fma(-c, d, product); // exact
  return fma(a, b, -product) + error;
}

template <typename Number>
Number cross(Number a, Number b) {
  Number bNext = b.shuffle({1, 2, 0}), aLast = a.shuffle({2, 0, 1});
  Number bLast = b.shuffle({2, 0, 1}), aNext = a.shuffle({1, 2, 0});
  return differenceOfProducts(aNext, bLast, aLast, bNext);
}

template <typename Number>
Number faceforward(Number n, Number i, Number reference) {
  Number opposite = -n;
  return select(less(dot(reference, i), 0.0), n, opposite);
}

template <typename Number>
Number reflect(Number i, Number n) {
  return i - (2.0 * dot(n, i)) * n;
}

//===----------------------------------------------------------------------===//
// Length. The sum of squares is good as it is while it neither overflows nor loses digits that
// count; otherwise the vector is scaled by a power of two first, which is exact where it matters.
// Errors: length 2 ulp, normalize 2.5 ulp a component.
//===----------------------------------------------------------------------===//

/// Below, squares that are subnormal could reach the last digits of the sum; above, the sum has
/// overflowed.
template <typename Number>
Number isGoodSquare(Number square) {
  Number hasNotOverflowed = lessEqual(square, static_cast<double>(FLT_MAX));
  return lessEqual(0x1p-96, square) & hasNotOverflowed;
}

/// For a square that is not good: 2^-70 for a vector that is too large, 2^100 for one that is too
/// small.
template <typename Number>
Number scaleFor(Number square) {
  Number up = square.like(0x1p100);
  return select(less(1.0, square), 0x1p-70, up);
}
template <typename Number>
Number scaleBackFor(Number square) {
  Number down = square.like(0x1p-100);
  return select(less(1.0, square), 0x1p70, down);
}

template <typename Number>
Number length(Number v) {
  if (v.width() == 0)
    return abs(v);
  return outline(
      "length",
      [](Number v) {
        Number square = dot(v, v);
        return choose(
            isGoodSquare(square), square, [&] { return sqrt(square); },
            [&] {
              Number scaled = v * scaleFor(square), scaleBack = scaleBackFor(square);
              return sqrt(dot(scaled, scaled)) * scaleBack;
            });
      },
      v);
}

template <typename Number>
Number distance(Number a, Number b) {
  return length(a - b);
}

/// v / length(v); of the zero vector the zero vector.
template <typename Number>
Number normalize(Number v) {
  if (v.width() == 0)
    return select(equal(v, 0.0), v, v / abs(v));
  return outline(
      "normalize",
      [](Number v) {
        Number square = dot(v, v);
        return choose(
            isGoodSquare(square), v, [&] { return v / sqrt(square); },
            [&] {
              Number scaled = v * scaleFor(square);
              Number scaledSquare = dot(scaled, scaled);
              Number unit = scaled / sqrt(scaledSquare);
              return select(equal(scaledSquare, 0.0), scaled, unit);
            });
      },
      v);
}

/// The vector across v in the plane of its middle axis and the larger of the others: that leaves at
/// least |v| / sqrt(2), so nothing cancels near any axis (Hughes and Moeller, "Building an
/// Orthonormal Basis from a Unit Vector", 1999). The zero vector gives the x axis.
template <typename Number>
Number perpendicularTo(Number v) {
  return outline(
      "perpendicularTo",
      [](Number v) {
        Number x = v[0], y = v[1], z = v[2], zero = x.like(0);
        Number inXY = Number::vector({-y, x, zero});
        Number inYZ = Number::vector({zero, -z, y});
        Number across = normalize(select(less(abs(z), abs(x)), inXY, inYZ));
        Number xAxis = Number::vector({x.like(1), zero, zero});
        return select(all(equal(across, 0.0)), xAxis, across);
      },
      v);
}

} // namespace rtsl::formulas
