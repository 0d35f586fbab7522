//===- SlotDevice.cpp - runtime/device for shaders that are C++ -----------===//
//
// Programs of the compiler have runtime/device linked into their code. A program that was printed
// as C++ fills a table of slots instead (rtsl/shader/Describe.h); this is the device code that
// calls through the table of the program that is being rendered, so that one process may hold
// several.
//
//===----------------------------------------------------------------------===//
#include "runtime/HostScene.h"

#include "runtime/device/Device.cpp"
#include "runtime/device/Machine.cpp"

namespace {

/// What the slots of a ray's program are.
const rtsl::runtime::Program::Slots &slotsOf(const RtslState *state) {
  return static_cast<const rtsl::runtime::HostScene *>(state->launch->host)->programSlots();
}

} // namespace

#define RTSL_SLOT(base, method)                                                                    \
  void rtsl_##base##_##method(RtslState *state, RtslRef object) {                                  \
    if (auto *code = slotsOf(state).base##_##method)                                               \
      code(state, object);                                                                         \
  }
extern "C" {
#include "runtime/device/Slots.def"

int32_t rtsl_run_state(RtslState *state, int32_t number, RtslRef object, void *frame) {
  return slotsOf(state).states.run(state, number, object, frame);
}
int32_t rtsl_frame_size(RtslState *state) {
  return slotsOf(state).states.frameSize;
}
int32_t rtsl_rt_Material_shade_first(RtslState *state) {
  return slotsOf(state).states.shadeFirst;
}
int32_t rtsl_rt_Miss_miss_first(RtslState *state) {
  return slotsOf(state).states.missFirst;
}
// C++ has no rays with a payload, and so no `generate`.
int32_t rtsl_rt_Material_closestHit_payload_first(RtslState *) {
  return 0;
}
int32_t rtsl_rt_Miss_miss_payload_first(RtslState *) {
  return 0;
}
int32_t rtsl_rt_RayGeneration_generate_first(RtslState *) {
  return 0;
}

/// rtsl_sample of such a program, with calls or with the machine.
void rtsl_sample_slots(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample,
                       float *color) {
  if (static_cast<const rtsl::runtime::HostScene *>(launch->host)->programSlots().states.run)
    rtsl_sample_split(launch, x, y, sample, color);
  else
    rtsl_sample(launch, x, y, sample, color);
}
}
