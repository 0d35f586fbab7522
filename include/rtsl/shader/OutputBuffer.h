//===- OutputBuffer.h - buffers that a launch writes ----------------------===//
#pragma once

#include "rtsl/shader/State.h"
#include "rtsl/shader/Types.h"

namespace rtsl {
inline namespace RTSL_VARIANT {

/// `public out T name[]`, `[][]` or `[][][]`, and `inout`. An index is clamped; an element of an
/// empty buffer is zero and cannot be changed.
template <typename T, int Rank = 1>
class OutputBuffer : public Buffer<T, Rank> {
public:
  /// The element; a copy of it if an exception has ended the sample, which then writes nothing.
  template <int N, typename... Index>
  T &at(State<N> &rt, Index... indices) const {
    T *element = const_cast<T *>(this->find(indices...));
    if (element && !rtsl_is_abandoned(rawState(rt)))
      return *element;
    thread_local T copy;
    copy = element ? *element : T();
    return copy;
  }
};

// The value as it was. No order of other accesses to memory is implied.
template <typename T>
inline T atomicAdd(T &place, T value) {
  return __atomic_fetch_add(&place, value, __ATOMIC_RELAXED);
}
template <typename T>
inline T atomicAnd(T &place, T value) {
  return __atomic_fetch_and(&place, value, __ATOMIC_RELAXED);
}
template <typename T>
inline T atomicOr(T &place, T value) {
  return __atomic_fetch_or(&place, value, __ATOMIC_RELAXED);
}
template <typename T>
inline T atomicXor(T &place, T value) {
  return __atomic_fetch_xor(&place, value, __ATOMIC_RELAXED);
}
template <typename T>
inline T atomicExchange(T &place, T value) {
  return __atomic_exchange_n(&place, value, __ATOMIC_RELAXED);
}
template <typename T>
inline T atomicCompSwap(T &place, T expected, T value) {
  __atomic_compare_exchange_n(&place, &expected, value, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED);
  return expected;
}
// Stores `value` if `replaces(value, old)`.
template <typename T, typename Replaces>
inline T atomicReplaceIf(T &place, T value, Replaces replaces) {
  T old = __atomic_load_n(&place, __ATOMIC_RELAXED);
  while (replaces(value, old) && !__atomic_compare_exchange_n(&place, &old, value, true,
                                                              __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
  return old;
}
template <typename T>
inline T atomicMin(T &place, T value) {
  return atomicReplaceIf(place, value, [](T a, T b) { return a < b; });
}
template <typename T>
inline T atomicMax(T &place, T value) {
  return atomicReplaceIf(place, value, [](T a, T b) { return a > b; });
}

} // namespace RTSL_VARIANT
} // namespace rtsl
