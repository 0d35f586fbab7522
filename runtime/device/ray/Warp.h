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

/// What all lanes of a warp do at the same place. Nothing may wait for some lanes, such as those
/// that began a function together: other parts of the warp run the function too, a GPU joins parts
/// that are on the same side of a branch, and of lanes that it has joined, a barrier takes from one
/// which lanes it waits for. Then some pass it too early, and others wait for them forever.
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

#endif

/// Adds 1 to a counter that is shared with other lanes and threads. On a GPU the lanes that call
/// together add their number at once, because additions to one place run one after the other.
inline void countUp(uint64_t *counter) {
#ifdef __NVPTX__
  const uint32_t lanes = __nvvm_activemask();
  if ((lanes & __nvvm_read_ptx_sreg_lanemask_lt()) == 0)
    __atomic_fetch_add(counter, uint64_t(__builtin_popcount(lanes)), __ATOMIC_RELAXED);
#else
  __atomic_fetch_add(counter, uint64_t(1), __ATOMIC_RELAXED);
#endif
}

} // namespace rtsl::device
