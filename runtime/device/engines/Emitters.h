//===- Emitters.h - surfaces that emit light, as lights -------------------===//
//
// `illuminate(P)` chooses the background (Background.h), or one of the launch's emitters: with the
// probability that the table gives, or, where there are many, by a light tree (LightTree.h). Then
// it chooses a point on it: on a mesh uniformly by area, on a primitive by its `generateSample`; of
// an object with several primitives one of them, likewise. A ray towards the point finds what is
// visible there; the light counts only if that is the point itself, so that each direction has the
// density of one point. No ray is sent to a point on a side that the shader rules out. A ray that
// meets an emitter by chance finds the same density in rt_PDF: an engine weighs the two against one
// another (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering",
// 1995).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/engines/Background.h"
#include "runtime/device/engines/BeginRay.h"
#include "runtime/device/engines/LightTree.h"
#include "runtime/device/engines/ShadowRay.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Sampler.h"
#include "runtime/device/ray/Search.h"
#include "runtime/device/traverse/Surface.h"

namespace rtsl::device {

/// The number of the first of `count` ascending chances that exceeds `choice`, which is below 1.
template <typename ChanceOf>
uint32_t chosenOf(uint32_t count, float choice, ChanceOf chanceOf) {
  return indexInTable(count, [&](uint32_t i) { return !(chanceOf(i) > choice); });
}

/// The probability of one of them. Without a jump, because the number is random.
template <typename ChanceOf>
float probabilityOf(uint32_t number, ChanceOf chanceOf) {
  const float before = chanceOf(number - (number ? 1u : 0u));
  return chanceOf(number) - (number ? before : 0.0f);
}

inline auto chancesOfEmitters(const RtslLaunch &launch) {
  return [emitters = rtsl_emitters(&launch)](uint32_t i) { return emitters[i].chances; };
}
/// The chances of the triangles of a mesh, or of the primitives of an object with several.
inline auto chancesOfParts(const RtslLaunch &launch, const RtslEmitter &emitter) {
  return [chances = launch.partChances + emitter.firstPart](uint32_t i) { return chances[i]; };
}
/// Is an emitter a mesh?
inline bool isMesh(const RtslLaunch &launch, const RtslInstance &emitter) {
  return rtsl_emitters_have_parts(&launch) && emitter.primitive == 0;
}
/// The number of parts of an emitter; 0: it is one primitive.
inline uint32_t partsOf(const RtslLaunch &launch, const RtslInstance &instance) {
  if (!rtsl_emitters_have_parts(&launch))
    return 0;
  return instance.primitive == 0       ? launch.meshes[instance.mesh].triangleCount
         : isCounted(launch, instance) ? instance.boxCount
                                       : 0;
}

/// The vertices of a triangle of an instance in world space, at a time.
inline TriangleVertices verticesInWorld(const RtslLaunch &launch, const RtslInstance &instance,
                                        uint32_t triangle, float time) {
  TriangleVertices p = triangleVertices(launch, launch.meshes[instance.mesh], triangle, time);
  if (isTransformed(launch, instance)) {
    const TransformAt transform(launch, instance, time);
    p = {pointToWorld(transform, p.v0), pointToWorld(transform, p.v1),
         pointToWorld(transform, p.v2)};
  }
  return p;
}

/// The normal of a triangle, with twice its area as its length.
inline Vec3 doubleArea(const TriangleVertices &p) {
  return cross(p.v1 - p.v0, p.v2 - p.v0);
}

/// State of a primitive on whose surface a point is chosen; the rest is 0.
inline void clearForSample(RtslState &state, uint32_t primitive) {
  setVector(state.RayOrigin, 0, 0, 0);
  setVector(state.RayDirection, 0, 0, 0);
  setVector(state.InverseRayDirection, 0, 0, 0);
  state.Epsilon = state.HitDistance = 0;
  setVector(state.HitPoint, 0, 0, 0);
  setVector(state.BoundMin, 0, 0, 0);
  setVector(state.BoundMax, 0, 0, 0);
  setVector(state.GeometricNormal, 0, 0, 0);
  setVector(state.ShadingNormal, 0, 0, 0);
  setVector(state.dPdu, 0, 0, 0);
  setVector(state.dPdv, 0, 0, 0);
  state.TextureUV[0] = state.TextureUV[1] = 0;
  setVector(state.TextureUVW, 0, 0, 0);
  state.dsdu = state.dsdv = state.dtdu = state.dtdv = 0;
  state.PDF = 0;
  for (int i = 0; i < 16; ++i)
    state.ObjectToWorld[i] = state.WorldToObject[i] = 0;
  state.PrimitiveIndex = int32_t(primitive);
  state.InstanceIndex = 0;
  state.InstanceId = 0;
}

/// How many times larger an area is in world space than in object space, where the surface has this
/// normal in world space: |det M| / |M^T n| for p -> M p.
inline float areaScale(const RtslTransform &transform, Vec3 worldNormal) {
  const float *m = transform.linear;
  const Vec3 c0 = load(m), c1 = load(m + 3), c2 = load(m + 6);
  const Vec3 unit = normalized(worldNormal);
  const Vec3 back = {dot(c0, unit), dot(c1, unit), dot(c2, unit)};
  return absolute(dot(c0, cross(c1, c2))) / squareRoot(dot(back, back));
}

/// Does the program choose emitters by a light tree?
inline bool hasLightTree(const RtslLaunch &launch) {
  return (rtsl_needs(&launch) & RTSL_HAS_LIGHT_TREE) != 0 && launch.lightNodes;
}

/// The probability with which `illuminate` at `point` chooses this part of an emitter; of one that
/// is a single primitive: it.
inline float chanceOfPart(const RtslLaunch &launch, uint32_t number, uint32_t part, Vec3 point) {
  const RtslEmitter &emitter = rtsl_emitters(&launch)[number];
  float chance;
  if (hasLightTree(launch)) {
    const uint32_t leaf = launch.lightLeaves[emitter.firstLeaf + (emitter.isDivided ? part : 0)];
    chance = leaf == RTSL_NO_LIGHT_LEAF ? 0 : chanceOfLeaf(launch.lightNodes, leaf, point);
    if (emitter.isDivided)
      return chance;
  } else {
    chance = probabilityOf(number, chancesOfEmitters(launch));
  }
  if (partsOf(launch, instanceAt(launch, emitter.instance)) == 0)
    return chance;
  return chance * probabilityOf(part, chancesOfParts(launch, emitter));
}

/// The density with which `illuminate` at the ray's origin chooses the direction of this ray, by
/// solid angle, because of the point that it has hit, which is on this emitter. Of a ray that went
/// straight on through surfaces, at the origin that it had before.
inline float densityOfEmitter(const RtslState &hit, uint32_t emitter) {
  const RtslLaunch &launch = *hit.launch;
  const RtslInstance &instance = instanceAt(launch, hit.instance);
  const Vec3 direction = load(hit.RayDirection), normal = load(hit.GeometricNormal);
  const float passed = hasPassedDistance(launch) ? hit.passedDistance : 0;
  Vec3 origin = load(hit.RayOrigin);
  if (passed != 0)
    origin = origin - direction * passed;
  float density =
      (1 - backgroundChance(launch)) * chanceOfPart(launch, emitter, hit.primitive, origin);
  if (isMesh(launch, instance)) {
    const Vec3 twice = doubleArea(verticesInWorld(launch, instance, hit.primitive, hit.Time));
    density *= 2 / squareRoot(dot(twice, twice));
  } else {
    RtslState state;
    beginState(state, hit.launch);
    takeFromSample(state, hit);
    state.randomKey[0] = hit.randomKey[0] ^ 0x85ebca6bu;
    state.randomKey[1] = hit.randomKey[1];
    state.dimension = 0;
    state.Time = hit.Time;
    state.Depth = hit.Depth;
    clearForSample(state, hit.primitive);
    store(state.HitPoint, load(hit.HitPoint));
    store(state.GeometricNormal, normal);
    float scale = 1;
    if (isTransformed(launch, instance)) {
      const TransformAt atTime(launch, instance, hit.Time);
      const RtslTransform &transform = atTime;
      store(state.HitPoint, pointToObject(transform, load(hit.HitPoint)));
      const float *m = transform.linear;
      store(state.GeometricNormal,
            normalized({dot(load(m), normal), dot(load(m + 3), normal), dot(load(m + 6), normal)}));
      scale = areaScale(transform, normal);
    }
    rtsl_rt_Primitive_samplePDF(&state, instance.primitive);
    density *= state.PDF / scale;
  }
  const float along = absolute(dot(direction, normal));
  const float square = dot(direction, direction);
  const float distance = passed != 0 ? passed + hit.HitDistance : hit.HitDistance;
  // distance^2 / cosine
  density *= distance * distance * square * (squareRoot(square * dot(normal, normal)) / along);
  return isFiniteFromZero(density) ? density : 0; // edge-on, or not a number
}

/// The same for any hit; 0 if it is not on an emitter.
inline float emitterDensity(const RtslState &hit) {
  const RtslLaunch &launch = *hit.launch;
  const uint32_t count = rtsl_emitter_count(&launch);
  if (count == 0)
    return 0;
  const RtslEmitter *emitters = rtsl_emitters(&launch);
  const uint32_t emitter =
      indexInTable(count, [&](uint32_t i) { return emitters[i].instance < hit.instance; });
  return emitters[emitter].instance == hit.instance ? densityOfEmitter(hit, emitter) : 0;
}

/// Sets rt_PDF of a hit, in programs that choose points on emitters.
inline void describeEmitter(RtslState &state) {
  if (rtsl_needs(state.launch) & RTSL_NEEDS_EMITTERS)
    state.PDF = emitterDensity(state);
}

/// Numbers in [0, 1) that choose an emitter and a point on it; the last three only if emitters have
/// parts: a primitive draws its own.
struct EmitterChoice {
  float emitter, part, u, v;

  /// The rest of the first number, where the background is chosen below `ofBackground`.
  EmitterChoice ofEmitter(float ofBackground) const {
    return {ofBackground != 0 ? (emitter - ofBackground) / (1 - ofBackground) : emitter, part, u,
            v};
  }
};

/// An emitter and a part of it; of one that is a single primitive: 0.
struct ChosenPart {
  uint32_t emitter; // RTSL_NO_LIGHT_LEAF: no light reaches the point
  uint32_t part;
};

inline ChosenPart choosePart(const RtslLaunch &launch, const EmitterChoice &choice, Vec3 point,
                             const uint32_t key[2]) {
  ChosenPart chosen = {0, RTSL_WHOLE_EMITTER};
  if (hasLightTree(launch)) {
    const uint32_t leaf = chooseLeaf(launch.lightNodes, point, choice.emitter, key);
    if (leaf == RTSL_NO_LIGHT_LEAF)
      return {RTSL_NO_LIGHT_LEAF, 0};
    chosen = {launch.lightNodes[leaf].first, launch.lightNodes[leaf].part};
  } else {
    chosen.emitter =
        chosenOf(rtsl_emitter_count(&launch), choice.emitter, chancesOfEmitters(launch));
  }
  if (chosen.part != RTSL_WHOLE_EMITTER)
    return chosen;
  const RtslEmitter &emitter = rtsl_emitters(&launch)[chosen.emitter];
  const uint32_t parts = partsOf(launch, instanceAt(launch, emitter.instance));
  chosen.part = parts ? chosenOf(parts, choice.part, chancesOfParts(launch, emitter)) : 0;
  return chosen;
}

/// A point on an instance in world space, and with it GeometricNormal and PDF (by area, in object
/// space) of a primitive in `state`.
inline Vec3 pointOnInstance(RtslState &state, const RtslLaunch &launch,
                            const RtslInstance &instance, uint32_t part, float u, float v) {
  if (isMesh(launch, instance)) {
    // Uniform on the triangle (Turk, "Generating Random Points in Triangles", 1990).
    const TriangleVertices p = verticesInWorld(launch, instance, part, state.Time);
    const float root = squareRoot(u);
    return p.v0 + (p.v1 - p.v0) * (root * (1 - v)) + (p.v2 - p.v0) * (root * v);
  }
  clearForSample(state, part);
  rtsl_rt_Primitive_generateSample(&state, instance.primitive);
  const Vec3 point = load(state.HitPoint);
  return isTransformed(launch, instance)
             ? pointToWorld(TransformAt(launch, instance, state.Time), point)
             : point;
}

/// Chooses a point on an emitter and finds what is seen of it. On a GPU it is a separate function,
/// and its result a value, as that of lookAtBackground.
#ifdef __NVPTX__
__attribute__((noinline))
#endif
inline EmittedLight lookAtEmitter(ShadowRay ray, LeftHit left, Vec3 side, EmitterChoice choice) {
  const RtslLaunch &launch = *ray.launch;
  const uint32_t components = rtsl_color_components(&launch);
  EmittedLight light;
  light.density = 0;
  light.direction = {0, 0, 0};
  const ChosenPart chosen = choosePart(launch, choice, ray.origin, ray.randomKey);
  if (chosen.emitter == RTSL_NO_LIGHT_LEAF)
    return light;
  const RtslEmitter &emitter = rtsl_emitters(&launch)[chosen.emitter];
  const RtslInstance &instance = instanceAt(launch, emitter.instance);
  RtslState state;
  startShadowRay(state, ray);
  const Vec3 point = pointOnInstance(state, launch, instance, chosen.part, choice.u, choice.v);
  light.direction = point - ray.origin;
  if (isBehind(side, light.direction))
    return light;

  const RayStart start = startOf(left, ray.origin, light.direction);
  if (!(start.epsilon < hiddenBefore))
    return light;
  setRay(state, ray.origin, light.direction, start, 2 - hiddenBefore);
  // First whatever hides the point is looked for; if light may pass that, one surface after the
  // other.
  PassedSurfaces passed(components);
  for (uint32_t how = towardsPoint;; how = 0) {
    if (traverseWithDefaults(state, how) != RTSL_HIT)
      return light;
    if (!isPointHidden(state))
      break;
    if (!rtsl_light_passes(&launch) || !mayLightPass(state))
      return light;
    if (how == towardsPoint) {
      setRay(state, ray.origin, light.direction, start, 2 - hiddenBefore);
      continue;
    }
    if (!passed.add(state, components))
      return light;
    const Vec3 origin = load(state.HitPoint), direction = point - origin;
    const RayStart next = startOf(state, origin, direction);
    if (!(next.epsilon < hiddenBefore))
      return light;
    setRay(state, origin, direction, next, 2 - hiddenBefore);
  }
  if (state.instance != emitter.instance)
    return light;
  describeHitAtEnd(state, rtsl_emitters_have_parts(&launch) != 0);
  light.distance = state.HitDistance;
  if (passed.count != 0) {
    const Vec3 way = load(state.RayOrigin) - ray.origin, direction = load(state.RayDirection);
    const float square = dot(direction, direction);
    state.passedDistance = squareRoot(dot(way, way) / square);
    light.distance = (state.passedDistance + state.HitDistance) *
                     squareRoot(square / dot(light.direction, light.direction));
  }
  light.density = densityOfEmitter(state, chosen.emitter);
  if (light.density > 0)
    rtsl_rt_Material_emission(&state, instance.material);
  copyColor(light.radiance, state.EmissionColor, components);
  if (passed.count != 0)
    forEachComponent(components, [&](uint32_t i) { light.radiance[i] *= passed.share[i]; });
  return light;
}

/// What `choice` leads to, found now or before (KnownLights.h). False while lights are wanted.
RTSL_WHERE_LIGHTS_ARE_KNOWN inline bool findKnown(RtslState &state, Vec3 point, Vec3 side,
                                                  EmitterChoice choice, float ofBackground,
                                                  EmittedLight &light) {
  const ShadowRay ray = shadowRayFrom(state, point);
  LightQuestion question(LightQuestion::Surface, point, side, ray.randomKey);
  question.add(choice.emitter);
  question.add(choice.part);
  question.add(choice.u);
  question.add(choice.v);
  const auto search = [&] {
    return choice.emitter < ofBackground
               ? lookAtBackground(ray, leftHit(state), side)
               : lookAtEmitter(ray, leftHit(state), side, choice.ofEmitter(ofBackground));
  };
  const uint32_t components = rtsl_color_components(state.launch);
  return lookForLight(state, question, light, search, [&](auto &answer, auto visit) {
    forEachLightWord(answer, components, visit);
  });
}

/// `illuminate(P [, side])`. Always takes four numbers, whether it needs them or not.
inline bool illuminateBySurface(RtslState &state, Vec3 point, Vec3 side) {
  const RtslLaunch &launch = *state.launch;
  const uint32_t components = rtsl_color_components(&launch);
  setVector(state.LightDirection, 0, 0, 0);
  state.LightDistance = infinity;
  setColor(state.LightColor, components, 0);
  state.PDF = 0;
  const float ofBackground = backgroundChance(launch);
  const bool isOnly =
      ofBackground == 0 && rtsl_emitter_count(&launch) == 1 && !hasLightTree(launch);
  EmitterChoice choice;
  choice.emitter = isOnly ? 0 : drawNumber(state, state.dimension);
  choice.part = choice.u = choice.v = 0;
  if (rtsl_emitters_have_parts(&launch)) {
    choice.part = drawNumber(state, state.dimension + 1);
    choice.u = drawNumber(state, state.dimension + 2);
    choice.v = drawNumber(state, state.dimension + 3);
  }
  state.dimension += 4;
  if (ofBackground == 0 && rtsl_emitter_count(&launch) == 0)
    return false;
  EmittedLight light;
  if (mayKnowLights()) {
    if (!findKnown(state, point, side, choice, ofBackground, light))
      return false;
  } else if (choice.emitter < ofBackground) {
    light = lookAtBackground(shadowRayFrom(state, point), leftHit(state), side);
  } else {
    light = lookAtEmitter(shadowRayFrom(state, point), leftHit(state), side,
                          choice.ofEmitter(ofBackground));
  }
  const float length = squareRoot(dot(light.direction, light.direction));
  if (!(light.density > 0 && length > 0) || isBlack(light.radiance, components))
    return false;
  store(state.LightDirection, light.direction * (1 / length));
  state.LightDistance = light.distance * length;
  // The radiance of a white diffuse surface that faces the light.
  const float factor = 1 / (3.14159274f * light.density);
  forEachComponent(components,
                   [&](uint32_t i) { state.LightColor[i] = light.radiance[i] * factor; });
  state.PDF = light.density;
  return true;
}

/// rtsl_emitted_power.
inline float emittedPower(const RtslLaunch &launch, uint32_t number, uint32_t part, uint32_t sample,
                          float *worldNormal) {
  const RtslInstance &instance = instanceAt(launch, number);
  RtslState state;
  beginState(state, &launch);
  state.events = nullptr;
  const Words4 key = hash4(number, part, sample, 0x656d6974u);
  state.randomKey[0] = key.x;
  state.randomKey[1] = key.y;
  state.dimension = 0;
  for (int i = 0; i < 3; ++i) {
    state.LaunchIndex[i] = 0;
    state.LaunchSize[i] = 1;
  }
  state.Time = state.TimeSeed = 0;
  state.Depth = 0;
  state.rayType = 0;
  state.rayMask = ~0u;
  state.rayRoot = 0;
  state.coneAtOrigin = state.ConeSpread = 0;
  const float u = unitFloat(key.z), v = unitFloat(key.w);
  const Vec3 point = pointOnInstance(state, launch, instance, part, u, v);
  Vec3 normal;
  float area = 1;
  if (instance.primitive == 0) {
    normal = normalized(doubleArea(verticesInWorld(launch, instance, part, state.Time)));
    const float root = squareRoot(u);
    state.u = root * (1 - v);
    state.v = root * v;
  } else {
    normal = load(state.GeometricNormal);
    area = 1 / state.PDF;
    if (isTransformed(launch, instance)) {
      const TransformAt transform(launch, instance, state.Time);
      normal = normalToWorld(launch, transform, normal);
      area *= areaScale(transform, normal);
    }
  }
  store(worldNormal, normalized(normal));
  // Seen from either side in turn.
  const bool isBack = (sample & 1) != 0;
  if (isBack && hasNoBacks(launch, number))
    return 0;
  const Vec3 toEye = normal * (isBack ? -1.0f : 1.0f);
  const uint32_t components = rtsl_color_components(&launch);
  setDefaults(state, components);
  setRay(state, point + toEye, toEye * -1.0f, {0, 0, RTSL_NO_HIT, 0}, 1);
  state.instance = number;
  state.primitive = part;
  keepVertices(state, nullptr);
  for (uint32_t i = 0; i < RTSL_MAX_ATTRIBUTE_WORDS; ++i)
    state.attributes[i] = 0; // nothing was intersected
  describeHit(state);
  rtsl_rt_Material_emission(&state, instance.material);
  float mean = 0;
  forEachComponent(components,
                   [&](uint32_t i) { mean += state.EmissionColor[i] / float(components); });
  return mean * area;
}

} // namespace rtsl::device
