//===- Comparison.h - comparisons of vectors, and of their results --------===//
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

template <typename Number>
Number all(Number x) {
  Number result = x[0];
  for (unsigned i = 1; i < x.count(); ++i)
    result = result & x[i];
  return result;
}
template <typename Number>
Number any(Number x) {
  Number result = x[0];
  for (unsigned i = 1; i < x.count(); ++i)
    result = result | x[i];
  return result;
}

} // namespace rtsl::formulas
