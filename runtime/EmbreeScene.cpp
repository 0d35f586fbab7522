#include "runtime/EmbreeScene.h"

#include "runtime/EmbreeRay.h"
#include "runtime/HostScene.h"

#include <fmt/format.h>

#include <limits>
#include <string>

namespace rtsl::runtime {

namespace {

void getBounds(const RTCBoundsFunctionArguments *arguments) {
  const Bounds &bounds = static_cast<const EmbreePrimitive *>(arguments->geometryUserPtr)->bounds;
  *arguments->bounds_o = {bounds.lower[0], bounds.lower[1], bounds.lower[2], 0,
                          bounds.upper[0], bounds.upper[1], bounds.upper[2], 0};
}

/// Calls `intersect`; returns whether it committed a hit.
bool testPrimitive(const EmbreePrimitive &geometry, RtslState &state) {
  device::beginCandidate(state, geometry.instance, 0);
  geometry.intersect(&state, geometry.object);
  return state.instance == geometry.instance;
}

void intersectUser(const RTCIntersectFunctionNArguments *arguments) {
  if (!arguments->valid[0])
    return;
  const auto &geometry = *static_cast<const EmbreePrimitive *>(arguments->geometryUserPtr);
  auto &context = *reinterpret_cast<EmbreeContext *>(arguments->context);
  auto &rayHit = *reinterpret_cast<RTCRayHit *>(arguments->rayhit);
  RtslState &state = *context.state;
  // Embree may have found a triangle meanwhile, which the state does not know yet.
  float distance = rayHit.ray.tfar * context.fromEmbree;
  if (distance < state.HitDistance) {
    state.HitDistance = distance;
    state.instance = rayHit.hit.geomID;
    state.primitive = rayHit.hit.primID;
  }
  if (!testPrimitive(geometry, state))
    return;
  rayHit.ray.tfar = state.HitDistance * context.toEmbree;
  rayHit.hit.geomID = geometry.instance;
  rayHit.hit.primID = 0;
}

void occludedUser(const RTCOccludedFunctionNArguments *arguments) {
  if (!arguments->valid[0])
    return;
  const auto &geometry = *static_cast<const EmbreePrimitive *>(arguments->geometryUserPtr);
  auto &context = *reinterpret_cast<EmbreeContext *>(arguments->context);
  if (testPrimitive(geometry, *context.state))
    reinterpret_cast<RTCRay *>(arguments->ray)->tfar = -std::numeric_limits<float>::infinity();
}

} // namespace

/// Takes back what shadows a ray where it starts. Embree's t of the triangle that a ray leaves is off by roundings of the
/// triangle's size, which may be more than Epsilon; ours is not (runtime/device/Triangle.h).
void checkNearOccluder(const RTCFilterFunctionNArguments *arguments) {
  auto &context = *reinterpret_cast<EmbreeContext *>(arguments->context);
  const RtslState &state = *context.state;
  constexpr float far = 32; // Epsilons; Embree's error is at most 10
  const float t = reinterpret_cast<const RTCRay *>(arguments->ray)->tfar * context.fromEmbree;
  if (!arguments->valid[0] || t > far * state.Epsilon)
    return;
  const auto &mesh = *static_cast<const RtslMesh *>(arguments->geometryUserPtr);
  const auto [v0, v1, v2] = device::triangleVertices(mesh, RTCHitN_primID(arguments->hit, 1, 0));
  device::TriangleHit hit;
  if (device::intersectTriangle(device::makeTriangleRay(device::load(state.RayOrigin), device::load(state.RayDirection)), v0, v1,
                                v2, hit) &&
      !(hit.t > state.Epsilon))
    arguments->valid[0] = 0;
}

EmbreeScene::Implementation::~Implementation() {
  if (scene)
    rtcReleaseScene(scene);
  if (device)
    rtcReleaseDevice(device);
}

namespace {

using Implementation = EmbreeScene::Implementation;

void noteError(void *self, RTCError code, const char *text) {
  auto &implementation = *static_cast<Implementation *>(self);
  if (implementation.error == RTC_ERROR_NONE) {
    implementation.error = code;
    implementation.errorText = text ? text : "";
  }
}

void check(const Implementation &implementation) {
  if (implementation.error == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorCode::OutOfMemory,
                "not enough memory for the scene's acceleration structure");
  if (implementation.error != RTC_ERROR_NONE)
    throw Error(ErrorCode::Internal, fmt::format("Embree fails: {}", implementation.errorText));
}

void attach(const Implementation &implementation, RTCGeometry geometry, std::uint32_t instance) {
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(implementation.scene, geometry, instance);
  rtcReleaseGeometry(geometry);
}

void addMesh(const Implementation &implementation, std::uint32_t instance, const RtslMesh &mesh) {
  RTCGeometry geometry = rtcNewGeometry(implementation.device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             mesh.positions, 0, 3 * sizeof(float), mesh.vertexCount);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices, 0,
                             3 * sizeof(std::uint32_t), mesh.triangleCount);
  rtcSetGeometryUserData(geometry, const_cast<RtslMesh *>(&mesh));
  rtcSetGeometryOccludedFilterFunction(geometry, checkNearOccluder);
  attach(implementation, geometry, instance);
}

void addPrimitive(const Implementation &implementation, std::uint32_t instance,
                  const EmbreePrimitive &primitive) {
  RTCGeometry geometry = rtcNewGeometry(implementation.device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, const_cast<EmbreePrimitive *>(&primitive));
  rtcSetGeometryBoundsFunction(geometry, getBounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersectUser);
  rtcSetGeometryOccludedFunction(geometry, occludedUser);
  attach(implementation, geometry, instance);
}

} // namespace

EmbreeScene::EmbreeScene(const Scene &scene, const Program::Slots &slots, unsigned threads)
    : self(std::make_unique<Implementation>()) {
  std::string config = threads ? fmt::format("threads={}", threads) : "";
  self->device = rtcNewDevice(config.c_str());
  if (!self->device)
    throw Error(ErrorCode::Internal,
                fmt::format("Embree does not start (error {})", int(rtcGetDeviceError(nullptr))));
  rtcSetDeviceErrorFunction(self->device, noteError, self.get());
  self->scene = rtcNewScene(self->device);
  rtcSetSceneFlags(self->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(self->scene, RTC_BUILD_QUALITY_MEDIUM);

  RtslLaunch launch = scene.launch();
  self->meshes = launch.meshes;
  self->instances = launch.instances;
  self->primitives.resize(launch.instanceCount);
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const RtslInstance &instance = launch.instances[i];
    if (instance.primitive == 0) {
      addMesh(*self, i, launch.meshes[instance.mesh]);
      continue;
    }
    auto *intersect = scene.classOf(instance.primitive).intersect;
    self->primitives[i] = {intersect ? intersect : slots.rt_Primitive_intersect,
                           instance.primitive, i, scene.primitiveBounds(i)};
    addPrimitive(*self, i, self->primitives[i]);
  }
  check(*self);
  rtcCommitScene(self->scene);
  check(*self);
}

EmbreeScene::~EmbreeScene() = default;

EmbreeAnswer EmbreeScene::traverse(RtslState &state, bool anyHit) const {
  if (!(device::largest(device::load(state.RayOrigin)) < largestOrigin))
    return EmbreeAnswer::Refused;
  float length = device::largest(device::load(state.RayDirection));
  if (length > shortest && length < longest)
    return traverseEasy(state, anyHit);
  // Beyond these exponents the scale or its inverse would not be exact.
  int exponent = device::exponentOf(length);
  if (exponent < -100 || exponent > 100)
    return EmbreeAnswer::Refused;
  ++rayCounters().rescaledRays;
  return self->query(state, anyHit, device::powerOfTwo(exponent), device::powerOfTwo(-exponent));
}

} // namespace rtsl::runtime
