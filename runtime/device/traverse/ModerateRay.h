//===- ModerateRay.h - rays of any length, as authors' code sees them -----===//
//
// `intersect` computes squares of the direction, and products of those, which leave the range of a
// float if the direction is very long or very short. So while it runs for such a ray, the direction
// is multiplied by a power of two, and all distances along it are divided by that: both exact, as
// in makeTriangleRay. Other rays keep their numbers.
//
// Where instances have no spaces of their own, and no selector reads the ray, that is done once for
// the search: asked for each primitive, it takes 5 to 20 % of the time of a GPU, where the ray is
// in registers. `anyHit` then sees the ray as it was sent (AsSent).
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

/// The end of a ray, or its nearest hit so far, where the direction is multiplied by `factor` and
/// distances by its inverse. What would be beyond the largest float in the ray's own units has no
/// distance there, and counts as beyond its end.
inline float scaledEnd(float end, float factor, float inverse) {
  return (factor > 1 ? minimum(end, largestFloat) : end) * inverse;
}
/// The same back.
inline float scaledBackEnd(float end, float factor) {
  end *= factor;
  return factor > 1 && end == largestFloat ? infinity : end;
}

/// A ray that can be traced: all components finite, and a direction.
inline bool isGoodRay(Vec3 origin, Vec3 direction, float epsilon, float distance) {
  return isFinite(origin) && isFinite(direction) && !isZero(direction) && epsilon == epsilon &&
         distance == distance;
}
inline bool isGoodRay(const RtslState &state) {
  return state.isEasy || isGoodRay(load(state.RayOrigin), load(state.RayDirection), state.Epsilon,
                                   state.HitDistance);
}

/// Are rays made moderate for a whole search?
inline bool scalesWholeSearch(const RtslLaunch &launch) {
  return rtsl_has_primitives() && !(rtsl_needs(&launch) & RTSL_HAS_SELECTORS) &&
         !hasTransforms(launch);
}

/// What the direction is multiplied by for a search, 1 for a ray that stays as it is, or 0 for one
/// that cannot be traced.
__attribute__((cold, const, noinline)) inline float
searchFactor(Vec3 origin, Vec3 direction, float epsilon, float distance, bool isTowardsPoint) {
  if (!isGoodRay(origin, direction, epsilon, distance))
    return 0;
  const float size = largest(direction);
  // Towards a point, a search compares its distances with that of the point (isPointHidden).
  if (isModerate(size) || (isTowardsPoint && size < 1))
    return 1;
  const float factor = moderatingFactor(size), inverse = 1 / factor;
  const Vec3 back = direction * factor * inverse;
  const bool isExact = back.x == direction.x && back.y == direction.y && back.z == direction.z &&
                       epsilon * inverse * factor == epsilon &&
                       scaledBackEnd(scaledEnd(distance, factor, inverse), factor) == distance;
  return isExact ? factor : 1;
}

/// The state's ray while its traversal searches; as it was again when it goes out of scope, with
/// the hit in its units. A ray whose numbers would be rounded stays as it is, so that nothing but
/// the factor has to be kept for the others.
class ModerateSearch {
public:
  /// `how`: of rtsl_traverse.
  ModerateSearch(RtslState &state, uint32_t how) : state(state) {
    if (!scalesWholeSearch(*state.launch)) {
      shrink = isGoodRay(state) ? 1 : 0;
      return;
    }
    if (__builtin_expect(isOrdinary(), 1))
      return;
    shrink = searchFactor(load(state.RayOrigin), load(state.RayDirection), state.Epsilon,
                          state.HitDistance, how & towardsPoint);
    if (shrink != 1 && shrink != 0)
      begin();
  }
  ModerateSearch(const ModerateSearch &) = delete;
  ~ModerateSearch() {
    if (__builtin_expect(shrink == 1, 1) || shrink == 0)
      return;
    end();
    if (state.instance != RTSL_NO_HIT)
      state.nearest *= shrink;
  }

  /// Can the ray be traced: are all its components finite, and is there a direction?
  bool isGood() const { return shrink != 0; }

  /// While it exists, the ray is as it was sent, and HitDistance and hitError are in its units: for
  /// methods that run during a search.
  class AsSent {
  public:
    explicit AsSent(const ModerateSearch &search) : search(search) {
      if (__builtin_expect(search.shrink != 1, 0))
        search.end();
    }
    AsSent(const AsSent &) = delete;
    ~AsSent() {
      if (__builtin_expect(search.shrink != 1, 0))
        search.begin();
    }

  private:
    const ModerateSearch &search;
  };

private:
  /// Is the ray good and moderate, as nearly all are?
  [[gnu::always_inline]] bool isOrdinary() const {
    if (state.isEasy)
      return true;
    const Vec3 direction = load(state.RayDirection);
    const float size = __builtin_fabsf(direction.x) + __builtin_fabsf(direction.y) +
                       __builtin_fabsf(direction.z); // NaN if a component is
    return isModerate(size) && isFinite(load(state.RayOrigin)) && state.Epsilon == state.Epsilon &&
           state.HitDistance == state.HitDistance;
  }

  /// 1 / factor, without a division: both are powers of two within 2^-100 and 2^100.
  static float inverseOf(float factor) { return floatOf((254u << 23) - bitsOf(factor)); }

  [[gnu::always_inline]] void begin() const {
    scale(shrink, inverseOf(shrink));
    state.HitDistance = scaledEnd(state.HitDistance, shrink, inverseOf(shrink));
  }

  [[gnu::always_inline]] void end() const {
    scale(inverseOf(shrink), shrink);
    state.HitDistance = scaledBackEnd(state.HitDistance, shrink);
  }

  [[gnu::always_inline]] void scale(float direction, float distances) const {
    store(state.RayDirection, load(state.RayDirection) * direction);
    if (rtsl_needs(state.launch) & RTSL_NEEDS_INVERSE_DIRECTION)
      store(state.InverseRayDirection, load(state.InverseRayDirection) * distances);
    state.Epsilon *= distances;
    if (state.instance != RTSL_NO_HIT && isBound(state.hitError))
      state.hitError *= distances;
  }

  RtslState &state;
  float shrink = 1; // a power of two, which the direction is multiplied by; 0 for a bad ray
};

/// The state's ray, in the space of the candidate, while `intersect` of that runs; as it was again
/// when it goes out of scope, with a hit that was found meanwhile in its units.
class ModerateRay {
public:
  /// `isKnown`: to be moderate.
  explicit ModerateRay(RtslState &state, bool isKnown = false) : state(state) {
    if (isKnown || (state.isEasy && !hasTransforms(*state.launch)))
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
    state.HitDistance = scaledEnd(distance, shrink, grow);
    state.candidateNear *= grow;
    state.candidateFar *= grow;
    state.nearest = scaledEnd(nearest, shrink, grow);
    state.foundDistance = -infinity; // unless a hit wins
  }

  [[gnu::always_inline]] void end() {
    store(state.RayDirection, direction);
    if (rtsl_needs(state.launch) & RTSL_NEEDS_INVERSE_DIRECTION)
      store(state.InverseRayDirection, inverse);
    state.Epsilon = epsilon;
    const bool hasHit = state.HitDistance < scaledEnd(distance, shrink, 1 / shrink);
    state.HitDistance = hasHit ? state.HitDistance * shrink : distance;
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

/// The author's intersect(state, object) with a moderate ray. `isModerate`: it is known to be one.
template <typename Intersect>
auto withModerateRay(Intersect intersect, bool isModerate) {
  return [=](RtslState *state, RtslRef object) {
    const ModerateRay moderate(*state, isModerate);
    intersect(state, object);
  };
}

} // namespace rtsl::device
