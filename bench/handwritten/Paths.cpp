//===- Paths.cpp - a path tracer for diffuse parallelograms, by hand ------===//
//
// The estimator of the engine `path` (library/std/engines/PathTracer.rtsl) for scenes as
// examples/cornell/scene.json: diffuse parallelograms of which one is a lamp, found by a ray to a
// point of it and by chance, weighted by the power heuristic, with Russian roulette. Written as one
// writes a small path tracer on Embree: parallelograms are Embree's quads, and hits are Embree's.
//
//===----------------------------------------------------------------------===//
#include "EmbreeRays.h"
#include "Program.h"

#include "runtime/device/ray/Random.h"

#include <embree3/rtcore.h>

#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>

using namespace handwritten;

namespace {

/// Where rays begin and shadow rays end. The scene is some 500 units large, so rounding is near
/// 1e-4.
constexpr float epsilon = 1e-2f;
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float pi = 3.1415927f;
constexpr unsigned sureBounces = 3; // no path is ended at random before

struct Parallelogram {
  vec3 anchor, side1, side2, reflectance, radiance;
  vec3 normal;
  float area;

  bool isLamp() const { return radiance != vec3(0); }
};

class Scene {
public:
  explicit Scene(std::vector<Parallelogram> given) : surfaces(std::move(given)) {
    for (Parallelogram &one : surfaces) {
      const vec3 product = glm::cross(one.side1, one.side2);
      one.area = glm::length(product);
      one.normal = product / one.area;
      if (one.isLamp())
        lamp = &one;
    }
    if (!lamp)
      throw std::runtime_error("no surface shines");
    device = rtcNewDevice(nullptr);
    if (!device)
      throw std::runtime_error("Embree gives no device");
    embree = rtcNewScene(device);
    rtcSetSceneFlags(embree, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree, RTC_BUILD_QUALITY_MEDIUM);
    attach();
    rtcCommitScene(embree);
    if (RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
      throw std::runtime_error("Embree fails with error " + std::to_string(error));
  }
  ~Scene() {
    rtcReleaseScene(embree);
    rtcReleaseDevice(device);
  }
  Scene(const Scene &) = delete;
  Scene &operator=(const Scene &) = delete;

  RTCScene embree = nullptr;
  std::vector<Parallelogram> surfaces;
  const Parallelogram *lamp = nullptr;
  // The camera of examples/cornell: it looks along z, 35 degrees from edge to edge.
  vec3 eye{278, 273, -800};
  float slope = std::tan(17.5f * pi / 180);

private:
  void attach() {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    auto *vertices = static_cast<vec3 *>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), 4 * surfaces.size()));
    auto *indices = static_cast<unsigned *>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                4 * sizeof(unsigned), surfaces.size()));
    if (!vertices || !indices)
      throw std::runtime_error("Embree has no memory for the scene");
    for (const Parallelogram &one : surfaces)
      for (const vec3 &corner : {one.anchor, one.anchor + one.side1,
                                 one.anchor + one.side1 + one.side2, one.anchor + one.side2})
        *vertices++ = corner;
    for (unsigned i = 0; i < 4 * surfaces.size(); ++i)
      indices[i] = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device = nullptr;
};

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
vec3 searched(const Scene &scene, vec3 point, vec3 normal, Dice &dice) {
  const Parallelogram &lamp = *scene.lamp;
  const float u = dice.next(), v = dice.next();
  const vec3 path = lamp.anchor + u * lamp.side1 + v * lamp.side2 - point;
  const float squared = glm::dot(path, path), distance = std::sqrt(squared);
  const vec3 toLamp = path / distance;
  const float cosine = glm::dot(normal, toLamp), ofLamp = std::abs(glm::dot(lamp.normal, toLamp));
  if (cosine <= 0 || ofLamp == 0 ||
      isOccluded(scene.embree, embreeRay(point, toLamp, epsilon, distance - epsilon)))
    return vec3(0);
  const float density = squared / (ofLamp * lamp.area);
  return lamp.radiance * (cosine / pi / density * share(density, cosine / pi));
}

vec3 followPath(const Scene &scene, vec3 from, vec3 direction, unsigned maxDepth, Dice &dice) {
  vec3 light(0), weight(1);
  float density = 0; // of the direction; 0: of the camera's ray
  for (unsigned depth = 0;; ++depth) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit found;
    found.ray = embreeRay(from, direction, depth ? epsilon : 0, infinity);
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene.embree, &context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID)
      return light;
    const Parallelogram &surface = scene.surfaces[found.hit.primID];
    const float slant = glm::dot(surface.normal, direction);
    if (surface.isLamp()) {
      const float t = found.ray.tfar, other = t * t / (std::abs(slant) * surface.area);
      return light + weight * surface.radiance * (density > 0 ? share(density, other) : 1.0f);
    }
    if (depth == maxDepth)
      return light;
    const vec3 point = from + found.ray.tfar * direction,
               normal = slant < 0 ? surface.normal : -surface.normal;
    weight *= surface.reflectance;
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

vec3 sample(const Scene &scene, const Picture &picture, std::uint32_t x, std::uint32_t y,
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
      glm::normalize(vec3(-scene.slope * aspect * across, scene.slope * upward, 1));
  Dice dice(words.x, words.y);
  return followPath(scene, scene.eye, direction, picture.maxDepth, dice);
}

/// One parallelogram a line: an anchor, two sides, reflectance and radiance.
std::vector<Parallelogram> readSurfaces(const std::vector<std::string> &files) {
  std::vector<Parallelogram> surfaces;
  for (const std::string &file : files) {
    std::ifstream stream(file);
    for (float numbers[15]; stream >> numbers[0];) {
      for (int i = 1; i < 15; ++i)
        stream >> numbers[i];
      if (!stream)
        throw std::runtime_error(file + " ends within a parallelogram");
      const auto at = [&](int i) { return vec3(numbers[i], numbers[i + 1], numbers[i + 2]); };
      surfaces.push_back({at(0), at(3), at(6), at(9), at(12), vec3(0), 0});
    }
  }
  return surfaces;
}

} // namespace

int main(int argc, char **argv) {
  const Description description = {"bench-paths", "traces paths between diffuse parallelograms",
                                   "the parallelograms", HANDWRITTEN_FLAGS};
  return runProgram(
      description, argc, argv, readSurfaces,
      [](std::vector<Parallelogram> surfaces) {
        return std::make_unique<Scene>(std::move(surfaces));
      },
      sample);
}
