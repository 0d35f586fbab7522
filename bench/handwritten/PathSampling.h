//===- PathSampling.h - what path tracers by hand draw at random ----------===//
#pragma once

#include "EmbreeRays.h"
#include "PathScene.h"
#include "SamplePoint.h"

#include "runtime/device/ray/Random.h"

#include <cmath>

namespace handwritten {

constexpr float pi = 3.1415927f;
constexpr unsigned sureBounces = 3; // no path is ended at random before

/// The random numbers of a path.
class Dice {
public:
  Dice(std::uint32_t x, std::uint32_t y) : key{x, y} {}
  float next() { return rtsl::device::randomNumber(key, dimension++); }

private:
  const std::uint32_t key[2];
  std::uint32_t dimension = 0;
};

/// The power heuristic.
inline float share(float density, float other) {
  const float ratio = other / density;
  return 1 / (1 + ratio * ratio);
}

/// Orthogonal unit vectors, the last of them `z` (Duff et al. 2017).
struct Frame {
  vec3 x, y, z;

  explicit Frame(vec3 n) : z(n) {
    const float side = std::copysign(1.0f, n.z), a = -1 / (side + n.z), b = n.x * n.y * a;
    x = vec3(1 + side * n.x * n.x * a, side * b, -side * n.x);
    y = vec3(b, side + n.y * n.y * a, -n.y);
  }

  vec3 toWorld(vec3 v) const { return v.x * x + v.y * y + v.z * z; }
  vec3 fromWorld(vec3 v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
};

/// A direction around z with density cosine / pi.
inline vec3 sampleCosine(float u, float v) {
  const float radius = std::sqrt(u), turn = 2 * pi * v;
  return {radius * std::cos(turn), radius * std::sin(turn), std::sqrt(std::max(1 - u, 1e-12f))};
}

/// What a ray hits; geomID is RTC_INVALID_GEOMETRY_ID if that is nothing.
inline RTCRayHit findHit(const PathScene &scene, vec3 from, vec3 direction, float start) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit found;
  found.ray = embreeRay(from, direction, start, farthest);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene.embree, &context, &found);
  return found;
}

/// Ends a path at random that carries less than 1, and makes up for it. True: it ends.
inline bool endsAtRandom(vec3 &weight, unsigned depth, Dice &dice) {
  const float largest = std::max(weight.x, std::max(weight.y, weight.z));
  if (depth < sureBounces || largest >= 1)
    return false;
  if (dice.next() >= largest)
    return true;
  weight /= largest;
  return false;
}

/// A sample's point of the picture, across and upward in [-1, 1], and its random numbers.
struct PictureSample {
  float across, upward;
  Dice dice;
};

inline PictureSample beginSample(const Picture &picture, std::uint32_t x, std::uint32_t y,
                                 std::uint32_t index) {
  const SamplePoint point = samplePoint(picture, x, y, index);
  return {2 * point.right - 1, 1 - 2 * point.down, Dice(point.words.x, point.words.y)};
}

} // namespace handwritten
