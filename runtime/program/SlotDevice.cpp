//===- SlotDevice.cpp - runtime/device for shaders that are C++ -----------===//
//
// Programs of the compiler have runtime/device linked into their code. A program that was printed
// as C++ fills a table of slots instead (rtsl/shader/Describe.h); this is the device code that
// calls through the table of the current program, so that one process may contain several.
//
//===----------------------------------------------------------------------===//
#include "runtime/program/ProgramHost.h"

#define RTSL_DEVICE_OF_SLOTS
#include "runtime/device/engines/Device.cpp"
#include "runtime/device/engines/Machine.cpp"
#include "runtime/device/engines/Programs.cpp"

namespace {

/// The slots of the launch's program.
const rtsl::runtime::Program::Slots &slotsOf(const RtslLaunch *launch) {
  return static_cast<const rtsl::runtime::ProgramHost *>(launch->host)->slots;
}
const rtsl::runtime::Program::Slots &slotsOf(const RtslState *state) {
  return slotsOf(state->launch);
}

/// The header of the frame of a called method.
struct CallHeader {
  int32_t resume; // the state in which the caller continues
  RtslRef object; // the caller's
  uint32_t below; // bytes from the beginning of the caller's frame
};
static_assert(offsetof(CallHeader, resume) == RTSL_CALL_RESUME &&
              offsetof(CallHeader, object) == RTSL_CALL_OBJECT &&
              offsetof(CallHeader, below) == RTSL_CALL_BELOW &&
              sizeof(CallHeader) <= RTSL_CALL_HEADER);

/// Bytes of all frames of a level. Recursive calls follow a chain of references, so each method may
/// have one frame for each object of the longest chain.
uint64_t frameBytes(const RtslLaunch *launch) {
  const auto &states = slotsOf(launch).states;
  const uint64_t own = (uint64_t(states.frameSize) + 7) / 8 * 8;
  return own +
         (uint64_t(launch->referenceChain) + 1) * states.calledMethods * states.calledFrameSize;
}

} // namespace

#define RTSL_SLOT(base, method)                                                                    \
  void rtsl_##base##_##method(RtslState *state, RtslRef object) {                                  \
    if (auto *code = slotsOf(state).base##_##method)                                               \
      code(state, object);                                                                         \
  }
#define RTSL_PAYLOAD_SLOT(base, method)                                                            \
  void rtsl_##base##_##method##_payload(RtslState *state, RtslRef object) {                        \
    if (auto *code = slotsOf(state).base##_##method##_payload)                                     \
      code(state, object);                                                                         \
  }
#define RTSL_SAMPLING_SLOT(base, method) RTSL_SLOT(base, method)
extern "C" {
#include "language/PayloadSlots.def"
#include "language/SamplingSlots.def"
#include "language/Slots.def"

uint32_t rtsl_features(RtslState *state) {
  return state->launch && state->launch->host
             ? slotsOf(state).features
             : 0; // while a scene is built there is no host, and for methods called alone no launch
}

uint32_t rtsl_light_passes(const RtslLaunch *launch) {
  if (!launch->host) // while a scene is built
    return 0;
  const auto &slots = slotsOf(launch);
  return slots.rt_Material_transmittance || slots.rt_Material_diffuseTransmittance;
}

int32_t rtsl_run_state(RtslState *state, int32_t number, RtslRef object, void *frame) {
  return slotsOf(state).states.run(state, number, object, frame);
}
int32_t rtsl_first_state(RtslState *, int32_t number, RtslRef) {
  return number;
}
int32_t rtsl_frame_size(RtslState *state, int32_t) {
  return int32_t(frameBytes(state->launch));
}
int32_t rtsl_calls(RtslState *state) {
  return slotsOf(state).states.calledMethods != 0;
}
void *rtsl_call(RtslState *state, const void *end, int32_t resume, RtslRef object) {
  const device::CurrentRay &ray = device::currentRay(state);
  char *frame = static_cast<char *>(device::frameOf(ray));
  const uint64_t size = end ? uint64_t(static_cast<const char *>(end) - frame) : 0;
  const auto below = uint32_t((size + 7) / 8 * 8); // it may contain addresses
  new (frame + below) CallHeader{resume, ray.object, below};
  rtsl_move_frame(state, int32_t(below), object);
  return frame + below + RTSL_CALL_HEADER;
}
int32_t rtsl_return(RtslState *state) {
  const CallHeader call = *static_cast<CallHeader *>(device::frameOf(device::currentRay(state)));
  rtsl_move_frame(state, -int32_t(call.below), call.object);
  return -call.resume;
}
int32_t rtsl_rt_Material_shade_first(RtslState *state) {
  return slotsOf(state).states.shadeFirst;
}
int32_t rtsl_rt_Miss_miss_first(RtslState *state) {
  return slotsOf(state).states.missFirst;
}
// A shader in C++ may send any rays: there is one kind of ray, which sends its own kind.
int32_t rtsl_ray_kinds(RtslState *) {
  return 1;
}
int32_t rtsl_rays_sent(RtslState *, int32_t) {
  return 1;
}
int32_t rtsl_rays_sent_last(RtslState *, int32_t) {
  return 1;
}
// And it may read all of its ray's state after they return.
int32_t rtsl_rays_kept(RtslState *, int32_t part) {
  return part == device::keptRayKinds ? 3 : -1;
}
int32_t rtsl_rays_wait_once(RtslState *) {
  return 0;
}
int32_t rtsl_rt_Material_closestHit_payload_first(RtslState *state) {
  return slotsOf(state).states.closestHitFirst;
}
int32_t rtsl_rt_Miss_miss_payload_first(RtslState *state) {
  return slotsOf(state).states.missWithPayloadFirst;
}
// `generate` is looked up before its ray has a state.
int32_t rtsl_rt_RayGeneration_generate_first(RtslState *state) {
  return slotsOf(state).states.generateFirst;
}

/// rtsl_sample of such a program, by calls or by the machine.
void rtsl_sample_slots(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample,
                       float *color) {
  if (!slotsOf(launch).states.run)
    return launch->rayGeneration ? rtsl_generate(launch, x, y, sample, color)
                                 : rtsl_sample(launch, x, y, sample, color);
  const uint64_t levels = uint64_t(launch->maxDepth) + (launch->rayGeneration ? 2 : 1);
  RtslState none;
  none.launch = launch;
  void *stack =
      rtsl_machine_stack(levels * device::levelSize(frameBytes(launch), device::keptWords(&none)));
  if (stack)
    device::runMachine(*launch, x, y, sample, stack, color);
  else
    device::setColor(color, rtsl_color_components(launch), 0);
}
}
