//===- Rays.h - trace, hit, rand, ambient, illuminance --------------------===//
#pragma once

#include "rtsl/shader/Elementary.h"
#include "rtsl/shader/Geometry.h"
#include "rtsl/shader/State.h"

namespace rtsl {
inline namespace RTSL_VARIANT {

/// The color that arrives at `origin` from `direction`.
template <int N>
inline Color<N> trace(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction) {
  float arrived[RTSL_MAX_COLOR];
  rtsl_trace(rawState(rt), origin.x, origin.y, origin.z, direction.x, direction.y, direction.z,
             arrived);
  Color<N> color;
  std::copy_n(arrived, N, color.components);
  return color;
}

//===----------------------------------------------------------------------===//
// Methods that were split at their traces (docs/continuations.md)
//===----------------------------------------------------------------------===//

/// The next step after a state: `done`, or the number of the state to run after the ray, or that
/// there is none.
using Next = std::int32_t;
inline constexpr Next done = 0;

/// Prepares the ray that is traced when the state ends.
template <int N, typename Step>
inline Next traceThen(State<N> &rt, Step step, const glm::vec3 &origin,
                      const glm::vec3 &direction) {
  rtsl_spawn(rawState(rt), origin.x, origin.y, origin.z, direction.x, direction.y, direction.z);
  return static_cast<Next>(step);
}

/// Continues with another state, without a ray.
template <typename Step>
constexpr Next goOn(Step step) {
  return -static_cast<Next>(step);
}

/// Prepares a tail trace: the ray replaces the one that sends it, and its result is SampleColor.
template <int N>
inline Next traceLast(State<N> &rt, const glm::vec3 &origin, const glm::vec3 &direction) {
  rtsl_spawn_last(rawState(rt), origin.x, origin.y, origin.z, direction.x, direction.y,
                  direction.z);
  return RTSL_NEXT_LAST;
}

/// The color that the ray has returned.
template <int N>
inline Color<N> traced(State<N> &rt) {
  Color<N> color;
  std::copy_n(rtsl_trace_result(rawState(rt)), N, color.components);
  return color;
}

/// The frame of a method, which holds its values while its rays are traced.
template <typename Frame>
inline Frame &frameAt(void *memory) {
  static_assert(alignof(Frame) <= 8 && std::is_trivially_copyable_v<Frame>);
  return *static_cast<Frame *>(memory);
}

/// Reports a hit at distance `t`; true if it is the primitive's nearest so far.
template <int N>
inline bool hit(State<N> &rt, float t) {
  return rtsl_hit(rawState(rt), t) != 0;
}
/// The same where `error` bounds the error of t.
template <int N>
inline bool hit(State<N> &rt, float t, float error) {
  return rtsl_hit_within(rawState(rt), t, error) != 0;
}
/// Both for a primitive with scratch members.
template <int N, typename... Error>
inline bool hit(State<N> &rt, Scratch &scratch, float t, Error... error) {
  const bool isNearest = rtsl::hit(rt, t, error...);
  scratch.accepted = scratch.accepted || isNearest;
  return isNearest;
}

/// In `visit` of a selector: the ray may enter the child of this number.
template <int N>
inline void visitChild(State<N> &rt, int child) {
  rtsl_visit_child(rawState(rt), child);
}

/// A direction or a difference of points.
inline glm::vec3 transformVector(const glm::mat4 &m, const glm::vec3 &v) {
  return (glm::vec3(m[0]) * v.x + glm::vec3(m[1]) * v.y) + glm::vec3(m[2]) * v.z;
}
/// A normal, by the matrix of the other direction.
inline glm::vec3 transformNormal(const glm::mat4 &m, const glm::vec3 &n) {
  return {rtsl::dot(n, glm::vec3(m[0])), rtsl::dot(n, glm::vec3(m[1])),
          rtsl::dot(n, glm::vec3(m[2]))};
}

/// Points, vectors and normals between the object space of what is hit and world space.
template <int N>
inline glm::vec3 pointToWorld(const State<N> &rt, const glm::vec3 &p) {
  return transformVector(rt.ObjectToWorld, p) + glm::vec3(rt.ObjectToWorld[3]);
}
template <int N>
inline glm::vec3 pointToObject(const State<N> &rt, const glm::vec3 &p) {
  return transformVector(rt.WorldToObject, p - glm::vec3(rt.ObjectToWorld[3]));
}
template <int N>
inline glm::vec3 vectorToWorld(const State<N> &rt, const glm::vec3 &v) {
  return transformVector(rt.ObjectToWorld, v);
}
template <int N>
inline glm::vec3 vectorToObject(const State<N> &rt, const glm::vec3 &v) {
  return transformVector(rt.WorldToObject, v);
}
template <int N>
inline glm::vec3 normalToWorld(const State<N> &rt, const glm::vec3 &n) {
  return transformNormal(rt.WorldToObject, n);
}
template <int N>
inline glm::vec3 normalToObject(const State<N> &rt, const glm::vec3 &n) {
  return transformNormal(rt.ObjectToWorld, n);
}

/// Uniform in [0, 1).
template <int N>
inline float rand(State<N> &rt) {
  return rtsl_rand(rawState(rt));
}
/// Uniform in (0, 1).
template <int N>
inline float randOpen(State<N> &rt) {
  return rtsl_rand_open(rawState(rt));
}

template <int N>
inline Color<N> ambient(const State<N> &rt) {
  Color<N> color;
  for (int i = 0; i < N; ++i)
    color.components[i] = rt.launch->ambient[i];
  return color;
}

template <int N>
inline int lightCount(const State<N> &rt) {
  return static_cast<int>(rt.launch->lightCount);
}

template <int N>
inline bool lightMayPass(const State<N> &rt) {
  return rtsl_light_passes(rt.launch) != 0;
}

/// The cosine of an angle of `illuminance`, which is in [0, pi]; for larger angles every light
/// counts.
inline float cosOfAngle(float angle) {
  return rtsl::cos(rtsl::clamp(angle, 0.0f, static_cast<float>(3.14159265358979323846)));
}

/// Lights a point with one light: sets LightDirection, LightDistance and LightColor; false if
/// nothing arrives. Only lights within the angle of the normal count; no cosine (-2): all do.
template <int N>
inline bool illuminate(State<N> &rt, int index, const glm::vec3 &point, const glm::vec3 &normal,
                       float cosAngle) {
  return rtsl_illuminance(rawState(rt), static_cast<std::uint32_t>(index), point.x, point.y,
                          point.z, normal.x, normal.y, normal.z, cosAngle) != 0;
}

/// The same, with or without a test for shadows.
template <int N>
inline bool illuminate(State<N> &rt, int index, const glm::vec3 &point, bool shadows = true) {
  return illuminate(rt, index, point, point, shadows ? -2.0f : static_cast<float>(RTSL_NO_SHADOWS));
}

/// The same by a light on this side: within a right angle of it.
template <int N>
inline bool illuminate(State<N> &rt, int index, const glm::vec3 &point, const glm::vec3 &side) {
  return illuminate(rt, index, point, side, 0.0f);
}

/// Lights a point by one of the surfaces that shine; sets PDF too. No light comes from behind the
/// plane of `side`, if that is not 0.
template <int N>
inline bool illuminate(State<N> &rt, const glm::vec3 &point,
                       const glm::vec3 &side = glm::vec3(0.0f)) {
  return rtsl_illuminate_by_surface(rawState(rt), point.x, point.y, point.z, side.x, side.y,
                                    side.z) != 0;
}

/// The lights that reach a point, one after the other:
///
///     for (rtsl::Lights lights(rt, point, normal, angle); lights.next();)
template <int N>
class Lights {
public:
  Lights(State<N> &rt, const glm::vec3 &point) : Lights(rt, point, glm::vec3(0.0f), 0.0f, -2.0f) {}
  /// Those within `angle` (radians) of the normal.
  Lights(State<N> &rt, const glm::vec3 &point, const glm::vec3 &normal, float angle)
      : Lights(rt, point, normal, angle, cosOfAngle(angle)) {}
  /// For an angle whose cosine was known when the code was generated.
  Lights(State<N> &rt, const glm::vec3 &point, const glm::vec3 &normal, float /*angle*/,
         float cosine)
      : rt(rt), point(point), normal(normal), cosAngle(cosine), count(lightCount(rt)) {
    keepInMemory(this->point);
    keepInMemory(this->normal);
  }

  /// Sets LightDirection, LightDistance and LightColor to those of the next light that reaches the
  /// point; false if there is none.
  bool next() {
    while (index < count)
      if (illuminate(rt, index++, point, normal, cosAngle))
        return true;
    return false;
  }
  /// Which of the scene's lights it is.
  int number() const { return index - 1; }

private:
  State<N> &rt;
  glm::vec3 point, normal;
  float cosAngle; // -2 is no cosine: every light
  int index = 0, count;
};

} // namespace RTSL_VARIANT
} // namespace rtsl
