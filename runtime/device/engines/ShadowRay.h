//===- ShadowRay.h - rays between a point and what lights it --------------===//
#pragma once

#include "runtime/device/engines/BeginRay.h"
#include "runtime/device/engines/KnownLights.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Color.h"
#include "runtime/device/ray/Events.h"
#include "runtime/device/ray/Sampler.h"
#include "runtime/device/ray/Spawn.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Surface.h"

namespace rtsl::device {

/// What a ray to a light has of the state of the shader that is lit. It is passed by value, so that
/// that state stays in registers. What the program does not need is not set.
struct ShadowRay {
  const RtslLaunch *launch;
  RtslEvents *events;
  Vec3 origin;
  float time, timeSeed;
  uint32_t launchIndex[3], launchSize[3];
  uint32_t mask;
  int32_t root, depth;
  float coneAtOrigin, coneSpread;
  uint32_t randomKey[2];
};

inline ShadowRay shadowRayFrom(const RtslState &shading, Vec3 point) {
  ShadowRay ray;
  ray.launch = shading.launch;
  const uint32_t needs = rtsl_needs(shading.launch);
  if (hasEvents(shading))
    ray.events = shading.events;
  ray.origin = point;
  ray.time = shading.Time;
  if (needs & RTSL_NEEDS_TIME)
    ray.timeSeed = shading.TimeSeed;
  for (int i = 0; i < 3 && doRaysReadLaunch(*shading.launch); ++i) {
    ray.launchIndex[i] = shading.LaunchIndex[i];
    ray.launchSize[i] = shading.LaunchSize[i];
  }
  ray.mask = shading.rayMask;
  ray.root = shading.rayRoot;
  ray.depth = shading.Depth + 1;
  if (needs & RTSL_NEEDS_FOOTPRINT) {
    ray.coneAtOrigin = shading.ConeWidth;
    ray.coneSpread = shading.ConeSpread;
  }
  setShadowKey(ray.randomKey, shading);
  return ray;
}

/// Makes `state` that of the ray, but for its direction.
inline void startShadowRay(RtslState &state, const ShadowRay &ray) {
  beginState(state, ray.launch);
  const uint32_t needs = rtsl_needs(ray.launch);
  if (hasEvents(state))
    state.events = ray.events;
  if (needs & RTSL_NEEDS_TIME)
    state.TimeSeed = ray.timeSeed;
  state.Time = ray.time;
  for (int i = 0; i < 3 && doRaysReadLaunch(*ray.launch); ++i) {
    state.LaunchIndex[i] = ray.launchIndex[i];
    state.LaunchSize[i] = ray.launchSize[i];
  }
  for (int i = 0; i < 2; ++i)
    state.randomKey[i] = ray.randomKey[i];
  state.rayMask = ray.mask;
  state.rayRoot = ray.root;
  state.rayType = 0;
  state.Depth = ray.depth;
  if (needs & RTSL_NEEDS_FOOTPRINT) {
    state.coneAtOrigin = ray.coneAtOrigin;
    state.ConeSpread = ray.coneSpread;
  }
  state.dimension = 0;
}

/// ArrivingLight::found if the surfaces that were hit let light pass.
constexpr uint32_t hitThatMayPass = 4;
static_assert(hitThatMayPass != RTSL_MISS && hitThatMayPass != RTSL_HIT &&
              hitThatMayPass != RTSL_BAD_RAY);

/// May light pass the surface that was hit, in a program where it passes some?
inline bool mayLightPass(const RtslState &state) {
  return !(instanceAt(*state.launch, state.instance).needs & RTSL_IS_OPAQUE);
}

/// Is there anything between the ray's origin and `distance`? On a GPU it is a separate function.
#ifdef __NVPTX__
__attribute__((noinline))
#endif
inline uint32_t traverseShadow(ShadowRay ray, Vec3 direction, RayStart start, float distance) {
  RtslState state;
  startShadowRay(state, ray);
  setRay(state, ray.origin, direction, start, distance);
  return rtsl_traverse(&state, RTSL_FIRST_HIT);
}

/// At most so many surfaces let the light of one ray pass.
constexpr int mostPassed = 64;

/// Sets the state's SampleColor to the share of light that passes the surface that was hit.
inline void findTransmittance(RtslState &state, uint32_t components) {
  const RtslRef material = instanceAt(*state.launch, state.instance).material;
  rtsl_rt_Material_transmittance(&state, material);
  if (rtsl_generates(state.launch)) // what is not straight is left to the rays of `generate`
    return;
  float straight[RTSL_MAX_COLOR];
  forEachComponent(components, [&](uint32_t i) { straight[i] = state.SampleColor[i]; });
  setColor(state.SampleColor, components, 0);
  rtsl_rt_Material_diffuseTransmittance(&state, material);
  forEachComponent(components, [&](uint32_t i) { state.SampleColor[i] += straight[i]; });
}

/// The surfaces that a ray to a light has passed.
struct PassedSurfaces {
  float share[RTSL_MAX_COLOR]; // of the light, that passes them all
  int count = 0;

  explicit PassedSurfaces(uint32_t components) { setColor(share, components, 1); }

  /// Lets light pass the surface that state's ray has hit. False if none does.
  bool add(RtslState &state, uint32_t components) {
    if (++count > mostPassed)
      return false;
    describeHit(state);
    findTransmittance(state, components);
    forEachComponent(components, [&](uint32_t i) { share[i] *= state.SampleColor[i]; });
    if (rtsl_needs(state.launch) & RTSL_NEEDS_FOOTPRINT)
      state.coneAtOrigin = state.ConeWidth;
    return !isBlack(share, components);
  }
};

/// What a ray to a light has found.
struct ArrivingLight {
  uint32_t found;              // as rtsl_traverse says, or hitThatMayPass
  float share[RTSL_MAX_COLOR]; // of the light that arrives, if that is hitThatMayPass
};

/// Follows a ray to a light through surfaces that let some pass: the share that arrives is the
/// product of what their methods say. Before it looks for one surface after the other, it looks for
/// any that lets nothing pass; both in the same code, as the traversal is long. On a GPU this is a
/// separate function, and its result a value, as that of lookAtBackground.
#ifdef __NVPTX__
__attribute__((noinline))
#endif
inline ArrivingLight passSurfaces(ShadowRay ray, Vec3 direction, RayStart start, float distance) {
  const RtslLaunch &launch = *ray.launch;
  const uint32_t components = rtsl_color_components(&launch);
  ArrivingLight light;
  light.found = RTSL_MISS;
  PassedSurfaces passed(components);
  RtslState state;
  startShadowRay(state, ray);
  Vec3 origin = ray.origin;
  for (uint32_t how = RTSL_FIRST_HIT; start.epsilon < distance; how = 0) {
    setDefaults(state, components);
    setRay(state, origin, direction, start, distance);
    const uint32_t found = rtsl_traverse(&state, how);
    if (found != RTSL_HIT || !mayLightPass(state)) {
      if (found != RTSL_MISS)
        light.found = found;
      break;
    }
    light.found = hitThatMayPass;
    if (how == RTSL_FIRST_HIT)
      continue;
    if (!passed.add(state, components)) {
      light.found = RTSL_HIT;
      break;
    }
    origin = load(state.HitPoint);
    start = startOf(state, origin, direction);
    distance -= state.HitDistance;
  }
  copyColor(light.share, passed.share, components);
  return light;
}

inline ArrivingLight followToLight(const ShadowRay &ray, Vec3 direction, RayStart start,
                                   float distance) {
  if (rtsl_light_passes(ray.launch))
    return passSurfaces(ray, direction, start, distance);
  ArrivingLight light;
  light.found = traverseShadow(ray, direction, start, distance);
  return light;
}

/// light = followToLight(...), now or before (KnownLights.h). False while lights are wanted.
RTSL_WHERE_LIGHTS_ARE_KNOWN inline bool findKnown(RtslState &shading, Vec3 point, Vec3 direction,
                                                  RayStart start, float distance,
                                                  ArrivingLight &light) {
  const ShadowRay ray = shadowRayFrom(shading, point);
  LightQuestion question(LightQuestion::Light, point, direction, ray.randomKey);
  question.add(start.epsilon);
  question.add(distance);
  const uint32_t components = rtsl_color_components(shading.launch);
  return lookForLight(
      shading, question, light, [&] { return followToLight(ray, direction, start, distance); },
      [&](auto &answer, auto visit) {
        visit(0, &answer.found);
        if (answer.found == hitThatMayPass)
          forEachComponent(components, [&](uint32_t i) { visit(1 + i, &answer.share[i]); });
      });
}

/// Whether light arrives at `point` from the light that wrote LightDistance to `shading`.
/// Multiplies LightColor by what surfaces between the two let pass.
inline bool isLit(RtslState &shading, Vec3 point) {
  const Vec3 direction = load(shading.LightDirection);
  const RayStart start = startOf(shading, point, direction);
  // The light's own surface, if it has one, is at the end: stay as far from it as from the start.
  float distance = shading.LightDistance;
  if (distance < infinity)
    distance -= minimum(start.epsilon, distance * 0x1p-10f);
  if (!(start.epsilon < distance))
    return true;
  ArrivingLight light;
  if (!mayKnowLights())
    light = followToLight(shadowRayFrom(shading, point), direction, start, distance);
  else if (!findKnown(shading, point, direction, start, distance, light))
    return false;
  if (light.found == RTSL_BAD_RAY)
    raise(shading, RTSL_EXCEPTION_BAD_RAY);
  if (light.found != hitThatMayPass)
    return light.found == RTSL_MISS; // no light arrives along a bad ray
  const uint32_t components = rtsl_color_components(shading.launch);
  forEachComponent(components, [&](uint32_t i) { shading.LightColor[i] *= light.share[i]; });
  return !isBlack(shading.LightColor, components);
}

} // namespace rtsl::device
