//===- LibraryInteger.cpp - counting and moving bits ----------------------===//
//
// By the parallel methods of "Bit Twiddling Hacks" (Anderson 1997-2005), which LLVM knows and turns
// into instructions.
//
//===----------------------------------------------------------------------===//
#include "codegen/formulas/Library.h"

namespace rtsl::lowering {

static Num countBits(Num x) {
  x = x - (shiftRight(x, 1) & 0x55555555);
  x = (x & 0x33333333) + (shiftRight(x, 2) & 0x33333333);
  x = (x + shiftRight(x, 4)) & 0x0f0f0f0f;
  return shiftRight(x * 0x01010101, 24);
}

Num Library::bitCount(Num x) {
  return callOne("bitCount", {x}, x.type(),
                 [](llvm::ArrayRef<Num> arguments) { return countBits(arguments[0]); });
}

Num Library::bitfieldReverse(Num x) {
  return callOne("bitfieldReverse", {x}, x.type(), [](llvm::ArrayRef<Num> arguments) {
    Num x = arguments[0];
    static const std::int64_t masks[] = {0x55555555, 0x33333333, 0x0f0f0f0f, 0x00ff00ff};
    int distance = 1;
    for (std::int64_t mask : masks) {
      x = (shiftRight(x, distance) & mask) | shiftLeft(x & mask, distance);
      distance *= 2;
    }
    return shiftRight(x, 16) | shiftLeft(x, 16);
  });
}

// The bits below the lowest one that is set; of 0 there is none, and the answer is -1.
Num Library::findLSB(Num x) {
  return callOne("findLSB", {x}, x.type(), [](llvm::ArrayRef<Num> arguments) {
    Num x = arguments[0];
    return select(equal(x, 0.0), -1.0, countBits((x & -x) - 1.0));
  });
}

// Fills all bits below the highest one. Of a negative number the highest zero counts; of 0 and -1
// the answer is -1.
Num Library::findMSB(Num x, bool isSigned) {
  return callOne(isSigned ? "findMSB" : "findMSB.unsigned", {x}, x.type(),
                 [isSigned](llvm::ArrayRef<Num> arguments) {
                   Num x = arguments[0];
                   if (isSigned)
                     x = x ^ shiftRightSigned(x, 31);
                   for (int distance = 1; distance < 32; distance *= 2)
                     x = x | shiftRight(x, distance);
                   return countBits(x) - 1.0;
                 });
}

// GLSL leaves offset + bits > 32 open; here counts are taken modulo 32 (bits: 32 is 32).
Num bitfieldExtract(Num value, Num offset, Num bits, bool isSigned) {
  Num unused = (32.0 - bits) & 31;
  Num result = isSigned ? shiftRightSigned(shiftLeft(value, (32.0 - bits - offset) & 31), unused)
                        : shiftRight(value, offset & 31) & shiftRight(offset.like(-1), unused);
  return select(equal(bits, 0.0), 0.0, result);
}

Num bitfieldInsert(Num base, Num insert, Num offset, Num bits) {
  Num low = shiftRight(bits.like(-1), (32.0 - bits) & 31);
  Num mask = shiftLeft(select(equal(bits, 0.0), 0.0, low), offset & 31);
  return (base & (mask ^ -1)) | (shiftLeft(insert, offset & 31) & mask);
}

} // namespace rtsl::lowering
