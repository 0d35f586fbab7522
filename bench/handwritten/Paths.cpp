//===- Paths.cpp - a path tracer for diffuse surfaces, by hand ------------===//
//
// The estimator of the engine `path` (library/std/engines/PathTracer.rtsl) for scenes as
// examples/cornell/scene.json: diffuse surfaces and one lamp, found by a ray to a point of it and
// by chance, weighted by the power heuristic, with Russian roulette. Written as one writes a small
// path tracer on Embree, whose hits are taken as they are.
//
//===----------------------------------------------------------------------===//
#include "EmbreeRays.h"
#include "PathScene.h"
#include "Program.h"

#include "runtime/device/ray/Random.h"

#include <embree3/rtcore.h>

#include <limits>
#include <memory>

using namespace handwritten;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
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
float share(float density, float other) {
  const float ratio = other / density;
  return 1 / (1 + ratio * ratio);
}

/// A direction around the normal with density cosine / pi (Duff et al. 2017 for the frame).
vec3 sampleCosine(vec3 n, float u, float v) {
  const float side = std::copysign(1.0f, n.z), a = -1 / (side + n.z), b = n.x * n.y * a;
  const vec3 x(1 + side * n.x * n.x * a, side * b, -side * n.x), y(b, side + n.y * n.y * a, -n.y);
  const float radius = std::sqrt(u), turn = 2 * pi * v;
  return radius * std::cos(turn) * x + radius * std::sin(turn) * y +
         std::sqrt(std::max(1 - u, 1e-12f)) * n;
}

/// The lamp's light at a diffuse surface of reflectance 1, by a ray to a point of the lamp.
vec3 searched(const PathScene &scene, vec3 point, vec3 normal, Dice &dice) {
  const Parallelogram &lamp = *scene.lamp;
  const float u = dice.next(), v = dice.next();
  const vec3 path = lamp.anchor + u * lamp.side1 + v * lamp.side2 - point;
  const float squared = glm::dot(path, path), distance = std::sqrt(squared);
  const vec3 toLamp = path / distance;
  const float cosine = glm::dot(normal, toLamp), ofLamp = std::abs(glm::dot(lamp.normal, toLamp));
  if (cosine <= 0 || ofLamp == 0 ||
      isOccluded(scene.embree, embreeRay(point, toLamp, scene.epsilon, distance - scene.epsilon)))
    return vec3(0);
  const float density = squared / (ofLamp * lamp.area);
  return lamp.radiance * (cosine / pi / density * share(density, cosine / pi));
}

vec3 followPath(const PathScene &scene, vec3 from, vec3 direction, unsigned maxDepth, Dice &dice) {
  vec3 light(0), weight(1);
  float density = 0; // of the direction; 0: of the camera's ray
  for (unsigned depth = 0;; ++depth) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit found;
    found.ray = embreeRay(from, direction, depth ? scene.epsilon : 0, infinity);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene.embree, &context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID)
      return light;
    const Parallelogram *flat = scene.parallelogram(found.hit);
    const vec3 front =
        flat ? flat->normal : glm::normalize(vec3(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z));
    const float slant = glm::dot(front, direction);
    if (flat && flat->isLamp()) {
      const float t = found.ray.tfar, other = t * t / (std::abs(slant) * flat->area);
      return light + weight * flat->radiance * (density > 0 ? share(density, other) : 1.0f);
    }
    if (depth == maxDepth)
      return light;
    const vec3 point = from + found.ray.tfar * direction, normal = slant < 0 ? front : -front;
    weight *= flat ? flat->reflectance : scene.mesh(found.hit).reflectance;
    light += weight * searched(scene, point, normal, dice);
    const float u = dice.next(), v = dice.next();
    from = point;
    direction = sampleCosine(normal, u, v);
    density = glm::dot(normal, direction) / pi;
    if (depth >= sureBounces) {
      const float largest = std::max(weight.x, std::max(weight.y, weight.z));
      if (largest < 1) {
        if (dice.next() >= largest)
          return light;
        weight /= largest;
      }
    }
  }
}

vec3 sample(const PathScene &scene, const Picture &picture, std::uint32_t x, std::uint32_t y,
            std::uint32_t index) {
  using namespace rtsl::device;
  const Words4 words = hash4(x, y, index, picture.seed);
  const Words4 shift = hash4(x, y, 0xffffffffu, picture.seed); // the same for the whole pixel
  float jitterX, jitterY;
  pixelSample(index, shift.x, shift.y, &jitterX, &jitterY);
  const float aspect = float(picture.width) / float(picture.height),
              across = 2 * (float(x) + jitterX) / float(picture.width) - 1,
              upward = 1 - 2 * (float(y) + jitterY) / float(picture.height);
  const vec3 direction =
      glm::normalize(scene.forward + aspect * across * scene.right + upward * scene.upward);
  Dice dice(words.x, words.y);
  return followPath(scene, scene.world.view.eye, direction, picture.maxDepth, dice);
}

} // namespace

int main(int argc, char **argv) {
  const Description description = {"bench-paths", "traces paths between diffuse surfaces",
                                   "the scene (PathScene.h)", HANDWRITTEN_FLAGS};
  return runProgram(
      description, argc, argv,
      [](const std::vector<std::string> &files) { return readPathWorld(files[0]); },
      [](PathWorld world) { return std::make_unique<PathScene>(std::move(world)); }, sample);
}
