//===- Scene.cpp - examples/glass as numbers and an Embree scene ----------===//
#include "Scene.h"
#include "EmbreeRays.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace handwritten {

namespace {

vec3 origin(const RTCRay &ray) {
  return {ray.org_x, ray.org_y, ray.org_z};
}
vec3 direction(const RTCRay &ray) {
  return {ray.dir_x, ray.dir_y, ray.dir_z};
}

struct FloorHit {
  float t;
  vec2 coordinates;
};

/// Where the ray meets the floor between its ends; false if it does not.
inline bool intersect(const Floor &floor, const RTCRay &ray, FloorHit &hit) {
  const float slope = glm::dot(direction(ray), floor.normal);
  hit.t = glm::dot(floor.anchor - origin(ray), floor.normal) / slope;
  if (!(hit.t > ray.tnear && hit.t < ray.tfar)) // nor for a ray within the plane: no number
    return false;
  const vec3 p = origin(ray) + hit.t * direction(ray) - floor.anchor;
  hit.coordinates = {glm::dot(floor.inverse1, p), glm::dot(floor.inverse2, p)};
  return hit.coordinates.x >= 0 && hit.coordinates.x <= 1 && hit.coordinates.y >= 0 &&
         hit.coordinates.y <= 1;
}

/// The first t between the ends of the ray, or `farthest`. Directions are unit. The discriminant is
/// taken at the point of the ray nearest to the centre (Haines et al., "Precision Improvements for
/// Ray/Sphere Intersection", Ray Tracing Gems, 2019).
inline float intersect(const Sphere &sphere, const RTCRay &ray) {
  const vec3 f = origin(ray) - sphere.center;
  const float b = -glm::dot(f, direction(ray));
  const vec3 nearest = f + b * direction(ray);
  const float squared = sphere.radius * sphere.radius;
  const float discriminant = squared - glm::dot(nearest, nearest);
  if (discriminant < 0)
    return farthest;
  const float c = glm::dot(f, f) - squared;
  const float root = std::sqrt(discriminant);
  const float q = b < 0 ? b - root : b + root;
  const float t0 = c / q;
  const float near = std::min(t0, q), far = std::max(t0, q);
  if (near > ray.tnear && near < ray.tfar)
    return near;
  return far > ray.tnear && far < ray.tfar ? far : farthest;
}

void floorBounds(const RTCBoundsFunctionArguments *arguments) {
  const Floor &floor = *static_cast<const Floor *>(arguments->geometryUserPtr);
  const vec3 far = floor.anchor + floor.side1 + floor.side2;
  const vec3 lower = glm::min(floor.anchor, far), upper = glm::max(floor.anchor, far);
  RTCBounds &bounds = *arguments->bounds_o;
  bounds.lower_x = lower.x, bounds.lower_y = lower.y, bounds.lower_z = lower.z;
  bounds.upper_x = upper.x, bounds.upper_y = upper.y, bounds.upper_z = upper.z;
}

void floorIntersect(const RTCIntersectFunctionNArguments *arguments) {
  if (!arguments->valid[0])
    return;
  RTCRayHit &rayHit = *reinterpret_cast<RTCRayHit *>(arguments->rayhit);
  FloorHit hit;
  if (!intersect(*static_cast<const Floor *>(arguments->geometryUserPtr), rayHit.ray, hit))
    return;
  rayHit.ray.tfar = hit.t;
  rayHit.hit.u = hit.coordinates.x;
  rayHit.hit.v = hit.coordinates.y;
  rayHit.hit.geomID = arguments->geomID;
  rayHit.hit.primID = arguments->primID;
}

void floorOccluded(const RTCOccludedFunctionNArguments *arguments) {
  if (!arguments->valid[0])
    return;
  RTCRay &ray = *reinterpret_cast<RTCRay *>(arguments->ray);
  FloorHit hit;
  if (intersect(*static_cast<const Floor *>(arguments->geometryUserPtr), ray, hit))
    ray.tfar = -farthest;
}

void sphereBounds(const RTCBoundsFunctionArguments *arguments) {
  const Sphere &sphere = static_cast<const Sphere *>(arguments->geometryUserPtr)[arguments->primID];
  const vec3 lower = sphere.center - sphere.radius, upper = sphere.center + sphere.radius;
  RTCBounds &bounds = *arguments->bounds_o;
  bounds.lower_x = lower.x, bounds.lower_y = lower.y, bounds.lower_z = lower.z;
  bounds.upper_x = upper.x, bounds.upper_y = upper.y, bounds.upper_z = upper.z;
}

void sphereIntersect(const RTCIntersectFunctionNArguments *arguments) {
  if (!arguments->valid[0])
    return;
  RTCRayHit &rayHit = *reinterpret_cast<RTCRayHit *>(arguments->rayhit);
  const Sphere *spheres = static_cast<const Sphere *>(arguments->geometryUserPtr);
  const float t = intersect(spheres[arguments->primID], rayHit.ray);
  if (t == farthest)
    return;
  rayHit.ray.tfar = t;
  rayHit.hit.geomID = arguments->geomID;
  rayHit.hit.primID = arguments->primID;
}

void sphereOccluded(const RTCOccludedFunctionNArguments *arguments) {
  if (!arguments->valid[0])
    return;
  RTCRay &ray = *reinterpret_cast<RTCRay *>(arguments->ray);
  const Sphere *spheres = static_cast<const Sphere *>(arguments->geometryUserPtr);
  if (intersect(spheres[arguments->primID], ray) != farthest)
    ray.tfar = -farthest;
}

} // namespace

Scene::Scene(rtsl::runtime::Mesh mesh) : knot(std::move(mesh)) {
  device = rtcNewDevice(nullptr);
  if (!device)
    throw std::runtime_error("Embree gives no device");
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  attachFloor();
  attachSpheres();
  attachKnot();
  rtcCommitScene(scene);
  if (RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree fails with error " + std::to_string(error));
}

Scene::~Scene() {
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

void Scene::attachFloor() {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, &floor);
  rtcSetGeometryBoundsFunction(geometry, floorBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, floorIntersect);
  rtcSetGeometryOccludedFunction(geometry, floorOccluded);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, floorGeometry);
  rtcReleaseGeometry(geometry);
}

void Scene::attachSpheres() {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(spheres.size()));
  rtcSetGeometryUserData(geometry, spheres.data());
  rtcSetGeometryBoundsFunction(geometry, sphereBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, sphereIntersect);
  rtcSetGeometryOccludedFunction(geometry, sphereOccluded);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, sphereGeometry);
  rtcReleaseGeometry(geometry);
}

void Scene::attachKnot() {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(vec3), knot.vertexCount());
  void *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(unsigned), knot.triangleCount());
  if (!vertices || !indices)
    throw std::runtime_error("Embree has no memory for the knot");
  std::copy(knot.positions.begin(), knot.positions.end(), static_cast<float *>(vertices));
  std::copy(knot.indices.begin(), knot.indices.end(), static_cast<unsigned *>(indices));
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, knotGeometry);
  rtcReleaseGeometry(geometry);
}

vec3 Scene::knotNormal(unsigned triangle, float u, float v) const {
  const unsigned *index = &knot.indices[3 * std::size_t(triangle)];
  auto normal = [&](unsigned vertex) {
    const float *n = &knot.normals[3 * std::size_t(vertex)];
    return vec3(n[0], n[1], n[2]);
  };
  return (1 - u - v) * normal(index[0]) + u * normal(index[1]) + v * normal(index[2]);
}

} // namespace handwritten
