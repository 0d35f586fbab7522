//===- Paths.cpp - a path tracer for diffuse surfaces, by hand ------------===//
//
// The estimator of the engine `path` (library/std/engines/PathTracer.rtsl) for scenes as
// examples/cornell/scene.json: diffuse surfaces and one lamp, found by a ray to a point of it and
// by chance, weighted by the power heuristic, with Russian roulette. Written as one writes a small
// path tracer on Embree, whose hits are taken as they are.
//
//===----------------------------------------------------------------------===//
#include "PathSampling.h"
#include "Program.h"

#include <memory>

using namespace handwritten;

namespace {

/// The lamp's light at a diffuse surface of reflectance 1, by a ray to a point of the lamp.
vec3 searched(const PathScene &scene, vec3 point, vec3 normal, Dice &dice) {
  const Parallelogram &lamp = *scene.lamps.front();
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
    const RTCRayHit found = findHit(scene, from, direction, depth ? scene.epsilon : 0);
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
    direction = Frame(normal).toWorld(sampleCosine(u, v));
    density = glm::dot(normal, direction) / pi;
    if (endsAtRandom(weight, depth, dice))
      return light;
  }
}

vec3 sample(const PathScene &scene, const Picture &picture, std::uint32_t x, std::uint32_t y,
            std::uint32_t index) {
  PictureSample drawn = beginSample(picture, x, y, index);
  const float aspect = float(picture.width) / float(picture.height);
  const vec3 direction = glm::normalize(scene.forward + aspect * drawn.across * scene.right +
                                        drawn.upward * scene.upward);
  return followPath(scene, scene.world.view.eye, direction, picture.maxDepth, drawn.dice);
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
