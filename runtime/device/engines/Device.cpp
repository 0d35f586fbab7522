//===- Device.cpp - the runtime that is linked into shader code -----------===//
//
// Freestanding, without exceptions. Compiled to bitcode and linked into compiled programs, where it
// is inlined; also compiled by the host's compiler for programs whose shaders are C++. The slots
// and rtsl_traverse are defined elsewhere.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/engines/Classic.h"
#include "runtime/device/engines/LaunchFacts.cpp"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/HitError.h"
#include "runtime/device/traverse/Selector.h"

using namespace rtsl;

extern "C" {

uint32_t rtsl_hit(RtslState *state, float t) {
  return device::reportHitWithin(*state, t, device::errorNotStated);
}

uint32_t rtsl_hit_within(RtslState *state, float t, float error) {
  return device::reportHitWithin(*state, t, error);
}

void rtsl_trace(RtslState *parent, float ox, float oy, float oz, float dx, float dy, float dz,
                float *color) {
  device::trace(*parent, {ox, oy, oz}, {dx, dy, dz}, color);
}

uint32_t rtsl_illuminance(RtslState *state, uint32_t index, float px, float py, float pz, float nx,
                          float ny, float nz, float cosAngle) {
  return device::illuminate(*state, index, {px, py, pz}, {nx, ny, nz}, cosAngle);
}

uint32_t rtsl_illuminate_by_surface(RtslState *state, float px, float py, float pz, float nx,
                                    float ny, float nz) {
  return device::illuminateBySurface(*state, {px, py, pz}, {nx, ny, nz});
}

float rtsl_emitted_power(const RtslLaunch *launch, uint32_t instance, uint32_t part,
                         uint32_t sample, float *normal) {
  return device::emittedPower(*launch, instance, part, sample, normal);
}

#ifndef RTSL_DEVICE_OF_SLOTS // SlotDevice.cpp calls the program
/// Defaults that programs override if they define these functions.
__attribute__((weak)) void rtsl_rt_Primitive_rt_boundHitError(RtslState *, RtslRef) {}
__attribute__((weak)) void rtsl_rt_Primitive_rt_computeChanges(RtslState *, RtslRef) {}
__attribute__((weak)) void rtsl_rt_Selector_visit(RtslState *, RtslRef) {}
__attribute__((weak)) void rtsl_rt_Primitive_generateSample(RtslState *, RtslRef) {}
__attribute__((weak)) void rtsl_rt_Primitive_samplePDF(RtslState *, RtslRef) {}
__attribute__((weak)) void rtsl_rt_Material_emission(RtslState *, RtslRef) {}
__attribute__((weak)) void rtsl_rt_Miss_sampleDirection(RtslState *, RtslRef) {}
__attribute__((weak)) void rtsl_rt_Miss_directionPDF(RtslState *, RtslRef) {}
__attribute__((weak)) void rtsl_rt_Material_transmittance(RtslState *, RtslRef) {}
__attribute__((weak)) void rtsl_rt_Material_diffuseTransmittance(RtslState *, RtslRef) {}
__attribute__((weak)) uint32_t rtsl_light_passes(const RtslLaunch *) {
  return 0;
}
__attribute__((weak)) uint32_t rtsl_features(RtslState *) {
  return 0;
}
#endif

void rtsl_visit_child(RtslState *state, int32_t child) {
  device::visitChild(*state, child);
}

void rtsl_raise(RtslState *state, uint32_t exception) {
  device::raise(*state, exception);
}

uint32_t rtsl_is_abandoned(RtslState *state) {
  return device::isAbandoned(*state);
}

float rtsl_rand(RtslState *state) {
  return device::drawNumber(*state, state->dimension++);
}

float rtsl_rand_open(RtslState *state) {
  return device::drawOpenNumber(*state, state->dimension++);
}

void rtsl_sample(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample, float *color) {
  device::sample(*launch, x, y, sample, color);
}

} // extern "C"
