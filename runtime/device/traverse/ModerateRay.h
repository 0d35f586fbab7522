//===- ModerateRay.h - rays of any length, as authors' code sees them -----===//
//
// `intersect` computes squares of the direction, and products of those, which leave the range of a
// float if the direction is very long or very short. So while it runs for such a ray, the direction
// is multiplied by a power of two, and all distances along it are divided by that: both exact, as
// in makeTriangleRay. Other rays keep their numbers.
//
// Where nothing else of the author's reads the ray during a search, and instances have no spaces of
// their own, that is done once for the search: asked for each primitive, it takes 5 to 20 % of the
// time of a GPU, where the ray is in registers.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Hit.h"
#include "runtime/device/ray/HitError.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Instance.h"

namespace rtsl::device {

inline bool isModerate(float largestComponent) {
  return largestComponent > 0x1p-30f && largestComponent < 0x1p30f;
}

/// The power of two that makes the direction moderate.
inline float moderatingFactor(float largestComponent) {
  const int exponent = exponentOf(largestComponent);
  return powerOfTwo(-(exponent < -100 ? -100 : exponent > 100 ? 100 : exponent));
}

/// Are rays made moderate for a whole search?
inline bool scalesWholeSearch(const RtslLaunch &launch) {
  return !(rtsl_needs(&launch) & (RTSL_NEEDS_ANY_HIT | RTSL_HAS_SELECTORS)) &&
         !hasTransforms(launch);
}

/// The state's ray while its traversal searches; as it was again when it goes out of scope, with
/// the hit in its units. A ray whose numbers would be rounded stays as it is, so that nothing but
/// the factor has to be kept for the others.
class ModerateSearch {
public:
  /// `how`: of rtsl_traverse.
  ModerateSearch(RtslState &state, uint32_t how) : state(state) {
    if (!scalesWholeSearch(*state.launch) || state.isEasy)
      return;
    const float size = largest(load(state.RayDirection));
    // Towards a point, a search compares its distances with that of the point (isPointHidden).
    if (__builtin_expect(isModerate(size), 1) || (how & towardsPoint && size < 1))
      return;
    const float factor = moderatingFactor(size);
    if (!isExact(factor))
      return;
    shrink = factor;
    scale(shrink, 1 / shrink);
  }
  ModerateSearch(const ModerateSearch &) = delete;
  ~ModerateSearch() {
    if (__builtin_expect(shrink == 1, 1))
      return;
    scale(1 / shrink, shrink);
    if (state.instance == RTSL_NO_HIT)
      return;
    state.nearest *= shrink;
    if (isBound(state.hitError))
      state.hitError *= shrink;
  }

private:
  [[gnu::always_inline]] bool isExact(float factor) const {
    const Vec3 direction = load(state.RayDirection), there = direction * factor,
               back = there * (1 / factor);
    const float epsilon = state.Epsilon / factor, end = state.HitDistance / factor;
    return back.x == direction.x && back.y == direction.y && back.z == direction.z &&
           epsilon * factor == state.Epsilon && end * factor == state.HitDistance;
  }

  [[gnu::always_inline]] void scale(float direction, float distances) {
    store(state.RayDirection, load(state.RayDirection) * direction);
    if (rtsl_needs(state.launch) & RTSL_NEEDS_INVERSE_DIRECTION)
      store(state.InverseRayDirection, load(state.InverseRayDirection) * distances);
    state.Epsilon *= distances;
    state.HitDistance *= distances;
  }

  RtslState &state;
  float shrink = 1; // a power of two, which the direction is multiplied by
};

/// The state's ray, in the space of the candidate, while `intersect` of that runs; as it was again
/// when it goes out of scope, with a hit that was found meanwhile in its units.
class ModerateRay {
public:
  /// `isAsked`: false if it is known to be moderate.
  explicit ModerateRay(RtslState &state, bool isAsked = true) : state(state) {
    if (!isAsked)
      return;
    const float size = largest(load(state.RayDirection));
    if (__builtin_expect(isModerate(size), 1))
      return;
    shrink = moderatingFactor(size);
    begin();
  }
  ModerateRay(const ModerateRay &) = delete;
  /// What the direction is multiplied by.
  float factor() const { return shrink; }
  ~ModerateRay() {
    if (__builtin_expect(shrink != 1, 0))
      end();
  }

private:
  [[gnu::always_inline]] void begin() {
    direction = load(state.RayDirection);
    inverse = load(state.InverseRayDirection);
    epsilon = state.Epsilon;
    distance = state.HitDistance;
    found = state.foundDistance;
    nearest = state.nearest;
    const float grow = 1 / shrink;
    store(state.RayDirection, direction * shrink);
    if (rtsl_needs(state.launch) & RTSL_NEEDS_INVERSE_DIRECTION)
      store(state.InverseRayDirection, inverse * grow);
    state.Epsilon = epsilon * grow;
    state.HitDistance = distance * grow;
    state.candidateNear *= grow;
    state.candidateFar *= grow;
    state.nearest = nearest * grow;
    state.foundDistance = -infinity; // unless a hit wins
  }

  [[gnu::always_inline]] void end() {
    store(state.RayDirection, direction);
    if (rtsl_needs(state.launch) & RTSL_NEEDS_INVERSE_DIRECTION)
      store(state.InverseRayDirection, inverse);
    state.Epsilon = epsilon;
    state.HitDistance =
        state.HitDistance < distance / shrink ? state.HitDistance * shrink : distance;
    const bool hasWon = state.foundDistance != -infinity;
    state.foundDistance = hasWon ? state.foundDistance * shrink : found;
    state.nearest = hasWon ? state.nearest * shrink : nearest;
    if (hasWon && isBound(state.hitError))
      state.hitError *= shrink;
  }

  RtslState &state;
  float shrink = 1; // a power of two
  // Where that is not 1, the numbers before.
  Vec3 direction, inverse;
  float epsilon, distance, found, nearest;
};

} // namespace rtsl::device
