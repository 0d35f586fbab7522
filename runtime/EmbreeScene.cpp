#include "runtime/EmbreeScene.h"

#include "runtime/HostScene.h"
#include "runtime/device/Hit.h"
#include "runtime/device/Traverse.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace rtsl::runtime {

namespace {

/// Embree's context of a ray, and behind it what our callbacks need.
struct RayContext {
  RTCIntersectContext embree;
  RtslState *state;
  float toEmbree, fromEmbree; // powers of two that turn our t into Embree's, and back
};

struct UserGeometry {
  void (*intersect)(RtslState *, RtslRef);
  RtslRef object;
  std::uint32_t instance;
  Bounds bounds;
};

void getBounds(const RTCBoundsFunctionArguments *arguments) {
  const Bounds &bounds = static_cast<const UserGeometry *>(arguments->geometryUserPtr)->bounds;
  *arguments->bounds_o = {bounds.lower[0], bounds.lower[1], bounds.lower[2], 0,
                          bounds.upper[0], bounds.upper[1], bounds.upper[2], 0};
}

/// Calls `intersect`; returns whether it committed a hit.
bool testPrimitive(const UserGeometry &geometry, RtslState &state) {
  state.candidateInstance = geometry.instance;
  state.candidatePrimitive = 0;
  geometry.intersect(&state, geometry.object);
  return state.instance == geometry.instance;
}

void intersectUser(const RTCIntersectFunctionNArguments *arguments) {
  if (!arguments->valid[0])
    return;
  const auto &geometry = *static_cast<const UserGeometry *>(arguments->geometryUserPtr);
  auto &context = *reinterpret_cast<RayContext *>(arguments->context);
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
  const auto &geometry = *static_cast<const UserGeometry *>(arguments->geometryUserPtr);
  auto &context = *reinterpret_cast<RayContext *>(arguments->context);
  if (testPrimitive(geometry, *context.state))
    reinterpret_cast<RTCRay *>(arguments->ray)->tfar = -std::numeric_limits<float>::infinity();
}

} // namespace

struct EmbreeScene::Implementation {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  const RtslMesh *meshes = nullptr;
  const RtslInstance *instances = nullptr;
  std::vector<UserGeometry> userGeometries; // by instance; Embree holds pointers into it
  RTCError error = RTC_ERROR_NONE;
  std::string errorText;

  EmbreeAnswer query(RtslState &state, bool anyHit, float toEmbree, float fromEmbree) const;

  ~Implementation() {
    if (scene)
      rtcReleaseScene(scene);
    if (device)
      rtcReleaseDevice(device);
  }

  static void noteError(void *self, RTCError code, const char *text) {
    auto &implementation = *static_cast<Implementation *>(self);
    if (implementation.error == RTC_ERROR_NONE) {
      implementation.error = code;
      implementation.errorText = text ? text : "";
    }
  }

  void check() const {
    if (error == RTC_ERROR_OUT_OF_MEMORY)
      throw Error(ErrorCode::OutOfMemory,
                  "not enough memory for the scene's acceleration structure");
    if (error != RTC_ERROR_NONE)
      throw Error(ErrorCode::Internal, fmt::format("Embree fails: {}", errorText));
  }

  void addMesh(std::uint32_t instance, const RtslMesh &mesh) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions, 0, 3 * sizeof(float), mesh.vertexCount);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.indices,
                               0, 3 * sizeof(std::uint32_t), mesh.triangleCount);
    attach(geometry, instance);
  }

  void addPrimitive(std::uint32_t instance, const UserGeometry &user) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, const_cast<UserGeometry *>(&user));
    rtcSetGeometryBoundsFunction(geometry, getBounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersectUser);
    rtcSetGeometryOccludedFunction(geometry, occludedUser);
    attach(geometry, instance);
  }

  void attach(RTCGeometry geometry, std::uint32_t instance) {
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, instance);
    rtcReleaseGeometry(geometry);
  }
};

EmbreeScene::EmbreeScene(const Scene &scene, const Program::Slots &slots, unsigned threads)
    : self(std::make_unique<Implementation>()) {
  std::string config = threads ? fmt::format("threads={}", threads) : "";
  self->device = rtcNewDevice(config.c_str());
  if (!self->device)
    throw Error(ErrorCode::Internal,
                fmt::format("Embree does not start (error {})", int(rtcGetDeviceError(nullptr))));
  rtcSetDeviceErrorFunction(self->device, Implementation::noteError, self.get());
  self->scene = rtcNewScene(self->device);
  rtcSetSceneFlags(self->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(self->scene, RTC_BUILD_QUALITY_MEDIUM);

  RtslLaunch launch = scene.launch();
  self->meshes = launch.meshes;
  self->instances = launch.instances;
  self->userGeometries.resize(launch.instanceCount);
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const RtslInstance &instance = launch.instances[i];
    if (instance.primitive == 0) {
      self->addMesh(i, launch.meshes[instance.mesh]);
      continue;
    }
    self->userGeometries[i] = {slots.rt_Primitive_intersect, instance.primitive, i,
                               scene.primitiveBounds(i)};
    self->addPrimitive(i, self->userGeometries[i]);
  }
  self->check();
  rtcCommitScene(self->scene);
  self->check();
}

EmbreeScene::~EmbreeScene() = default;

/// `toEmbree` and `fromEmbree` are powers of two and turn our t into Embree's, and back. Inlined,
/// so that nothing is left of them where they are 1.
[[gnu::always_inline]] inline EmbreeAnswer
EmbreeScene::Implementation::query(RtslState &state, bool anyHit, float toEmbree,
                                   float fromEmbree) const {
  using namespace device;
  Vec3 origin = load(state.RayOrigin), direction = load(state.RayDirection);
  Vec3 scaled = direction * fromEmbree;
  RayContext context;
  rtcInitIntersectContext(&context.embree);
  context.state = &state;
  context.toEmbree = toEmbree;
  context.fromEmbree = fromEmbree;
  float distance = state.HitDistance;
  RTCRayHit rayHit;
  RTCRay &ray = rayHit.ray;
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.dir_x = scaled.x, ray.dir_y = scaled.y, ray.dir_z = scaled.z;
  ray.tnear = maximum(state.Epsilon * toEmbree, 0.0f);
  ray.tfar = distance * toEmbree;
  ray.time = 0;
  ray.mask = ~0u;
  ray.id = 0;
  ray.flags = 0;
  if (anyHit) {
    rtcOccluded1(scene, &context.embree, &ray);
    return ray.tfar < 0 ? EmbreeAnswer::Hit : EmbreeAnswer::Miss;
  }

  rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context.embree, &rayHit);
  std::uint32_t instance = rayHit.hit.geomID;
  if (instance == RTC_INVALID_GEOMETRY_ID)
    return EmbreeAnswer::Miss;
  const RtslInstance &hit = instances[instance];
  if (hit.primitive != 0)
    return EmbreeAnswer::Hit; // its `intersect` has committed it

  // Of a triangle only the name is taken from Embree.
  state.HitDistance = distance;
  state.instance = RTSL_NO_HIT;
  if (testTriangle(state, makeTriangleRay(origin, direction), meshes[hit.mesh], instance,
                   rayHit.hit.primID))
    return EmbreeAnswer::Hit;
  return EmbreeAnswer::Refused;
}

EmbreeAnswer EmbreeScene::traverseEasy(RtslState &state, bool anyHit) const {
  return self->query(state, anyHit, 1, 1);
}

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
