//===- Payloads.h - rays that carry a struct, and the answers of anyHit ----===//
//
// The type of a payload is the type of its ray. A struct that rays carry says so:
//
//     static constexpr rtsl::RayType rayType{1, rtsl::firstHit};
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Rays.h"

namespace rtsl {
inline namespace RTSL_VARIANT {

// How hits are searched for; 0: the nearest counts, and nobody is asked.
inline constexpr std::uint32_t firstHit = RTSL_FIRST_HIT;    // no `closestHit` wants to know which
inline constexpr std::uint32_t askAnyHit = RTSL_ASK_ANY_HIT; // materials may refuse hits
inline constexpr std::uint32_t inOrder = RTSL_IN_ORDER;      // and are asked from near to far

struct RayType {
  std::uint32_t number; // from 1
  std::uint32_t search = 0;
};

namespace detail {
/// What a ray has of its parent unless it is given.
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

/// Hands a ray over to `send`, one of the three functions of the ABI that take one with a payload.
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

/// Sends a ray with a payload and waits for it. Behind the payload may stand its root, mask and
/// time.
template <int N, typename Payload, typename... More>
inline void trace(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction, float tmin,
                  float tmax, Payload &payload, More... more) {
  detail::hand(rtsl_trace_payload, rt, origin, direction, tmin, tmax, payload, more...);
}

/// Prepares such a ray, which is traced when the state ends. Its payload lies in the frame.
template <int N, typename Step, typename Payload, typename... More>
inline Next traceThen(State<N> &rt, Step step, const glm::vec3 &origin, const glm::vec3 &direction,
                      float tmin, float tmax, Payload &payload, More... more) {
  detail::hand(rtsl_spawn_payload, rt, origin, direction, tmin, tmax, payload, more...);
  return static_cast<Next>(step);
}
/// One that takes the place of the ray that sends it, with the payload that this was given.
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

} // namespace RTSL_VARIANT
} // namespace rtsl
