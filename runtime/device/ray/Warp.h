//===- Warp.h - lanes that run in step ------------------------------------===//
//
// On a GPU 32 lanes make a warp: they run the same code at the same time, or wait for each other.
// On a CPU a lane is alone, and every question here has the obvious answer.
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

/// What most lanes of the warp want; the first such wish if there are several. All lanes ask
/// together. `nothing`, if no lane wants anything else.
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

inline int32_t vote(int32_t wish, int32_t) {
  return wish;
}

#endif

/// Adds to a counter that other lanes and threads count in as well, and gives what it was before.
inline uint64_t countUp(uint64_t *counter) {
  return __atomic_fetch_add(counter, uint64_t(1), __ATOMIC_RELAXED);
}

} // namespace rtsl::device
