//===- Payloads.h - rays that carry a struct, and the answers of anyHit ----===//
//
// The type of a payload is the type of its ray. A struct that rays carry says so:
//
//     static constexpr rtsl::RayType rayType{1, rtsl::firstHit};
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/State.h"

namespace rtsl {
inline namespace RTSL_ARITHMETIC {

// How hits are searched for; 0: the nearest counts, and nobody is asked.
inline constexpr std::uint32_t firstHit = RTSL_FIRST_HIT;    // no `closestHit` wants to know which
inline constexpr std::uint32_t askAnyHit = RTSL_ASK_ANY_HIT; // materials may refuse hits
inline constexpr std::uint32_t inOrder = RTSL_IN_ORDER;      // and are asked from near to far

struct RayType {
  std::uint32_t number; // from 1
  std::uint32_t search = 0;
};

/// Sends a ray with a payload and waits for it. Mask, root and time are the parent ray's unless they are given.
template <int N, typename Payload>
inline void trace(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction, float tmin, float tmax,
                  Payload &payload, int root, std::uint32_t mask, float time) {
  rtsl_trace_payload(rawState(rt), origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, tmin, tmax,
                     &payload, root, mask, time, Payload::rayType.number, Payload::rayType.search);
}
template <int N, typename Payload>
inline void trace(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction, float tmin, float tmax,
                  Payload &payload, int root, std::uint32_t mask) {
  trace(rt, origin, direction, tmin, tmax, payload, root, mask, rt.Time);
}
template <int N, typename Payload>
inline void trace(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction, float tmin, float tmax,
                  Payload &payload, int root) {
  trace(rt, origin, direction, tmin, tmax, payload, root, rawState(rt)->rayMask);
}
template <int N, typename Payload>
inline void trace(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction, float tmin, float tmax,
                  Payload &payload) {
  trace(rt, origin, direction, tmin, tmax, payload, rawState(rt)->rayRoot);
}

/// Does the ray carry such a payload?
template <typename Payload>
inline bool carries(const RtslState *ray) {
  return ray->rayType == Payload::rayType.number;
}
/// What it carries.
template <typename Payload>
inline Payload &payloadOf(const RtslState *ray) {
  return *static_cast<Payload *>(ray->payload);
}

//===----------------------------------------------------------------------===//
// Answers of anyHit. They end it: whoever called them returns, and so does who called that.
//===----------------------------------------------------------------------===//

/// The hit does not count.
template <int N>
inline void ignoreIntersection(State<N> &rt) {
  rawState(rt)->hitAnswer = RTSL_IGNORE;
}
/// The hit counts, and no other is looked for.
template <int N>
inline void terminateRay(State<N> &rt) {
  rawState(rt)->hitAnswer = RTSL_TERMINATE;
}
/// Has a function that was called answered?
template <int N>
inline bool isAnswered(State<N> &rt) {
  return rawState(rt)->hitAnswer != RTSL_ACCEPT;
}

/// What ends `anyHit` from the middle of an expression.
struct EndOfAnyHit {};
template <int N>
inline void endIfAnswered(State<N> &rt) {
  if (isAnswered(rt))
    throw EndOfAnyHit();
}

} // namespace RTSL_ARITHMETIC
} // namespace rtsl
