//===- QueuePlace.h - lanes that join queues of steps ---------------------===//
#pragma once

#include "runtime/device/organisations/Schedule.h"
#include "runtime/device/ray/Warp.h"

#include <stdint.h>

namespace rtsl::device {

/// Counts the lane to those that wait for `step`, and returns how many did before. count() gives
/// the address of the number of a step. All lanes of the warp call together, and the lanes with the
/// same step add their number at once; lanes with Step::nothing wait for none.
template <typename Count>
inline uint32_t placeInQueue(int32_t step, Count count) {
#ifdef __NVPTX__
  uint32_t place = 0;
  uint32_t lanes = warp::lanesWhere(step != Step::nothing);
  while (lanes) {
    const int leader = __builtin_ctz(lanes);
    const uint32_t members = warp::lanesWhere(step == warp::valueOf(step, leader));
    uint32_t first = 0;
    if (int(__nvvm_read_ptx_sreg_laneid()) == leader)
      first = __atomic_fetch_add(count(), uint32_t(__builtin_popcount(members)), __ATOMIC_RELAXED);
    first = uint32_t(warp::valueOf(int32_t(first), leader));
    if (members >> __nvvm_read_ptx_sreg_laneid() & 1)
      place = first + uint32_t(__builtin_popcount(members & __nvvm_read_ptx_sreg_lanemask_lt()));
    lanes &= ~members;
  }
  return place;
#else
  return step == Step::nothing ? 0 : (*count())++;
#endif
}

} // namespace rtsl::device
