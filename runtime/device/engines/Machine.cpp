//===- Machine.cpp - the machine's functions for programs that were split -===//
//
// Separate from Device.cpp, because they refer to functions that only such programs define.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/engines/Machine.h"

using namespace rtsl;

extern "C" {

void rtsl_spawn(RtslState *parent, float ox, float oy, float oz, float dx, float dy, float dz) {
  device::CurrentRay &ray = device::currentRay(parent);
  device::send(ray, {ox, oy, oz}, {dx, dy, dz}, ray.color);
}

void rtsl_spawn_payload(RtslState *parent, float ox, float oy, float oz, float dx, float dy,
                        float dz, float tmin, float tmax, void *payload, int32_t root,
                        uint32_t mask, float time, uint32_t rayType, uint32_t how) {
  device::send(device::currentRay(parent),
               {{ox, oy, oz}, {dx, dy, dz}, tmin, tmax, payload, root, mask, time, rayType}, how);
}

void rtsl_spawn_last(RtslState *ray, float ox, float oy, float oz, float dx, float dy, float dz) {
  // If it may not be sent, the color is black.
  device::send(device::currentRay(ray), {ox, oy, oz}, {dx, dy, dz}, ray->SampleColor);
}

void rtsl_spawn_last_payload(RtslState *ray, float ox, float oy, float oz, float dx, float dy,
                             float dz, float tmin, float tmax, void *payload, int32_t root,
                             uint32_t mask, float time, uint32_t rayType, uint32_t how) {
  device::send(device::currentRay(ray),
               {{ox, oy, oz}, {dx, dy, dz}, tmin, tmax, payload, root, mask, time, rayType}, how);
}

void rtsl_move_frame(RtslState *state, int32_t bytes, RtslRef object) {
  device::CurrentRay &ray = device::currentRay(state);
  ray.frame += uint32_t(bytes);
  ray.object = object;
}

const float *rtsl_trace_result(RtslState *parent) {
  return device::currentRay(parent).color;
}

void rtsl_sample_split(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample,
                       float *color) {
  void *stack =
      rtsl_machine_stack(device::stackSize(launch, launch->maxDepth, launch->referenceChain));
  if (stack)
    device::runMachine(*launch, x, y, sample, stack, color);
  else
    device::setColor(color, rtsl_color_components(launch), 0);
}

} // extern "C"
