//===- Warp.h - lanes that run in step ------------------------------------===//
//
// On a GPU 32 lanes form a warp: they run the same code at the same time, or wait for each other.
// On a CPU each lane is a warp of its own.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"

#include <stdint.h>

namespace rtsl::device {

#ifdef __NVPTX__

constexpr uint32_t lanesOfWarp = 32;

namespace warp {
constexpr uint32_t all = 0xffffffffu;

inline uint32_t lanesWhere(bool condition) {
  return __nvvm_vote_ballot_sync(all, condition);
}
inline int32_t valueOf(int32_t value, int lane) {
  return __nvvm_shfl_sync_idx_i32(all, value, lane, 31);
}
/// The lanes with the same value.
inline uint32_t lanesWith(int32_t value) {
  return __nvvm_match_any_sync_i32(all, uint32_t(value));
}
/// The least number of all lanes.
inline uint32_t least(uint32_t number) {
  return rtsl_least_of_warp(nullptr, number);
}
} // namespace warp

/// The number of lanes that run this code together.
inline int lanesHere() {
  return __builtin_popcount(__nvvm_activemask());
}

/// The lanes that begin the scope of a variable of this type together end it together: those that
/// return early wait for the others. Without it a GPU lets them run ahead, and from then on the
/// warp runs the rest of the code once for each of its parts.
class Together {
public:
  Together() : lanes(__nvvm_activemask()) {}
  Together(const Together &) = delete;
  ~Together() { __nvvm_bar_warp_sync(lanes); }

private:
  const uint32_t lanes;
};

#else

constexpr uint32_t lanesOfWarp = 1;

namespace warp {
inline uint32_t lanesWhere(bool condition) {
  return condition;
}
} // namespace warp

inline int lanesHere() {
  return 1;
}

struct [[maybe_unused]] Together {};

#endif

/// Adds 1 to a counter that is shared with other lanes and threads, and returns its old value. On a
/// GPU the lanes that call together add their number at once, because additions to one place run
/// one after the other.
inline uint64_t countUp(uint64_t *counter) {
#ifdef __NVPTX__
  const uint32_t lanes = __nvvm_activemask(), before = lanes & __nvvm_read_ptx_sreg_lanemask_lt();
  uint64_t first = 0;
  if (before == 0)
    first = __atomic_fetch_add(counter, uint64_t(__builtin_popcount(lanes)), __ATOMIC_RELAXED);
  const int leader = __builtin_ctz(lanes);
  const auto low = uint32_t(__nvvm_shfl_sync_idx_i32(lanes, int32_t(first), leader, 31)),
             high = uint32_t(__nvvm_shfl_sync_idx_i32(lanes, int32_t(first >> 32), leader, 31));
  return (uint64_t(high) << 32 | low) + uint32_t(__builtin_popcount(before));
#else
  return __atomic_fetch_add(counter, uint64_t(1), __ATOMIC_RELAXED);
#endif
}

} // namespace rtsl::device
