//===- Payloads.h - rays that carry a struct, and results of anyHit -------===//
//
// The type of a payload is the type of its ray. A struct that rays carry has a member:
//
//     static constexpr rtsl::RayType rayType{1, rtsl::firstHit};
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Rays.h"

namespace rtsl {
inline namespace RTSL_VARIANT {

// How hits are searched for; 0: the nearest hit, without calling anyHit.
inline constexpr std::uint32_t firstHit = RTSL_FIRST_HIT; // no `closestHit` depends on which
inline constexpr std::uint32_t invokeAnyHit = RTSL_INVOKE_ANY_HIT; // anyHit may reject hits
inline constexpr std::uint32_t inOrder = RTSL_IN_ORDER; // anyHit is called from near to far

struct RayType {
  std::uint32_t number; // from 1
  std::uint32_t search = 0;
};

namespace detail {
/// Properties that a ray inherits from its parent unless they are given.
struct RayOptions {
  int root;
  std::uint32_t mask;
  float time;

  template <int N>
  RayOptions(State<N> &, int root, std::uint32_t mask, float time)
      : root(root), mask(mask), time(time) {}
  template <int N>
  RayOptions(State<N> &rt, int root, std::uint32_t mask) : RayOptions(rt, root, mask, rt.Time) {}
  template <int N>
  RayOptions(State<N> &rt, int root) : RayOptions(rt, root, rawState(rt)->rayMask) {}
  template <int N>
  explicit RayOptions(State<N> &rt) : RayOptions(rt, rawState(rt)->rayRoot) {}
};

/// Passes a ray to `send`, one of the three functions of the ABI that take one with a payload.
template <int N, typename Payload, typename... More>
inline void hand(decltype(rtsl_trace_payload) send, State<N> &rt, const glm::vec3 &origin,
                 const glm::vec3 &direction, float tmin, float tmax, Payload &payload,
                 More... more) {
  const RayOptions options(rt, more...);
  send(rawState(rt), origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, tmin,
       tmax, &payload, options.root, options.mask, options.time, Payload::rayType.number,
       Payload::rayType.search);
}
} // namespace detail

/// Sends a ray with a payload and waits for it. The payload may be followed by its root, mask and
/// time.
template <int N, typename Payload, typename... More>
inline void trace(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction, float tmin,
                  float tmax, Payload &payload, More... more) {
  detail::hand(rtsl_trace_payload, rt, origin, direction, tmin, tmax, payload, more...);
}

/// Prepares such a ray, which is traced when the state ends. Its payload is in the frame.
template <int N, typename Step, typename Payload, typename... More>
inline Next traceThen(State<N> &rt, Step step, const glm::vec3 &origin, const glm::vec3 &direction,
                      float tmin, float tmax, Payload &payload, More... more) {
  detail::hand(rtsl_spawn_payload, rt, origin, direction, tmin, tmax, payload, more...);
  return static_cast<Next>(step);
}
/// A tail trace: the ray replaces the one that sends it, and keeps the payload of that ray.
template <int N, typename Payload, typename... More>
inline Next traceLast(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction, float tmin,
                      float tmax, Payload &payload, More... more) {
  detail::hand(rtsl_spawn_last_payload, rt, origin, direction, tmin, tmax, payload, more...);
  return RTSL_NEXT_LAST;
}

/// Does the ray carry such a payload?
template <typename Payload>
inline bool carries(const RtslState *ray) {
  return ray->rayType == Payload::rayType.number;
}
/// The payload of the ray.
template <typename Payload>
inline Payload &payloadOf(const RtslState *ray) {
  return *static_cast<Payload *>(ray->payload);
}

//===----------------------------------------------------------------------===//
// Results of anyHit. They end it: the function that called them returns, and so do its callers.
//===----------------------------------------------------------------------===//

/// The hit does not count.
template <int N>
inline void ignoreIntersection(State<N> &rt) {
  rawState(rt)->hitAnswer = RTSL_IGNORE;
}
/// The hit counts, and the search ends.
template <int N>
inline void terminateRay(State<N> &rt) {
  rawState(rt)->hitAnswer = RTSL_TERMINATE;
}
/// Has a called function ended anyHit?
template <int N>
inline bool isAnswered(State<N> &rt) {
  return rawState(rt)->hitAnswer != RTSL_ACCEPT;
}

/// Ends `anyHit` from within an expression.
struct EndOfAnyHit {};
template <int N>
inline void endIfAnswered(State<N> &rt) {
  if (isAnswered(rt))
    throw EndOfAnyHit();
}

} // namespace RTSL_VARIANT
} // namespace rtsl
