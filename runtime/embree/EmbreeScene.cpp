#include "runtime/embree/EmbreeScene.h"

#include "runtime/embree/EmbreeRay.h"
#include "runtime/embree/HostScene.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>

namespace rtsl::runtime {

namespace {

using Implementation = EmbreeScene::Implementation;

//===----------------------------------------------------------------------===//
// Callbacks of Embree for a ray
//===----------------------------------------------------------------------===//

template <typename Arguments>
const EmbreeContext &contextOf(const Arguments *arguments) {
  return *reinterpret_cast<const EmbreeContext *>(arguments->context);
}

/// Passes an item to the visitor of the ray. False if the search is over.
bool visitItem(const EmbreeContext &context, RTCRay &ray, const RtslLeafItem &item) {
  const EmbreeVisitor &visitor = *context.visitor;
  const bool isOver = visitor.visit(visitor.self, item);
  ray.tfar =
      isOver ? -std::numeric_limits<float>::infinity() : context.end(visitor.limit(visitor.self));
  return !isOver;
}

[[gnu::cold, gnu::noinline]] void visitBlock(const EmbreeContext &context, RTCRay &ray,
                                             const TriangleBlock &block) {
  for (unsigned i = 0; i < TriangleBlock::lanes && block.instance[i] != RTSL_NO_HIT; ++i)
    if (!visitItem(context, ray, {block.instance[i], block.triangle[i]}))
      return;
}

void intersectBlock(const RTCIntersectFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  const TriangleBlock &block = context.scene->blocks[arguments->primID];
  RTCRay &ray = reinterpret_cast<RTCRayHit *>(arguments->rayhit)->ray;
  if (context.visitor)
    visitBlock(context, ray, block);
  else if (testBlock(*context.state, *context.ray, block, false))
    ray.tfar = context.end(context.state->nearest);
}

void occludedBlock(const RTCOccludedFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  if (!testBlock(*context.state, *context.ray, context.scene->blocks[arguments->primID], true))
    return;
  reinterpret_cast<RTCRay *>(arguments->ray)->tfar = -std::numeric_limits<float>::infinity();
  context.occluder = arguments->primID;
}

bool testPrimitive(const EmbreeContext &context, unsigned number) {
  const EmbreePrimitive &primitive = context.scene->primitives[number];
  return device::testPrimitive(*context.state, *context.ray,
                               context.scene->instances[primitive.instance],
                               {primitive.instance, 0}, primitive.intersect);
}

void intersectPrimitive(const RTCIntersectFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  RTCRay &ray = reinterpret_cast<RTCRayHit *>(arguments->rayhit)->ray;
  if (context.visitor)
    visitItem(context, ray, {context.scene->primitives[arguments->primID].instance, 0});
  else if (testPrimitive(context, arguments->primID))
    ray.tfar = context.end(context.state->nearest);
}

void occludedPrimitive(const RTCOccludedFunctionNArguments *arguments) {
  if (testPrimitive(contextOf(arguments), arguments->primID))
    reinterpret_cast<RTCRay *>(arguments->ray)->tfar = -std::numeric_limits<float>::infinity();
}

//===----------------------------------------------------------------------===//
// Boxes
//===----------------------------------------------------------------------===//

/// Embree computes distances to the sides of boxes as products of coordinates, and a ray may miss a
/// box by bvhSlack and still hit its contents: together less than this share of the coordinates of
/// both. See TravRay and intersectNode in kernels/bvh/node_intersector1.h of Embree 3.13.
constexpr float boxShare = 32 * device::roundingUnit;
/// Embree ignores primitives whose boxes are larger.
constexpr float largestSide = 1.8e18f;

const EmbreeLevel &levelOf(const RTCBoundsFunctionArguments *arguments) {
  return *static_cast<const EmbreeLevel *>(arguments->geometryUserPtr);
}

void setBounds(const RTCBoundsFunctionArguments *arguments, const float lower[3],
               const float upper[3]) {
  float size = levelOf(arguments).largestOrigin;
  for (int i = 0; i < 3; ++i)
    size = std::max({size, std::fabs(lower[i]), std::fabs(upper[i])});
  float low[3], high[3];
  for (int i = 0; i < 3; ++i) {
    low[i] = std::max(lower[i] - 2 * boxShare * size, -largestSide);
    high[i] = std::min(upper[i] + 2 * boxShare * size, largestSide);
  }
  *arguments->bounds_o = {low[0], low[1], low[2], 0, high[0], high[1], high[2], 0};
}

void boundBlock(const RTCBoundsFunctionArguments *arguments) {
  const TriangleBlock &block = levelOf(arguments).owner->blocks[arguments->primID];
  float lower[3], upper[3];
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = upper[axis] = block.vertices[0][axis][0];
    for (const auto &vertex : block.vertices)
      for (float x : vertex[axis]) {
        lower[axis] = std::min(lower[axis], x);
        upper[axis] = std::max(upper[axis], x);
      }
  }
  setBounds(arguments, lower, upper);
}

void boundPrimitive(const RTCBoundsFunctionArguments *arguments) {
  const Implementation &owner = *levelOf(arguments).owner;
  const RtslInstance &instance = owner.instances[owner.primitives[arguments->primID].instance];
  setBounds(arguments, instance.lower, instance.upper);
}

//===----------------------------------------------------------------------===//
// Trees
//===----------------------------------------------------------------------===//

void noteError(void *self, RTCError code, const char *text) {
  auto &implementation = *static_cast<Implementation *>(self);
  if (implementation.error == RTC_ERROR_NONE) {
    implementation.error = code;
    implementation.errorText = text ? text : "";
  }
}

void check(const Implementation &implementation) {
  if (implementation.error == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorCode::OutOfMemory, "not enough memory for the scene's acceleration structure");
  if (implementation.error != RTC_ERROR_NONE)
    throw Error(ErrorCode::Internal, fmt::format("Embree fails: {}", implementation.errorText));
}

void attach(const Implementation &owner, EmbreeLevel &level, std::size_t count,
            RTCBoundsFunction bounds, RTCIntersectFunctionN intersect,
            RTCOccludedFunctionN occluded) {
  if (count == 0)
    return;
  RTCGeometry geometry = rtcNewGeometry(owner.device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(count));
  rtcSetGeometryUserData(geometry, &level);
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occluded);
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(level.scene, geometry);
  rtcReleaseGeometry(geometry);
}

void buildLevel(const Implementation &owner, EmbreeLevel &level) {
  level.scene = rtcNewScene(owner.device);
  rtcSetSceneBuildQuality(level.scene, RTC_BUILD_QUALITY_MEDIUM);
  attach(owner, level, owner.blocks.size(), boundBlock, intersectBlock, occludedBlock);
  attach(owner, level, owner.primitives.size(), boundPrimitive, intersectPrimitive,
         occludedPrimitive);
  rtcCommitScene(level.scene);
  check(owner);
}

/// Levels for origins up to 4 times the extent of half of the items in the scene, then 64 times as
/// far each. An infinite plane must not enlarge all boxes.
void addLevels(Implementation &self) {
  std::vector<float> reaches;
  for (const TriangleBlock &block : self.blocks)
    reaches.push_back(std::fabs(block.vertices[0][0][0]) + std::fabs(block.vertices[0][1][0]) +
                      std::fabs(block.vertices[0][2][0]));
  for (const EmbreePrimitive &primitive : self.primitives) {
    const RtslInstance &instance = self.instances[primitive.instance];
    float reach = 0;
    for (int i = 0; i < 3; ++i)
      reach += std::max(std::fabs(instance.lower[i]), std::fabs(instance.upper[i]));
    reaches.push_back(reach);
  }
  float reach = 1;
  if (!reaches.empty()) {
    auto middle = reaches.begin() + std::ptrdiff_t(reaches.size() / 2);
    std::nth_element(reaches.begin(), middle, reaches.end());
    reach = std::max(*middle, std::numeric_limits<float>::min());
  }
  constexpr float largest = 4e18f;
  for (float origin = 4 * reach;; origin *= 64) {
    auto level = std::make_unique<EmbreeLevel>();
    level->owner = &self;
    level->largestOrigin = std::min(origin, largest);
    self.levels.push_back(std::move(level));
    if (!(origin < largest))
      return;
  }
}

} // namespace

EmbreeScene::Implementation::~Implementation() {
  for (const auto &level : levels)
    if (level->scene)
      rtcReleaseScene(level->scene);
  if (device)
    rtcReleaseDevice(device);
}

RTCScene EmbreeScene::Implementation::treeForFar(float origin) const {
  std::size_t i = 1;
  while (i + 1 < levels.size() && !(origin <= levels[i]->largestOrigin))
    ++i;
  EmbreeLevel &level = *levels[i];
  std::call_once(level.built, [&] { buildLevel(*this, level); });
  return level.scene;
}

EmbreeScene::EmbreeScene(const Scene &scene, const Program::Slots &slots, unsigned threads)
    : self(std::make_unique<Implementation>()) {
  static std::atomic<std::uint64_t> scenes = 0;
  self->number = ++scenes;
  // With AVX-512 Embree orders the children of a node by instructions with a latency that a single
  // ray cannot hide: its code for AVX2 takes 0.92 to 0.98 of the time (Zen 5).
  std::string config = "max_isa=avx2";
  if (threads)
    config += fmt::format(",threads={}", threads);
  self->device = rtcNewDevice(config.c_str());
  if (!self->device) {
    const RTCError error = rtcGetDeviceError(nullptr);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
      throw Error(ErrorCode::OutOfMemory, "not enough memory for Embree to start");
    throw Error(ErrorCode::Internal, fmt::format("Embree does not start (error {})", int(error)));
  }
  rtcSetDeviceErrorFunction(self->device, noteError, self.get());

  RtslLaunch launch = scene.launch();
  self->instances = launch.instances;
  self->intersect = slots.rt_Primitive_intersect;
  self->blocks = makeTriangleBlocks(self->device, launch, threads);
  check(*self);
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i)
    if (RtslRef object = launch.instances[i].primitive) {
      auto *intersect = scene.classOf(object).intersect;
      self->primitives.push_back({intersect ? intersect : slots.rt_Primitive_intersect, object, i});
    }
  addLevels(*self);
  buildLevel(*self, *self->levels[0]);
}

EmbreeScene::~EmbreeScene() = default;

bool EmbreeScene::canFollow(const RtslState &state) {
  if (isEasy(state))
    return true;
  const int exponent = device::exponentOf(device::largest(device::load(state.RayDirection)));
  return device::largest(device::load(state.RayOrigin)) < largestOrigin &&
         exponent >= -largestExponent && exponent <= largestExponent;
}

std::uint32_t EmbreeScene::traverse(RtslState &state, bool anyHit) const {
  if (isEasy(state))
    return traverseEasy(state, anyHit);
  ++rayCounters().rescaledRays;
  const int exponent = device::exponentOf(device::largest(device::load(state.RayDirection)));
  return self->query(state, anyHit, device::powerOfTwo(exponent), device::powerOfTwo(-exponent));
}

void EmbreeScene::visit(const RtslState &state, const device::TriangleRay &ray,
                        const EmbreeVisitor &visitor) const {
  int exponent = 0;
  if (!isEasy(state)) {
    ++rayCounters().rescaledRays;
    exponent = device::exponentOf(device::largest(device::load(state.RayDirection)));
  }
  EmbreeContext context;
  rtcInitIntersectContext(&context.embree);
  context.state = nullptr;
  context.ray = &ray;
  context.scene = self.get();
  context.visitor = &visitor;
  context.toEmbree = device::powerOfTwo(exponent);
  RTCRayHit rayHit;
  Implementation::fill(rayHit.ray, state, context.toEmbree, device::powerOfTwo(-exponent),
                       context.end(visitor.limit(visitor.self)));
  rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(self->treeFor(state.RayOrigin), &context.embree, &rayHit);
}

} // namespace rtsl::runtime
