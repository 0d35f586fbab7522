//===- Integers.h - carries, counting and moving bits ---------------------===//
//
// Bits are counted and moved by the parallel methods of "Bit Twiddling Hacks" (Anderson 1997-2005),
// which LLVM recognizes and turns into instructions.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "language/formulas/Operations.h"

namespace rtsl::formulas {

template <typename Number>
Number uaddCarry(Number x, Number y, Number &carry) {
  Number sum = x + y;
  carry = fromBool(lessUnsigned(sum, x));
  return sum;
}
template <typename Number>
Number usubBorrow(Number x, Number y, Number &borrow) {
  borrow = fromBool(lessUnsigned(x, y));
  return x - y;
}
template <typename Number>
void mulExtended(Number x, Number y, Number &high, Number &low, IntegerSign sign) {
  multiplyExtended(x, y, sign, high, low);
}

template <typename Number>
Number countBits(Number x) {
  x = x - (shiftRight(x, 1) & 0x55555555);
  x = (x & 0x33333333) + (shiftRight(x, 2) & 0x33333333);
  x = (x + shiftRight(x, 4)) & 0x0f0f0f0f;
  return shiftRight(x * 0x01010101, 24);
}

template <typename Number>
Number bitCount(Number x) {
  return outline("bitCount", countBits<Number>, x);
}

template <typename Number>
Number bitfieldReverse(Number x) {
  return outline(
      "bitfieldReverse",
      [](Number x) {
        static const std::int64_t masks[] = {0x55555555, 0x33333333, 0x0f0f0f0f, 0x00ff00ff};
        int distance = 1;
        for (std::int64_t mask : masks) {
          x = (shiftRight(x, distance) & mask) | shiftLeft(x & mask, distance);
          distance *= 2;
        }
        return shiftRight(x, 16) | shiftLeft(x, 16);
      },
      x);
}

/// The bits below the lowest one that is set; of 0 there is none, and the result is -1.
template <typename Number>
Number findLSB(Number x) {
  return outline(
      "findLSB", [](Number x) { return select(equal(x, 0.0), -1.0, countBits((x & -x) - 1.0)); },
      x);
}

/// Fills all bits below the highest one. Of a negative number the highest zero counts; of 0 and -1
/// the result is -1.
template <typename Number>
Number findMSB(Number x, IntegerSign sign) {
  const bool isSigned = sign == IntegerSign::Signed;
  return outline(
      isSigned ? "findMSB" : "findMSB.unsigned",
      [isSigned](Number x) {
        if (isSigned)
          x = x ^ shiftRightSigned(x, 31);
        for (int distance = 1; distance < 32; distance *= 2)
          x = x | shiftRight(x, distance);
        return countBits(x) - 1.0;
      },
      x);
}

/// GLSL leaves offset + bits > 32 open; here counts are taken modulo 32 (bits: 32 is 32).
template <typename Number>
Number bitfieldExtract(Number value, Number offset, Number bits, IntegerSign sign) {
  Number unused = (32.0 - bits) & 31;
  Number result = sign == IntegerSign::Signed
                      ? shiftRightSigned(shiftLeft(value, (32.0 - bits - offset) & 31), unused)
                      : shiftRight(value, offset & 31) & shiftRight(offset.like(-1), unused);
  return select(equal(bits, 0.0), 0.0, result);
}

template <typename Number>
Number bitfieldInsert(Number base, Number insert, Number offset, Number bits) {
  Number low = shiftRight(bits.like(-1), (32.0 - bits) & 31);
  Number mask = shiftLeft(select(equal(bits, 0.0), 0.0, low), offset & 31);
  return (base & (mask ^ -1)) | (shiftLeft(insert, offset & 31) & mask);
}

} // namespace rtsl::formulas
