//===- PathScene.cpp - diffuse parallelograms and meshes, for paths -------===//
#include "PathScene.h"

#include "Triangles.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace handwritten {

namespace {

vec3 read(std::istream &words) {
  vec3 v;
  words >> v.x >> v.y >> v.z;
  return v;
}

} // namespace

PathWorld readPathWorld(const std::string &file) {
  PathWorld world{};
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind, path;
    words >> kind;
    if (kind == "camera") {
      float degrees;
      world.view.eye = read(words);
      world.view.target = read(words);
      words >> degrees;
      world.view.slope = std::tan(glm::radians(degrees / 2));
    } else if (kind == "parallelogram") {
      Parallelogram one{};
      for (vec3 *v : {&one.anchor, &one.side1, &one.side2, &one.reflectance, &one.radiance})
        *v = read(words);
      world.parallelograms.push_back(one);
    } else if (kind == "mesh") {
      const vec3 reflectance = read(words);
      words >> path;
      world.meshes.push_back({reflectance, rtsl::runtime::loadMesh(path)});
    } else if (kind == "lens") {
      words >> world.lens.distance >> world.lens.radius >> world.lens.corners;
    } else if (kind == "sky") {
      for (vec3 *v : {&world.sky.zenith, &world.sky.horizon, &world.sky.ground})
        *v = read(words);
      words >> world.sky.blur;
    } else if (kind == "glossy") {
      GlossyMesh one{};
      one.base = read(words);
      words >> one.metallic >> one.roughness >> one.coat >> one.coatRoughness >> path;
      one.mesh = rtsl::runtime::loadMesh(path);
      world.glossy.push_back(std::move(one));
    }
    if (!words)
      throw std::runtime_error(file + " has an incomplete line: " + line);
  }
  return world;
}

PathScene::PathScene(PathWorld given) : world(std::move(given)) {
  float extent = 0;
  for (Parallelogram &one : world.parallelograms) {
    const vec3 product = glm::cross(one.side1, one.side2);
    one.area = glm::length(product);
    one.normal = product / one.area;
    if (one.isLamp())
      lamps.push_back(&one);
    for (const vec3 &v : {one.anchor, one.side1, one.side2})
      extent = std::max({extent, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  if (lamps.empty())
    throw std::runtime_error("no parallelogram shines");
  for (const DiffuseMesh &one : world.meshes)
    for (const float coordinate : one.mesh.positions)
      extent = std::max(extent, std::abs(coordinate));
  epsilon = 2e-5f * extent; // some hundred times the rounding
  forward = glm::normalize(world.view.target - world.view.eye);
  right = world.view.slope * glm::normalize(glm::cross(forward, vec3(0, 1, 0)));
  upward = glm::cross(right, forward);

  device = rtcNewDevice(nullptr);
  if (!device)
    throw std::runtime_error("Embree gives no device");
  embree = rtcNewScene(device);
  rtcSetSceneFlags(embree, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(embree, RTC_BUILD_QUALITY_MEDIUM);
  attachParallelograms();
  unsigned number = 0;
  for (DiffuseMesh &one : world.meshes)
    attach(one.mesh, ++number);
  for (GlossyMesh &one : world.glossy)
    attach(one.mesh, ++number);
  rtcCommitScene(embree);
  if (RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throw std::runtime_error("Embree fails with error " + std::to_string(error));
}

PathScene::~PathScene() {
  rtcReleaseScene(embree);
  rtcReleaseDevice(device);
}

void PathScene::attachParallelograms() {
  const std::vector<Parallelogram> &surfaces = world.parallelograms;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
  auto *vertices = static_cast<vec3 *>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), 4 * surfaces.size()));
  auto *indices = static_cast<unsigned *>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), surfaces.size()));
  if (!vertices || !indices)
    throw std::runtime_error("Embree has no memory for the scene");
  for (const Parallelogram &one : surfaces)
    for (const vec3 &corner : {one.anchor, one.anchor + one.side1,
                               one.anchor + one.side1 + one.side2, one.anchor + one.side2})
      *vertices++ = corner;
  for (unsigned i = 0; i < 4 * surfaces.size(); ++i)
    indices[i] = i;
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(embree, geometry, 0);
  rtcReleaseGeometry(geometry);
}

void PathScene::attach(rtsl::runtime::Mesh &mesh, unsigned number) {
  RTCGeometry geometry = newTriangles(device, mesh);
  rtcAttachGeometryByID(embree, geometry, number);
  rtcReleaseGeometry(geometry);
}

} // namespace handwritten
