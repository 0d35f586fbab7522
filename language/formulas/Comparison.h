//===- Comparison.h - lessThan and the like -------------------------------===//
#pragma once

#include "language/formulas/Operations.h"

namespace rtsl::formulas {

template <typename Number>
Number lessThan(Number x, Number y, IntegerSign sign) {
  return sign == IntegerSign::Unsigned ? lessUnsigned(x, y) : less(x, y);
}
template <typename Number>
Number lessThanEqual(Number x, Number y, IntegerSign sign) {
  return sign == IntegerSign::Unsigned ? !lessUnsigned(y, x) : lessEqual(x, y);
}
template <typename Number>
Number greaterThan(Number x, Number y, IntegerSign sign) {
  return lessThan(y, x, sign);
}
template <typename Number>
Number greaterThanEqual(Number x, Number y, IntegerSign sign) {
  return lessThanEqual(y, x, sign);
}
template <typename Number>
Number logicalNot(Number x) {
  return !x;
}

} // namespace rtsl::formulas
