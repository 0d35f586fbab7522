//===- LaunchFacts.cpp - facts of a scene, from its launch ----------------===//
//
// A compiled program defines these itself, as constants. This code serves all programs: it is part
// of Device.cpp, and of the host's code.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/ray/Abi.h"

extern "C" {

__attribute__((weak)) uint32_t rtsl_needs(const RtslLaunch *launch) {
  return launch->needs;
}
__attribute__((weak)) uint32_t rtsl_color_components(const RtslLaunch *launch) {
  return launch->colorComponents;
}
__attribute__((weak)) const RtslInstance *rtsl_instances(const RtslLaunch *launch) {
  return launch->instances;
}
__attribute__((weak)) const RtslEmitter *rtsl_emitters(const RtslLaunch *launch) {
  return launch->emitters;
}
__attribute__((weak)) uint32_t rtsl_emitter_count(const RtslLaunch *launch) {
  return launch->emitterCount;
}
__attribute__((weak)) uint32_t rtsl_emitters_have_parts(const RtslLaunch *) {
  return 1;
}
__attribute__((weak)) const RtslMeshAttribute *rtsl_mesh_attributes(const RtslLaunch *launch) {
  return launch->meshAttributes;
}
__attribute__((weak)) uint32_t rtsl_mesh_attribute_count(const RtslLaunch *launch) {
  return launch->meshAttributeCount;
}
__attribute__((weak)) uint32_t rtsl_listed_instances(const RtslLaunch *) {
  return 0;
}
__attribute__((weak)) const RtslListedBox *rtsl_listed_boxes(const RtslLaunch *) {
  return nullptr;
}
__attribute__((weak)) const RtslListedPairs *rtsl_listed_pairs(const RtslLaunch *) {
  return nullptr;
}
__attribute__((weak)) uint32_t rtsl_has_half_pairs(void) {
  return 0;
}
__attribute__((weak)) uint32_t rtsl_generates(const RtslLaunch *launch) {
  return launch->rayGeneration != 0;
}
__attribute__((weak)) uint32_t rtsl_rays_leave_hits(void) {
  return 1;
}
__attribute__((weak)) uint32_t rtsl_has_primitives(void) {
  return 1;
}
__attribute__((weak)) uint32_t rtsl_rays_leave_planes(void) {
  return 0;
}
__attribute__((weak)) uint32_t rtsl_rays_read_launch(void) {
  return 1;
}
__attribute__((weak)) uint32_t rtsl_is_fast(void) {
  return 0;
}
__attribute__((weak)) uint32_t rtsl_is_intersect_cheap(void) {
  return 0;
}
__attribute__((weak)) uint32_t rtsl_tests_all_listed(void) {
  return 0;
}
__attribute__((weak)) uint32_t rtsl_knows_lights(void) {
  return 0;
}
__attribute__((weak)) uint32_t rtsl_schedule(const RtslLaunch *) {
  return RTSL_SCHEDULE_MAJORITY;
}
__attribute__((weak)) uint32_t rtsl_states_run_on(const RtslLaunch *) {
  return 0;
}
__attribute__((weak)) uint32_t rtsl_samples_at_once(const RtslLaunch *) {
  return 32;
}
__attribute__((weak)) uint32_t rtsl_takes_pixels(const RtslLaunch *) {
  return 0;
}
__attribute__((weak)) uint32_t rtsl_counts_steps(const RtslLaunch *) {
  return 0;
}

} // extern "C"
