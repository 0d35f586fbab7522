//===- State.h - the state of a ray ---------------------------------------===//
//
// A plain C layout, as those of Launch.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"

#include <stdint.h>

#define RTSL_MAX_ATTRIBUTE_WORDS 32

/// What happens in a sample, apart from its color.
typedef struct RtslEvents {
  uint32_t x, y, sample; // which sample, as rtsl_sample takes it
  uint32_t exception;    // RTSL_EXCEPTION_*: the first one
  uint32_t printed;      // how many times `print` has run
} RtslEvents;

/// The state of one ray. Parent and child ray have one each.
typedef struct RtslState {
  const RtslLaunch *launch;
  // of its sample; only programs with rtsl_features have events. Null while a scene is built
  RtslEvents *events;

  // The hit so far (committed), and what is being tested (candidate).
  uint32_t instance, primitive; // of the hit so far; RTSL_NO_HIT: none
  uint32_t candidateInstance, candidatePrimitive;
  float u, v;               // barycentrics of vertices 1 and 2 of a triangle hit
  float hitPointError;      // bound of the distance of HitPoint from the surface that was hit
  float hitError;           // bound of the error of HitDistance on a primitive; below 0: not known
  uint32_t leaves;          // the instance whose surface the ray starts on; RTSL_NO_HIT: none
  uint32_t leavesPrimitive; // and which of its primitives, if objects may hold several
  uint32_t isEasy; // 1: every traversal is known to handle the ray (isEasySpawn in Spawn.h)
  // How far before RayOrigin it went straight on through surfaces that let light pass, in units of
  // RayDirection: `illuminate(P)` may have found from there what the ray finds (Emitters.h).
  float passedDistance;

  // What the ray carries (docs/language.md, "Tracing and light").
  void *payload; // the struct of the ray's type; undefined if rayType is 0
  // 0: the built-in payload of `shade`; others are numbered when a program is linked
  uint32_t rayType;
  uint32_t rayMask; // instances that have no common bit with it are invisible
  int32_t rayRoot;  // the root of the scene where it enters: RtslInstance::roots
  // RTSL_ACCEPT...: the answer of `anyHit` for the candidate; outside of it RTSL_ACCEPT
  uint32_t hitAnswer;

  // The width of the ray's cone where it starts (Footprint.h); ConeWidth is that at the hit.
  float coneAtOrigin;

  // Counter-based random numbers: (pixel, sample) form the key, `dimension` counts the draws.
  uint32_t randomKey[2];
  uint32_t dimension;

#define RTSL_TYPE_float(n) float n
#define RTSL_TYPE_int(n) int32_t n
#define RTSL_TYPE_uint3(n) uint32_t n[3]
#define RTSL_TYPE_vec2(n) float n[2]
#define RTSL_TYPE_vec3(n) float n[3]
#define RTSL_TYPE_mat4(n) float n[16]
#define RTSL_TYPE_color(n) float n[RTSL_MAX_COLOR]
#define RTSL_STATE_VARIABLE(name, type, ...) RTSL_TYPE_##type(name);
#include "language/StateVariables.def"

  // What `intersect` wrote to scratch members for the hit so far; of a mesh its named attributes.
  uint32_t attributes[RTSL_MAX_ATTRIBUTE_WORDS];

  // Temporary values of a traversal (Hit.h).
  float foundDistance; // t of the hit so far
  float nearest;       // t that candidates are compared with; without a hit, the end of the ray
  float candidateNear,
      candidateFar; // range of the ray in the box of the RTSL primitive that is being tested
  uint32_t areAttributesLost; // 1: a hit that lost has overwritten those of the hit so far
  uint32_t isInOrder;         // 1: all primitives are tested in their order (InOrder.h), and
  uint32_t isStartPutOff;     // 1: one that the ray leaves has a hit that may count
  int32_t wantedChild;        // while `visit` of a selector runs: which child leads on,
  uint32_t isChildVisited;    // and 1: visitChild was called with it
  // What a state of a wavefront knows of lights (KnownLights.h).
  uint32_t lightCalls;  // how many questions it has asked
  uint32_t lightPhase;  // LightPhase
  uint32_t lightStride; // from one word of its slot to the next, in words
  uint32_t *lights;     // the first word
  // Of the triangle that is the hit so far, where the traversal has read its vertices; null: not
  // known. Never read on a GPU.
  const float *vertices; // coordinate `axis` of vertex i: (3 i + axis) * RTSL_VERTEX_STRIDE
} RtslState;

#define RTSL_NO_HIT 0xffffffffu
#define RTSL_VERTEX_STRIDE 8

/// The bit of a ray type in RtslInstance::anyHit. If two types share a bit, `anyHit` may be called
/// without effect.
static inline uint32_t rtslRayTypeBit(uint32_t rayType) {
  return 1u << (rayType & 31u);
}

// RtslState::hitAnswer.
#define RTSL_ACCEPT 0u
#define RTSL_IGNORE 1u    // ignoreIntersection()
#define RTSL_TERMINATE 2u // terminateRay()
