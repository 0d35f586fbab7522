//===- LibraryPacking.cpp - half floats -----------------------------------===//
//
// In integers, so that every target and the printed C++ give the same bits, NaN included.
//
//===----------------------------------------------------------------------===//
#include "codegen/formulas/Library.h"

namespace rtsl::lowering {

// Rounds to nearest, ties to even.
Num Library::halfFromFloat(Num x) {
  mlir::Type result = withScalar(x.type(), x.at().getI32Type());
  return callOne("halfFromFloat", {x}, result, [](llvm::ArrayRef<Num> arguments) {
    Num bits = arguments[0].bits();
    Num sign = shiftRight(bits, 16) & 0x8000;
    Num magnitude = bits & 0x7fffffff;
    // Normal halves: 13 bits go, the exponent's bias falls by 112. A carry may reach the exponent,
    // up to infinity.
    Num isOdd = shiftRight(magnitude, 13) & 1;
    Num normal = shiftRight(magnitude - 0x38000000 + 0xfff + isOdd, 13);
    // Subnormal halves are multiples of 2^-24, the distance of floats just above 0.5.
    Num subnormal = (magnitude.asFloat() + 0.5).bits() - 0x3f000000;
    Num half = select(less(magnitude, 0x38800000), subnormal, normal);
    half = select(less(0x477fffff, magnitude), 0x7c00, half);        // 65536 and more
    return select(less(0x7f800000, magnitude), 0x7e00, sign | half); // of a NaN no sign is seen
  });
}

Num Library::floatFromHalf(Num bits) {
  mlir::Type result = withScalar(bits.type(), bits.at().getF32Type());
  return callOne("floatFromHalf", {bits}, result, [](llvm::ArrayRef<Num> arguments) {
    Num bits = arguments[0];
    Num magnitude = bits & 0x7fff;
    Num normal = shiftLeft(magnitude, 13) + 0x38000000;
    // Read as a significand behind an exponent of 2^-14, then the leading one is taken away: exact.
    Num subnormal = ((shiftLeft(magnitude, 13) + 0x38800000).asFloat() - 0x1p-14).bits();
    Num value = select(less(magnitude, 0x400), subnormal, normal);
    value = select(less(0x7bff, magnitude), normal + 0x38000000, value); // infinity and NaN
    return (value | shiftLeft(bits & 0x8000, 16)).asFloat();
  });
}

} // namespace rtsl::lowering
