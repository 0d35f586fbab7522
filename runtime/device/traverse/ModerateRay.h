//===- ModerateRay.h - rays of any length, as authors' code sees them -----===//
//
// `intersect` computes squares of the direction, and products of those, which leave the range of a
// float if the direction is very long or very short. So while it runs for such a ray, the direction
// is multiplied by a power of two, and all distances along it are divided by that: both exact, as
// in makeTriangleRay. Other rays keep their numbers.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/HitError.h"
#include "runtime/device/ray/Vector.h"

namespace rtsl::device {

/// The state's ray, in the space of the candidate, while `intersect` of that runs; as it was again
/// when it goes out of scope, with a hit that was found meanwhile in its units.
class ModerateRay {
public:
  explicit ModerateRay(RtslState &state) : state(state) {
    const float size = largest(load(state.RayDirection));
    if (__builtin_expect(size > 0x1p-30f && size < 0x1p30f, 1))
      return;
    const int exponent = exponentOf(size);
    shrink = powerOfTwo(-(exponent < -100 ? -100 : exponent > 100 ? 100 : exponent));
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
