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

/// rtsl_sample of such a program.
void rtsl_sample_slots(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample,
                       float *color) {
  rtsl_sample(launch, x, y, sample, color);
}
}
