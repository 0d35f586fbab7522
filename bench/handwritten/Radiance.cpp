//===- Radiance.cpp - what one sample of one pixel sees -------------------===//
//
// The shaders of examples/glass as a C++ programmer writes them: one recursive function, a switch
// over the materials, unit directions everywhere. Random numbers are the runtime's, drawn in the
// order in which the RTSL shaders draw them, so that both pictures have the same noise.
//
//===----------------------------------------------------------------------===//
#include "Radiance.h"
#include "EmbreeRays.h"
#include "SamplePoint.h"

#include "runtime/device/ray/Random.h"

#include <cmath>

namespace handwritten {

namespace {

using rtsl::device::childKey;
using rtsl::device::randomNumber;

/// Where spawned rays begin to see. The scene is some ten units large, so rounding is near 1e-6.
constexpr float epsilon = 1e-4f;

struct Ray {
  vec3 origin, direction; // unit direction
  float start;
  std::uint32_t depth;
  std::uint32_t key[2]; // of its random numbers
};

vec3 radiance(const Scene &scene, const Picture &picture, const Ray &ray);

vec3 sky(vec3 direction) {
  const vec3 horizon(0.9f, 0.95f, 1), zenith(0.25f, 0.45f, 0.8f);
  return glm::mix(horizon, zenith, glm::smoothstep(-0.1f, 0.8f, direction.y));
}

vec3 checker(vec2 coordinates) {
  const vec3 even(0.85f, 0.83f, 0.78f), odd(0.12f, 0.14f, 0.2f);
  const vec2 cell = glm::floor(coordinates * 16.0f);
  return (int(cell.x) + int(cell.y)) & 1 ? odd : even;
}

/// Both lights on a diffuse surface at `point`, whose `normal` is unit and on the ray's side.
vec3 lambert(const Scene &scene, const Ray &ray, vec3 point, vec3 normal, vec3 albedo) {
  vec3 light = scene.ambient;
  std::uint32_t dimension = 0;
  for (const BallLight &ball : scene.lights) {
    // A point uniformly distributed on the unit sphere (Archimedes: its height is uniform).
    const float height = 2 * randomNumber(ray.key, dimension) - 1;
    const float around = 6.2831853f * randomNumber(ray.key, dimension + 1);
    dimension += 3; // RTSL counts one for the shadow ray
    const float ring = std::sqrt(std::max(1 - height * height, 0.0f));
    const vec3 source = ball.position + ball.radius * vec3(ring * std::cos(around), height,
                                                           ring * std::sin(around));
    const vec3 path = source - point;
    const float squared = glm::dot(path, path);
    const float distance = std::sqrt(squared);
    const vec3 toLight = path * (1 / distance);
    const float cosine = glm::dot(normal, toLight);
    if (cosine > 0 && !isOccluded(scene.embree(), embreeRay(point, toLight, epsilon, distance)))
      light += (cosine / squared) * ball.intensity;
  }
  return albedo * light;
}

vec3 trace(const Scene &scene, const Picture &picture, const Ray &parent, std::uint32_t dimension,
           vec3 origin, vec3 direction) {
  if (parent.depth >= picture.maxDepth)
    return vec3(0);
  Ray ray{origin, direction, epsilon, parent.depth + 1, {}};
  childKey(parent.key, dimension, ray.key);
  return radiance(scene, picture, ray);
}

/// A smooth dielectric sphere: one ray is reflected, one refracted, weighted by Schlick's
/// approximation of the Fresnel reflectance.
vec3 glass(const Scene &scene, const Picture &picture, const Ray &ray, float distance, vec3 point,
           vec3 normal) {
  constexpr float index = 1.5f;
  constexpr float root = (1 - index) / (1 + index), head = root * root;
  // Logarithms of (0.85, 0.97, 0.9), the transmittance of one unit of length.
  const vec3 absorption(-0.16251893f, -0.030459207f, -0.105360515f);

  float cosine = -glm::dot(ray.direction, normal);
  float ratio = 1 / index;
  vec3 transmittance(1);
  const bool fromInside = cosine < 0;
  if (fromInside) {
    normal = -normal;
    cosine = -cosine;
    ratio = index;
    transmittance = glm::exp(absorption * distance);
  }
  const vec3 reflected = ray.direction + (2 * cosine) * normal;
  const float squared = 1 - ratio * ratio * (1 - cosine * cosine); // of the refracted cosine
  if (squared < 0)                                                 // total internal reflection
    return transmittance * trace(scene, picture, ray, 0, point, reflected);
  const float refractedCosine = std::sqrt(squared);
  const vec3 refracted = ratio * ray.direction + (ratio * cosine - refractedCosine) * normal;

  // Schlick's formula takes the larger of the two angles, the one outside.
  const float rest = 1 - (fromInside ? refractedCosine : cosine);
  const float reflectance = head + (1 - head) * (rest * rest) * (rest * rest) * rest;
  const vec3 mirror = trace(scene, picture, ray, 0, point, reflected);
  const vec3 through = trace(scene, picture, ray, 1, point, refracted);
  return transmittance * (reflectance * mirror + (1 - reflectance) * through);
}

vec3 radiance(const Scene &scene, const Picture &picture, const Ray &ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit found;
  found.ray = embreeRay(ray.origin, ray.direction, ray.start, farthest);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene.embree(), &context, &found);

  const float distance = found.ray.tfar;
  const vec3 point = ray.origin + distance * ray.direction;
  switch (found.hit.geomID) {
  case floorGeometry: {
    // the floor is level
    const vec3 normal = ray.direction.y < 0 ? scene.floor.normal : -scene.floor.normal;
    return lambert(scene, ray, point, normal, checker({found.hit.u, found.hit.v}));
  }
  case sphereGeometry: {
    const Sphere &sphere = scene.spheres[found.hit.primID];
    const vec3 normal = (point - sphere.center) / sphere.radius;
    if (found.hit.primID == glassSphere)
      return glass(scene, picture, ray, distance, point, normal);
    return lambert(scene, ray, point, glm::dot(normal, ray.direction) < 0 ? normal : -normal,
                   {0.75f, 0.75f, 0.7f});
  }
  case knotGeometry: {
    const vec3 geometric(found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z);
    const vec3 normal =
        glm::normalize(scene.knotNormal(found.hit.primID, found.hit.u, found.hit.v));
    // The normals of the file say which side is outside, not its winding.
    const bool isFront =
        (glm::dot(geometric, ray.direction) < 0) == (glm::dot(geometric, normal) > 0);
    return lambert(scene, ray, point, isFront ? normal : -normal, {0.8f, 0.35f, 0.2f});
  }
  default:
    return sky(ray.direction);
  }
}

} // namespace

vec3 sample(const Scene &scene, const Picture &picture, std::uint32_t x, std::uint32_t y,
            std::uint32_t index) {
  const SamplePoint point = samplePoint(picture, x, y, index);
  const Camera &camera = scene.camera;
  const vec3 direction = glm::normalize(camera.corner + point.right * camera.across +
                                        (1 - point.down) * camera.upward);
  return radiance(scene, picture, {camera.eye, direction, 0, 0, {point.words.x, point.words.y}});
}

const char *compilerFlags() {
  return HANDWRITTEN_FLAGS;
}

} // namespace handwritten
