//===- Meshes.cpp - many meshes under two lights, by hand -----------------===//
//
// The twin of the scenes that bench/measure/meshes.py and instances.py write: diffuse meshes with
// interpolated normals, a camera ray and two shadow rays a sample. Written as one writes a small
// renderer on Embree: each mesh is a geometry of Embree's, or a scene with instances, and hits are
// Embree's.
//
//===----------------------------------------------------------------------===//
#include "EmbreeRays.h"
#include "Program.h"
#include "SamplePoint.h"
#include "Triangles.h"

#include "runtime/device/ray/Random.h"
#include "runtime/geometry/Mesh.h"

#include <embree3/rtcore.h>

#include <array>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>

using namespace handwritten;
namespace runtime = rtsl::runtime;

namespace {

/// Where shadow rays begin to see. The scene is some ten units large, so rounding is near 1e-6.
constexpr float epsilon = 1e-4f;

/// An instance of a mesh: four columns of three. The linear part is a rotation and a scale.
struct Place {
  unsigned mesh;
  std::array<float, 12> columns;

  vec3 turned(vec3 v) const {
    const float *m = columns.data();
    return v.x * vec3(m[0], m[1], m[2]) + v.y * vec3(m[3], m[4], m[5]) +
           v.z * vec3(m[6], m[7], m[8]);
  }
};

struct Meshes {
  std::vector<runtime::Mesh> meshes;
  std::vector<Place> places; // none: each mesh is where it is
};

class Scene {
public:
  explicit Scene(Meshes given) : meshes(std::move(given.meshes)), places(std::move(given.places)) {
    device = rtcNewDevice(nullptr);
    if (!device)
      throw std::runtime_error("Embree gives no device");
    embree = rtcNewScene(device);
    rtcSetSceneFlags(embree, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(embree, RTC_BUILD_QUALITY_MEDIUM);
    for (unsigned i = 0; i < meshes.size(); ++i)
      attach(i);
    for (const Place &place : places)
      attach(place);
    rtcCommitScene(embree);
    if (RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
      throw std::runtime_error("Embree fails with error " + std::to_string(error));
  }
  ~Scene() {
    rtcReleaseScene(embree);
    for (RTCScene inner : shared)
      rtcReleaseScene(inner);
    rtcReleaseDevice(device);
  }
  Scene(const Scene &) = delete;
  Scene &operator=(const Scene &) = delete;

  /// The interpolated normal at a hit; not unit.
  vec3 normal(const RTCHit &hit) const {
    const Place *place = places.empty() ? nullptr : &places[hit.instID[0]];
    const runtime::Mesh &mesh = meshes[place ? place->mesh : hit.geomID];
    const unsigned *index = &mesh.indices[3 * std::size_t(hit.primID)];
    auto at = [&](unsigned vertex) {
      const float *n = &mesh.normals[3 * std::size_t(vertex)];
      return vec3(n[0], n[1], n[2]);
    };
    const vec3 sum =
        (1 - hit.u - hit.v) * at(index[0]) + hit.u * at(index[1]) + hit.v * at(index[2]);
    return place ? place->turned(sum) : sum;
  }
  /// The normal of the triangle; not unit.
  vec3 geometricNormal(const RTCHit &hit) const {
    const vec3 normal(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    return places.empty() ? normal : places[hit.instID[0]].turned(normal);
  }

  RTCScene embree = nullptr;
  Camera camera;
  std::array<BallLight, 2> lights{{{{4, 6, 4}, 0.4f, {38, 36, 33}}, {{-5, 4, 2}, 0.4f, {6, 7, 9}}}};
  vec3 ambient{0.12f, 0.13f, 0.16f}, albedo{0.8f, 0.35f, 0.2f}, background{0.25f, 0.45f, 0.8f};

private:
  void attach(unsigned number) {
    RTCGeometry geometry = newTriangles(device, meshes[number]);
    if (places.empty()) {
      rtcAttachGeometryByID(embree, geometry, number);
    } else {
      RTCScene inner = rtcNewScene(device);
      rtcSetSceneFlags(inner, RTC_SCENE_FLAG_ROBUST);
      rtcAttachGeometry(inner, geometry);
      rtcCommitScene(inner);
      shared.push_back(inner);
    }
    rtcReleaseGeometry(geometry);
  }

  void attach(const Place &place) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, shared[place.mesh]);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, place.columns.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree, geometry); // numbered in this order
    rtcReleaseGeometry(geometry);
  }

  std::vector<runtime::Mesh> meshes;
  std::vector<Place> places;
  std::vector<RTCScene> shared;
  RTCDevice device = nullptr;
};

/// What arrives of both lights, and of the ambient one. Random numbers are drawn as BallLight.rtsl
/// of examples/glass draws them.
vec3 arriving(const Scene &scene, const std::uint32_t key[2], vec3 point, vec3 normal) {
  vec3 sum = scene.ambient;
  std::uint32_t dimension = 0;
  for (const BallLight &ball : scene.lights) {
    const float height = 2 * rtsl::device::randomNumber(key, dimension) - 1;
    const float around = 6.2831853f * rtsl::device::randomNumber(key, dimension + 1);
    dimension += 3; // RTSL counts one for the shadow ray
    const float ring = std::sqrt(std::max(1 - height * height, 0.0f));
    const vec3 source = ball.position + ball.radius * vec3(ring * std::cos(around), height,
                                                           ring * std::sin(around));
    const vec3 path = source - point;
    const float squared = glm::dot(path, path), distance = std::sqrt(squared);
    const vec3 toLight = path * (1 / distance);
    const float cosine = glm::dot(normal, toLight);
    if (cosine > 0 && !isOccluded(scene.embree, embreeRay(point, toLight, epsilon, distance)))
      sum += (cosine / squared) * ball.intensity;
  }
  return sum;
}

vec3 sample(const Scene &scene, const Picture &picture, std::uint32_t x, std::uint32_t y,
            std::uint32_t index) {
  const SamplePoint at = samplePoint(picture, x, y, index);
  const Camera &camera = scene.camera;
  const vec3 direction =
      glm::normalize(camera.corner + at.right * camera.across + (1 - at.down) * camera.upward);

  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit found;
  found.ray = embreeRay(camera.eye, direction, 0, farthest);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene.embree, &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID)
    return scene.background;
  const vec3 point = camera.eye + found.ray.tfar * direction;
  const vec3 geometric = scene.geometricNormal(found.hit);
  const vec3 normal = glm::normalize(scene.normal(found.hit));
  // The normals of the file say which side is outside, not its winding.
  const bool isFront = (glm::dot(geometric, direction) < 0) == (glm::dot(geometric, normal) > 0);
  const std::uint32_t key[2] = {at.words.x, at.words.y};
  return scene.albedo * arriving(scene, key, point, isFront ? normal : -normal);
}

} // namespace

int main(int argc, char **argv) {
  const Description description = {"bench-meshes", "renders diffuse meshes under two lights",
                                   "the meshes", HANDWRITTEN_FLAGS};
  return runProgram(
      description, argc, argv,
      [](const std::vector<std::string> &files) {
        Meshes meshes;
        for (const std::string &file : files) {
          if (file.size() < 7 || file.substr(file.size() - 7) != ".places") {
            meshes.meshes.push_back(runtime::loadMesh(file));
            continue;
          }
          std::ifstream stream(file);
          for (Place place; stream >> place.mesh;) {
            for (float &number : place.columns)
              stream >> number;
            meshes.places.push_back(place);
          }
        }
        return meshes;
      },
      [](Meshes meshes) { return std::make_unique<Scene>(std::move(meshes)); }, sample);
}
