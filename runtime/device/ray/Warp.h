//===- Warp.h - lanes that run in step ------------------------------------===//
//
// On a GPU 32 lanes form a warp: they run the same code at the same time, or wait for each other.
// On a CPU each lane is a warp of its own.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <stdint.h>

namespace rtsl::device {

#ifdef __NVPTX__

namespace warp {
constexpr uint32_t all = 0xffffffffu;

inline uint32_t lanesWhere(bool condition) {
  return __nvvm_vote_ballot_sync(all, condition);
}
inline int32_t valueOf(int32_t value, int lane) {
  return __nvvm_shfl_sync_idx_i32(all, value, lane, 31);
}
} // namespace warp

/// The number of lanes that run this code together.
inline int lanesHere() {
  return __builtin_popcount(__nvvm_activemask());
}

/// The step that most lanes of the warp have; the first such one on a tie. All lanes call together.
/// `nothing`, if no lane has any other step.
inline int32_t vote(int32_t wish, int32_t nothing) {
  uint32_t voters = warp::lanesWhere(wish != nothing);
  int32_t winner = nothing;
  int votes = 0;
  while (voters) {
    int32_t candidate = warp::valueOf(wish, __builtin_ctz(voters));
    uint32_t supporters = warp::lanesWhere(wish == candidate);
    int count = __builtin_popcount(supporters);
    if (count > votes) {
      winner = candidate;
      votes = count;
    }
    voters &= ~supporters;
  }
  return winner;
}

#else

inline int lanesHere() {
  return 1;
}

inline int32_t vote(int32_t wish, int32_t) {
  return wish;
}

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
