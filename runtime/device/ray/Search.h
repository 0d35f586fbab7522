//===- Search.h - searching ascending tables without jumps ----------------===//
//
// What is searched for is as a rule random, or the surface that a ray happens to hit: a jump on a
// comparison could not be predicted. Here the number of steps depends on the size of the table
// alone, and each of them selects.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <stdint.h>

namespace rtsl::device {

/// How many of the first count - 1 values of an ascending table come before what is searched for,
/// by isBefore(index); count is at least 1. So the result is the index of the first value that does
/// not come before it, or of the last one.
template <typename IsBefore>
uint32_t indexInTable(uint32_t count, IsBefore isBefore) {
  uint32_t first = 0; // the result is in [first, first + count)
  while (count > 1) {
    const uint32_t half = count / 2;
    const uint32_t isInUpper = isBefore(first + half - 1) ? 1u : 0u;
    first += isInUpper * half;
    count -= half;
  }
  return first;
}

} // namespace rtsl::device
