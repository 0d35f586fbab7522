//===- Primitives.h - built-in functions that are one operation -----------===//
//
// `abs(x)` of a number is found where its type is declared; a function that is no template goes
// before these.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "language/formulas/Operations.h"

namespace rtsl::formulas {

#define RTSL_UNARY(name)                                                                           \
  template <typename Number>                                                                       \
  Number name(Number x) {                                                                          \
    return name(x);                                                                                \
  }
#define RTSL_BINARY(name)                                                                          \
  template <typename Number>                                                                       \
  Number name(Number x, Number y) {                                                                \
    return name(x, y);                                                                             \
  }
#define RTSL_TERNARY(name)                                                                         \
  template <typename Number>                                                                       \
  Number name(Number x, Number y, Number z) {                                                      \
    return name(x, y, z);                                                                          \
  }
RTSL_UNARY(abs)
RTSL_UNARY(floor)
RTSL_UNARY(ceil)
RTSL_UNARY(trunc)
RTSL_UNARY(roundEven)
RTSL_UNARY(sqrt)
RTSL_BINARY(equal)
RTSL_BINARY(notEqual)
RTSL_TERNARY(fma)
RTSL_TERNARY(refract)
#undef RTSL_UNARY
#undef RTSL_BINARY
#undef RTSL_TERNARY

} // namespace rtsl::formulas
