//===- Background.h - the background as a light ---------------------------===//
//
// A background that has `sampleDirection` and `directionPDF` is one of the emitters that
// `illuminate(P)` chooses from (Emitters.h): half of the choices are directions of the background
// if there are emitting surfaces, otherwise all of them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/ShadowRay.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Color.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Surface.h"

namespace rtsl::device {

/// There is no surface, so the only texture coordinates are those that methods of the background
/// write.
inline void clearForBackground(RtslState &state) {
  clearCoordinates(state, rtsl_needs(state.launch));
  if (rtsl_needs(state.launch) & RTSL_NEEDS_FOOTPRINT) {
    state.ConeWidth = state.coneAtOrigin;
    clearFootprint(state, rtsl_needs(state.launch));
  }
  if (rtsl_needs(state.launch) & RTSL_NEEDS_TRANSFORMS)
    describeTransforms(state, 0); // textures that it looks up may read them
}

/// The probability with which `illuminate(P)` chooses a direction of the background.
inline float backgroundChance(const RtslLaunch &launch) {
  if (!(rtsl_needs(&launch) & launch.needs & RTSL_HAS_SAMPLED_BACKGROUND))
    return 0;
  return rtsl_emitter_count(&launch) == 0 ? 1.0f : 0.5f;
}

/// The density with which `illuminate` at its origin chooses the direction of a ray that has met
/// nothing, by solid angle. Writes PDF.
inline float backgroundDensity(RtslState &state) {
  const float chance = backgroundChance(*state.launch);
  if (chance == 0)
    return 0;
  state.PDF = 0;
  rtsl_rt_Miss_directionPDF(&state, state.launch->background);
  const float density = chance * state.PDF;
  return isFiniteFromZero(density) ? density : 0;
}

/// The light that arrives from an emitter.
struct EmittedLight {
  Vec3 direction; // of any length
  float distance; // in units of it
  float density;  // of the direction, by solid angle; 0: no light arrives
  float radiance[RTSL_MAX_COLOR];
};

/// Calls visit(i, pointer to word i) for its words.
template <typename Light, typename Visit>
void forEachLightWord(Light &light, uint32_t components, Visit visit) {
  visit(0, &light.direction.x);
  visit(1, &light.direction.y);
  visit(2, &light.direction.z);
  visit(3, &light.distance);
  visit(4, &light.density);
  forEachComponent(components, [&](uint32_t i) { visit(5 + i, &light.radiance[i]); });
}

/// Is the direction behind the plane of this normal? No direction is for a normal of 0.
inline bool isBehind(Vec3 normal, Vec3 direction) {
  return dot(direction, normal) < 0;
}

/// Chooses a direction and finds whether the background is seen there. On a GPU it is a separate
/// function, and its result a value: a call that took an address would keep the ray in memory
/// (codegen/emit/rewrites/JoinCalls.h).
#ifdef __NVPTX__
__attribute__((noinline))
#endif
inline EmittedLight lookAtBackground(ShadowRay ray, LeftHit left, Vec3 side) {
  const RtslLaunch &launch = *ray.launch;
  const uint32_t components = rtsl_color_components(&launch);
  EmittedLight light;
  light.density = 0;
  light.distance = infinity;
  RtslState state;
  startShadowRay(state, ray);
  setDefaults(state, components);
  setRay(state, ray.origin, {0, 0, 0}, {0, 0, RTSL_NO_HIT, 0}, infinity);
  clearForBackground(state);
  rtsl_rt_Miss_sampleDirection(&state, launch.background);
  light.direction = load(state.RayDirection);
  const float density = backgroundChance(launch) * state.PDF;
  if (!(density > 0 && density < infinity) || isBehind(side, light.direction))
    return light;
  copyColor(light.radiance, state.SampleColor, components);
  const ArrivingLight arriving =
      followToLight(ray, light.direction, startOf(left, ray.origin, light.direction), infinity);
  if (arriving.found == RTSL_MISS || arriving.found == hitThatMayPass)
    light.density = density;
  if (arriving.found == hitThatMayPass)
    forEachComponent(components, [&](uint32_t i) { light.radiance[i] *= arriving.share[i]; });
  return light;
}

} // namespace rtsl::device
