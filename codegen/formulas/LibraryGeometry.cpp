//===- LibraryGeometry.cpp - dot, length, normalize, ... -------------------===//
#include "codegen/formulas/Library.h"

#include <cfloat>

namespace rtsl::lowering {

Num dot(Num a, Num b) {
  Num products = a * b;
  Num sum = products[0];
  for (unsigned i = 1; i < products.count(); ++i)
    sum = sum + products[i];
  return sum;
}

Num differenceOfProducts(Num a, Num b, Num c, Num d) {
  Num product = c * d;
  Num error = fma(-c, d, product); // exact
  return fma(a, b, -product) + error;
}

Num cross(Num a, Num b) {
  return differenceOfProducts(a.shuffle({1, 2, 0}), b.shuffle({2, 0, 1}), a.shuffle({2, 0, 1}),
                              b.shuffle({1, 2, 0}));
}

Num faceforward(Num n, Num i, Num reference) {
  return select(less(dot(reference, i), 0.0), n, -n);
}

Num reflect(Num i, Num n) {
  return i - (2.0 * dot(n, i)) * n;
}

//===----------------------------------------------------------------------===//
// Length. The sum of squares is good as it is while it neither overflows nor loses digits that
// count; otherwise the vector is scaled by a power of two first, which is exact where it matters.
// Errors: length 2 ulp, normalize 2.5 ulp a component.
//===----------------------------------------------------------------------===//

// Below, squares that are subnormal could reach the last digits of the sum; above, the sum has
// overflowed.
static Num isGoodSquare(Num square) {
  return lessEqual(0x1p-96, square) & lessEqual(square, static_cast<double>(FLT_MAX));
}

// For a square that is not good: 2^-70 for a vector that is too large, 2^100 for one that is too
// small.
static Num scaleFor(Num square) {
  return select(less(1.0, square), 0x1p-70, square.like(0x1p100));
}
static Num scaleBackFor(Num square) {
  return select(less(1.0, square), 0x1p70, square.like(0x1p-100));
}

Num Library::length(Num v) {
  if (v.width() == 0)
    return abs(v);
  return callOne("length", {v}, scalarType(v.type()), [](llvm::ArrayRef<Num> arguments) {
    Num v = arguments[0];
    Num square = dot(v, v);
    return choose(
        isGoodSquare(square), square.type(), [&] { return sqrt(square); },
        [&] {
          Num scaled = v * scaleFor(square);
          return sqrt(dot(scaled, scaled)) * scaleBackFor(square);
        });
  });
}

// v / length(v); of the zero vector the zero vector.
Num Library::normalize(Num v) {
  if (v.width() == 0)
    return select(equal(v, 0.0), v, v / abs(v));
  return callOne("normalize", {v}, v.type(), [](llvm::ArrayRef<Num> arguments) {
    Num v = arguments[0];
    Num square = dot(v, v);
    return choose(
        isGoodSquare(square), v.type(), [&] { return v / sqrt(square); },
        [&] {
          Num scaled = v * scaleFor(square);
          Num scaledSquare = dot(scaled, scaled);
          return select(equal(scaledSquare, 0.0), scaled, scaled / sqrt(scaledSquare));
        });
  });
}

// The vector across v in the plane of its middle axis and the larger of the others: that leaves at
// least |v| / sqrt(2), so nothing cancels near any axis (Hughes and Moeller, "Building an
// Orthonormal Basis from a Unit Vector", 1999). The zero vector gives the x axis.
Num Library::perpendicularTo(Num v) {
  return callOne("perpendicularTo", {v}, v.type(), [this](llvm::ArrayRef<Num> arguments) {
    Num v = arguments[0];
    Emitter &emitter = v.at();
    Num x = v[0], y = v[1], z = v[2], zero = x.like(0);
    Num inXY(emitter, emitter.vector({-y, x, zero}));
    Num inYZ(emitter, emitter.vector({zero, -z, y}));
    Num across = normalize(select(less(abs(z), abs(x)), inXY, inYZ));
    Num xAxis(emitter, emitter.vector({x.like(1), zero, zero}));
    return select(all(equal(across, 0.0)), xAxis, across);
  });
}

} // namespace rtsl::lowering
