//===- RunThisState.h - the states that the code generator copies ---------===//
#pragma once

#include "runtime/device/organisations/SlotRecords.h"

extern "C" {
/// Defined by the code generator for each copy of rtsl_wave_state and rtsl_block_state:
/// rtsl_run_state of its state.
int32_t rtsl_run_this_state(RtslState *state, RtslRef object, void *frame);
}

namespace rtsl::device {

/// The call is in the function that is copied itself, where the code generator finds it.
struct RunThisState {
  RTSL_INLINED void operator()(Rays &rays) const {
    CurrentRay &ray = rays.ray;
    endState(rays, rtsl_run_this_state(&ray.state, ray.object, frameOf(ray)));
  }
};

} // namespace rtsl::device
