//===- Rays.h - trace, hit, rand, ambient, illuminance --------------------===//
#pragma once

#include "rtsl/shader/Elementary.h"
#include "rtsl/shader/State.h"

namespace rtsl {

/// What arrives at `origin` from `direction`.
template <int N>
inline Color<N> trace(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction) {
  float arrived[RTSL_MAX_COLOR];
  rtsl_trace(rawState(rt), origin.x, origin.y, origin.z, direction.x, direction.y, direction.z,
             arrived);
  Color<N> color;
  std::copy_n(arrived, N, color.components);
  return color;
}

/// Reports a hit at distance `t`; true if it is the nearest so far.
template <int N>
inline bool hit(State<N> &rt, float t) {
  return rtsl_hit(rawState(rt), t) != 0;
}
/// The same in a primitive with scratch members.
template <int N>
inline bool hit(State<N> &rt, Scratch &scratch, float t) {
  const bool isNearest = rtsl::hit(rt, t);
  scratch.accepted = scratch.accepted || isNearest;
  return isNearest;
}

/// Uniform in [0, 1).
template <int N>
inline float rand(State<N> &rt) {
  return rtsl_rand(rawState(rt));
}

template <int N>
inline Color<N> ambient(const State<N> &rt) {
  Color<N> color;
  std::copy_n(rt.launch->ambient, N, color.components);
  return color;
}

/// The lights that reach a point, one after the other:
///
///     for (rtsl::Lights lights(rt, point, normal, angle); lights.next();)
template <int N>
class Lights {
public:
  Lights(State<N> &rt, const glm::vec3 &point) : rt(rt), point(point) {}
  /// Those within `angle` (radians) of the normal.
  Lights(State<N> &rt, const glm::vec3 &point, const glm::vec3 &normal, float angle)
      : Lights(rt, point, normal, angle,
               rtsl::cos(rtsl::clamp(angle, 0.0f, static_cast<float>(3.14159265358979323846)))) {}
  /// For an angle whose cosine was known when the code was made.
  Lights(State<N> &rt, const glm::vec3 &point, const glm::vec3 &normal, float /*angle*/,
         float cosine)
      : rt(rt), point(point), normal(normal), cosAngle(cosine) {}

  /// Sets LightDirection, LightDistance and LightColor to those of the next light that reaches the
  /// point; false if there is none.
  bool next() {
    while (index < rt.launch->lightCount)
      if (rtsl_illuminance(rawState(rt), index++, point.x, point.y, point.z, normal.x, normal.y,
                           normal.z, cosAngle) != 0)
        return true;
    return false;
  }

private:
  State<N> &rt;
  glm::vec3 point, normal = glm::vec3(0.0f);
  float cosAngle = -2.0f; // no cosine: every light
  std::uint32_t index = 0;
};

} // namespace rtsl
