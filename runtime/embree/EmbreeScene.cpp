#include "runtime/embree/EmbreeScene.h"

#include "runtime/embree/EmbreeRay.h"
#include "runtime/embree/HostScene.h"
#include "runtime/program/ProgramHost.h"
#include "support/ErrorMessages.h"
#include "support/Parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
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

constexpr float isOver = -std::numeric_limits<float>::infinity(); // RTCRay::tfar

template <typename Ray>
const Ray &rayOf(const EmbreeContext &context) {
  return static_cast<const Ray &>(*context.ray);
}

const device::InstanceRay *enteredInstance(const EmbreeContext &context) {
  return context.space->isWorld ? nullptr : &rayOf<device::InstanceRay>(context);
}

/// Passes an item to the visitor of the ray. False if the search is over.
bool visitItem(const EmbreeContext &context, RTCRay &ray, const RtslLeafItem &item) {
  const EmbreeVisitor &visitor = *context.visitor;
  const bool ends = visitor.visit(visitor.self, item, enteredInstance(context));
  ray.tfar = ends ? isOver : context.end(context.limit());
  return !ends;
}

[[gnu::cold, gnu::noinline]] void visitBlock(const EmbreeContext &context, RTCRay &ray,
                                             const TriangleBlock &block) {
  const device::InstanceRay *entered = enteredInstance(context);
  for (unsigned i = 0; i < TriangleBlock::lanes && block.instance[i] != RTSL_NO_HIT; ++i)
    if (!visitItem(context, ray,
                   {entered ? entered->instance : block.instance[i], block.triangle[i]}))
      return;
}

template <typename Ray>
void intersectBlock(const RTCIntersectFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  const TriangleBlock &block = context.space->blocks[arguments->primID];
  RTCRay &ray = reinterpret_cast<RTCRayHit *>(arguments->rayhit)->ray;
  if (context.visitor)
    visitBlock(context, ray, block);
  else if (testBlock(*context.state, rayOf<Ray>(context), block, false))
    ray.tfar = context.end(context.state->nearest);
}

template <typename Ray>
void occludedBlock(const RTCOccludedFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  if (!testBlock(*context.state, rayOf<Ray>(context), context.space->blocks[arguments->primID],
                 true))
    return;
  reinterpret_cast<RTCRay *>(arguments->ray)->tfar = isOver;
  context.occluder = {arguments->primID, false};
}

template <typename Ray>
RtslLeafItem itemOf(const EmbreeContext &context, const EmbreePrimitive &primitive) {
  return {device::instanceOf(rayOf<Ray>(context), primitive.instance), primitive.number};
}

template <typename Ray>
bool testPrimitive(const EmbreeContext &context, unsigned number) {
  const EmbreePrimitive &primitive = context.space->primitives[number];
  const RtslLeafItem item = itemOf<Ray>(context, primitive);
  const RtslLaunch &launch = context.space->scene->launch;
  const RtslInstance &instance = launch.instances[item.instance];
  if (!primitive.intersect)
    return device::testTriangle(*context.state, rayOf<Ray>(context), launch.meshes[instance.mesh],
                                item.instance, item.primitive);
  return device::testPrimitive(*context.state, rayOf<Ray>(context), instance, item,
                               primitive.intersect);
}

template <typename Ray>
void intersectPrimitive(const RTCIntersectFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  RTCRay &ray = reinterpret_cast<RTCRayHit *>(arguments->rayhit)->ray;
  if (context.visitor)
    visitItem(context, ray, itemOf<Ray>(context, context.space->primitives[arguments->primID]));
  else if (testPrimitive<Ray>(context, arguments->primID))
    ray.tfar = context.end(context.state->nearest);
}

template <typename Ray>
void occludedPrimitive(const RTCOccludedFunctionNArguments *arguments) {
  if (testPrimitive<Ray>(contextOf(arguments), arguments->primID))
    reinterpret_cast<RTCRay *>(arguments->ray)->tfar = isOver;
}

/// For a ray that Embree cannot trace: all that is in the space. True if the search is over.
[[gnu::cold, gnu::noinline]] bool testAll(const EmbreeContext &context,
                                          const device::InstanceRay &ray, bool anyHit) {
  for (unsigned i = 0; i < context.space->primitives.size(); ++i) {
    if (context.visitor) {
      RTCRay unused{};
      const EmbreePrimitive &primitive = context.space->primitives[i];
      if (!visitItem(context, unused, itemOf<device::InstanceRay>(context, primitive)))
        return true;
    } else if (testPrimitive<device::InstanceRay>(context, i) && anyHit) {
      return true;
    }
  }
  for (const TriangleBlock &block : context.space->blocks) {
    if (context.visitor) {
      RTCRay unused{};
      visitBlock(context, unused, block);
      if (unused.tfar == isOver)
        return true;
    } else if (testBlock(*context.state, ray, block, anyHit) && anyHit) {
      return true;
    }
  }
  return false;
}

/// Does the ray enter the box of the space before `limit`? It is that of a tree's root, tested
/// before Embree begins, and turns with the instance, whose box in world space may be larger.
bool entersSpace(const EmbreeSpace &space, const device::InstanceRay &ray, float epsilon,
                 float limit) {
  const device::Range range = device::rangeInBox(space.bounds.lower, space.bounds.upper, ray.origin,
                                                 ray.inverse, 0, device::infinity);
  return !range.isEmpty() && range.near <= limit * device::cullSlack &&
         range.far >= epsilon * (1 - 2 * device::rangeShare);
}

/// Searches an instance that has a space of its own. True if the search is over.
template <bool anyHit>
bool searchInstance(const EmbreeContext &outer, unsigned number) {
  const EmbreeInstance &one = outer.space->instances[number];
  const Implementation &scene = *outer.space->scene;
  RtslState &state = *outer.state;
  device::InstanceRay ray;
  const auto isSeen = [&] {
    return outer.seesAll ||
           device::isSeen(state, scene.launch.instances[one.instance], FilledSlots{*scene.slots});
  };
  if (!isSeen() ||
      !device::enterInstance(*state.launch, *outer.ray, one.instance, state.Time, state.Epsilon,
                             outer.limit(), ray) ||
      !entersSpace(*one.inside, ray, state.Epsilon, outer.limit()))
    return false;
  EmbreeContext context;
  rtcInitIntersectContext(&context.embree);
  context.state = &state;
  context.ray = &ray;
  context.space = one.inside;
  context.visitor = outer.visitor;
  context.seesAll = true; // what is inside
  context.toEmbree = 1;
  int exponent = 0;
  if (!EmbreeScene::needsNoScaling(ray.origin, ray.direction)) {
    if (!EmbreeScene::canFollow(ray.origin, ray.direction))
      return testAll(context, ray, anyHit);
    ++rayCounters().rescaledRays;
    exponent = device::exponentOf(device::largest(ray.direction));
  }
  context.toEmbree = device::powerOfTwo(exponent);
  const float origin[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
  const float direction[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
  const auto fill = [&](RTCRay &inner) {
    Implementation::fill(inner, origin, direction, state.Epsilon, context.toEmbree,
                         device::powerOfTwo(-exponent), context.end(outer.limit()));
  };
  const RTCScene tree = one.inside->treeFor(ray.origin);
  if constexpr (anyHit) {
    RTCRay inner;
    fill(inner);
    rtcOccluded1(tree, &context.embree, &inner);
    return inner.tfar == isOver;
  } else {
    RTCRayHit inner;
    fill(inner.ray);
    inner.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    inner.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(tree, &context.embree, &inner);
    return inner.ray.tfar == isOver;
  }
}

void intersectInstance(const RTCIntersectFunctionNArguments *arguments) {
  const EmbreeContext &context = contextOf(arguments);
  RTCRay &ray = reinterpret_cast<RTCRayHit *>(arguments->rayhit)->ray;
  ray.tfar =
      searchInstance<false>(context, arguments->primID) ? isOver : context.end(context.limit());
}

void occludedInstance(const RTCOccludedFunctionNArguments *arguments) {
  if (!searchInstance<true>(contextOf(arguments), arguments->primID))
    return;
  reinterpret_cast<RTCRay *>(arguments->ray)->tfar = isOver;
  contextOf(arguments).occluder = {arguments->primID, true};
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

RtslBox boxOf(const TriangleBlock &block) {
  RtslBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = box.upper[axis] = block.vertices[0][axis][0];
    for (const auto &vertex : block.vertices)
      for (float x : vertex[axis]) {
        box.lower[axis] = std::min(box.lower[axis], x);
        box.upper[axis] = std::max(box.upper[axis], x);
      }
  }
  return box;
}

void boundBlock(const RTCBoundsFunctionArguments *arguments) {
  const RtslBox box = boxOf(levelOf(arguments).owner->blocks[arguments->primID]);
  setBounds(arguments, box.lower, box.upper);
}

RtslBox boxOf(const EmbreeSpace &space, const EmbreePrimitive &primitive) {
  const RtslLaunch &launch = space.scene->launch;
  const RtslInstance &instance = launch.instances[primitive.instance];
  return primitive.intersect
             ? device::boxOf(launch, instance, primitive.number)
             : device::boxOfTriangle(launch, launch.meshes[instance.mesh], primitive.number);
}

void boundPrimitive(const RTCBoundsFunctionArguments *arguments) {
  const EmbreeSpace &space = *levelOf(arguments).owner;
  const RtslBox box = boxOf(space, space.primitives[arguments->primID]);
  setBounds(arguments, box.lower, box.upper);
}

RtslBox boxOf(const EmbreeSpace &space, const EmbreeInstance &one) {
  const RtslInstance &instance = space.scene->launch.instances[one.instance];
  RtslBox box;
  std::copy_n(instance.lower, 3, box.lower);
  std::copy_n(instance.upper, 3, box.upper);
  return box;
}

void boundInstance(const RTCBoundsFunctionArguments *arguments) {
  const EmbreeSpace &space = *levelOf(arguments).owner;
  const RtslBox box = boxOf(space, space.instances[arguments->primID]);
  setBounds(arguments, box.lower, box.upper);
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
    throw Error(message::noMemoryForTree());
  if (implementation.error != RTC_ERROR_NONE)
    throw Error(message::embreeFails(implementation.errorText));
}

void attach(EmbreeLevel &level, std::size_t count, RTCBoundsFunction bounds,
            RTCIntersectFunctionN intersect, RTCOccludedFunctionN occluded) {
  if (count == 0)
    return;
  RTCGeometry geometry = rtcNewGeometry(level.owner->scene->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(count));
  rtcSetGeometryUserData(geometry, &level);
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occluded);
  const bool follows = level.owner->follows;
  rtcSetGeometryBuildQuality(geometry,
                             follows ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(level.scene, geometry);
  if (follows)
    level.geometries.push_back(geometry); // which the scene keeps, too
  rtcReleaseGeometry(geometry);
}

template <typename Ray>
void attachContents(EmbreeLevel &level) {
  const EmbreeSpace &space = *level.owner;
  attach(level, space.blocks.size(), boundBlock, intersectBlock<Ray>, occludedBlock<Ray>);
  attach(level, space.primitives.size(), boundPrimitive, intersectPrimitive<Ray>,
         occludedPrimitive<Ray>);
}

void buildLevel(EmbreeLevel &level) {
  const EmbreeSpace &space = *level.owner;
  level.scene = rtcNewScene(space.scene->device);
  // Only a scene of low quality, which has a tree for each geometry, keeps the shapes of trees.
  rtcSetSceneBuildQuality(level.scene,
                          space.follows ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
  if (space.follows)
    rtcSetSceneFlags(level.scene, RTC_SCENE_FLAG_DYNAMIC);
  if (space.isWorld)
    attachContents<device::TriangleRay>(level);
  else
    attachContents<device::InstanceRay>(level);
  attach(level, space.instances.size(), boundInstance, intersectInstance, occludedInstance);
  rtcCommitScene(level.scene);
  check(*space.scene);
}

/// Levels for origins up to 4 times the extent of half of the items in the space, then 64 times as
/// far each. An infinite plane must not enlarge all boxes.
void addLevels(EmbreeSpace &self) {
  std::vector<float> reaches;
  for (const TriangleBlock &block : self.blocks)
    reaches.push_back(std::fabs(block.vertices[0][0][0]) + std::fabs(block.vertices[0][1][0]) +
                      std::fabs(block.vertices[0][2][0]));
  const auto addBox = [&](const float lower[3], const float upper[3]) {
    float reach = 0;
    for (int i = 0; i < 3; ++i)
      reach += std::max(std::fabs(lower[i]), std::fabs(upper[i]));
    reaches.push_back(reach);
  };
  for (const EmbreePrimitive &primitive : self.primitives) {
    const RtslBox box = boxOf(self, primitive);
    addBox(box.lower, box.upper);
  }
  for (const EmbreeInstance &one : self.instances) {
    const RtslInstance &instance = self.scene->launch.instances[one.instance];
    addBox(instance.lower, instance.upper);
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

/// Adds the boxes of everything in the space but triangles in blocks.
void addBoxes(const EmbreeSpace &space, std::vector<RtslBox> &boxes) {
  for (const EmbreePrimitive &primitive : space.primitives)
    boxes.push_back(boxOf(space, primitive));
  for (const EmbreeInstance &one : space.instances)
    boxes.push_back(boxOf(space, one));
}

/// The boxes of everything in the space.
std::vector<RtslBox> boxesOf(const EmbreeSpace &space) {
  std::vector<RtslBox> boxes;
  boxes.reserve(space.blocks.size() + space.primitives.size() + space.instances.size());
  for (const TriangleBlock &block : space.blocks)
    boxes.push_back(boxOf(block));
  addBoxes(space, boxes);
  return boxes;
}

void setBounds(EmbreeSpace &space, const std::vector<RtslBox> &boxes) {
  std::fill_n(space.bounds.lower, 3, device::infinity);
  std::fill_n(space.bounds.upper, 3, -device::infinity);
  for (const RtslBox &box : boxes)
    for (int axis = 0; axis < 3; ++axis) {
      space.bounds.lower[axis] = std::min(space.bounds.lower[axis], box.lower[axis]);
      space.bounds.upper[axis] = std::max(space.bounds.upper[axis], box.upper[axis]);
    }
}

void buildSpace(EmbreeSpace &space, unsigned threads) {
  space.blocks = makeTriangleBlocks(space.scene->device, space.meshes, threads);
  check(*space.scene);
  if (!space.isWorld)
    setBounds(space, boxesOf(space));
  addLevels(space);
  buildLevel(*space.levels[0]);
  space.firstLevel = space.levels[0]->scene;
  space.firstLevelOrigin = space.levels[0]->largestOrigin;
}

//===----------------------------------------------------------------------===//
// What moves
//===----------------------------------------------------------------------===//

/// Copies the vertices of all triangles to their blocks again. True if some are elsewhere.
bool updateBlocks(EmbreeSpace &space, std::uint32_t mesh, unsigned threads) {
  const RtslLaunch &launch = space.scene->launch;
  std::atomic<bool> isChanged{false};
  constexpr std::size_t atOnce = 1024;
  forEachInParallel(threads, (space.blocks.size() + atOnce - 1) / atOnce, [&](std::size_t part) {
    const std::size_t end = std::min(space.blocks.size(), (part + 1) * atOnce);
    for (std::size_t i = part * atOnce; i < end; ++i) {
      TriangleBlock &block = space.blocks[i];
      const TriangleBlock before = block;
      for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
        const bool isEmpty = block.instance[lane] == RTSL_NO_HIT; // it repeats the first
        const std::uint32_t instance = block.instance[isEmpty ? 0 : lane];
        const RtslMesh &of = launch.meshes[space.isWorld ? launch.instances[instance].mesh : mesh];
        block.setLane(lane, device::triangleVertices(of, block.triangle[lane]),
                      block.instance[lane], block.triangle[lane]);
      }
      if (std::memcmp(&before, &block, sizeof block) != 0)
        isChanged = true;
    }
  });
  return isChanged;
}

void releaseLevels(EmbreeSpace &space) {
  for (const auto &level : space.levels)
    if (level->scene)
      rtcReleaseScene(level->scene);
  space.levels.clear();
}

/// Trees for distant origins are built when they are needed again.
void releaseDistantLevels(EmbreeSpace &space) {
  for (std::size_t i = 1; i < space.levels.size(); ++i) {
    if (!space.levels[i]->scene)
      continue;
    rtcReleaseScene(space.levels[i]->scene);
    auto level = std::make_unique<EmbreeLevel>();
    level->owner = &space;
    level->largestOrigin = space.levels[i]->largestOrigin;
    space.levels[i] = std::move(level);
  }
}

/// After updateBlocks. The first change builds a tree that can follow the next ones. True if the
/// tree was built anew.
bool updateTree(EmbreeSpace &space, unsigned threads) {
  const std::vector<RtslBox> boxes = boxesOf(space);
  if (!space.follows || space.boxesWhenBuilt.degradation(boxes) > largestDegradation) {
    space.follows = true;
    releaseLevels(space);
    buildSpace(space, threads);
    space.boxesWhenBuilt = BoxOrder(boxesOf(space));
    return true;
  }
  setBounds(space, boxes);
  releaseDistantLevels(space);
  EmbreeLevel &level = *space.levels[0];
  for (const RTCGeometry geometry : level.geometries)
    rtcCommitGeometry(geometry);
  rtcCommitScene(level.scene);
  check(*space.scene);
  return false;
}

bool updateSpace(EmbreeSpace &space, std::uint32_t mesh, unsigned threads) {
  updateBlocks(space, mesh, threads);
  return updateTree(space, threads);
}

/// The same for a space of another scene, where perhaps nothing is elsewhere.
bool followSpace(EmbreeSpace &space, std::uint32_t mesh, unsigned threads) {
  const bool isChanged = updateBlocks(space, mesh, threads);
  std::vector<RtslBox> boxes;
  addBoxes(space, boxes);
  const auto isSame = [](const RtslBox &a, const RtslBox &b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
  };
  return (isChanged || !std::equal(boxes.begin(), boxes.end(), space.boxes.begin(),
                                   space.boxes.end(), isSame)) &&
         updateTree(space, threads);
}

/// What tests a primitive.
auto *intersectOf(const Scene &scene, const Program::Slots &slots, RtslRef primitive) {
  auto *const ofClass = scene.classOf(primitive).intersect;
  return ofClass ? ofClass : slots.rt_Primitive_intersect;
}

/// Makes a space that of another scene, whose launch is the current one. `mesh`: of a space of its
/// own.
void useScene(EmbreeSpace &space, std::uint32_t mesh, const Scene &scene,
              const Program::Slots &slots) {
  const RtslLaunch &launch = space.scene->launch;
  for (MeshUse &use : space.meshes)
    use.mesh = &launch.meshes[space.isWorld ? launch.instances[use.instance].mesh : mesh];
  const EmbreePrimitive *before = nullptr;
  for (EmbreePrimitive &primitive : space.primitives) {
    if (!primitive.intersect) // a triangle
      continue;
    primitive.intersect =
        before && before->instance == primitive.instance
            ? before->intersect
            : intersectOf(scene, slots, launch.instances[primitive.instance].primitive);
    before = &primitive;
  }
}

std::uint64_t newNumber() {
  static std::atomic<std::uint64_t> scenes = 0;
  return ++scenes;
}

} // namespace

bool EmbreeScene::Implementation::isInInstance(const EmbreeContext &context, std::uint32_t number) {
  return searchInstance<true>(context, number);
}

EmbreeScene::Implementation::~Implementation() {
  releaseLevels(world);
  for (const auto &space : spaces)
    releaseLevels(*space.second);
  if (device)
    rtcReleaseDevice(device);
}

RTCScene EmbreeSpace::treeForFar(float origin) const {
  std::size_t i = 1;
  while (i + 1 < levels.size() && !(origin <= levels[i]->largestOrigin))
    ++i;
  EmbreeLevel &level = *levels[i];
  std::call_once(level.built, [&] { buildLevel(level); });
  return level.scene;
}

EmbreeScene::EmbreeScene(const Scene &scene, const Program::Slots &slots, unsigned threads)
    : self(std::make_unique<Implementation>()) {
  self->number = newNumber();
  // With AVX-512 Embree orders the children of a node by instructions with a latency that a single
  // ray cannot hide: its code for AVX2 takes 0.92 to 0.98 of the time (Zen 5).
  std::string config = "max_isa=avx2";
  if (threads)
    config += fmt::format(",threads={}", threads);
  self->device = rtcNewDevice(config.c_str());
  if (!self->device) {
    const RTCError error = rtcGetDeviceError(nullptr);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
      throw Error(message::noMemoryForEmbree());
    throw Error(message::embreeDoesNotStart(int(error)));
  }
  rtcSetDeviceErrorFunction(self->device, noteError, self.get());

  self->launch = scene.launch();
  self->contents = treeContents(self->launch);
  self->slots = &slots;
  self->world.scene = self.get();
  const RtslLaunch &launch = self->launch;
  const auto addPrimitives = [&](EmbreeSpace &space, std::uint32_t number) {
    auto *const intersect = intersectOf(scene, slots, launch.instances[number].primitive);
    for (std::uint32_t i = 0; i < scene.primitiveCount(number); ++i)
      space.primitives.push_back({intersect, number, i});
  };
  // Blocks hold vertices, so triangles that move are items of their own.
  const auto addMesh = [&](EmbreeSpace &space, std::uint32_t number, std::uint32_t asInstance) {
    const RtslMesh &mesh = launch.meshes[launch.instances[number].mesh];
    if (!mesh.keyTimes) {
      space.meshes.push_back({asInstance, &mesh});
      return;
    }
    for (std::uint32_t i = 0; i < mesh.triangleCount; ++i)
      space.primitives.push_back({nullptr, number, i});
  };
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const RtslInstance &instance = launch.instances[i];
    const bool isMesh = instance.primitive == 0;
    if (device::hasOwnSpace(launch, instance)) {
      std::unique_ptr<EmbreeSpace> &inside = self->spaces[device::treeNumber(launch, instance)];
      if (!inside) {
        inside = std::make_unique<EmbreeSpace>();
        inside->scene = self.get();
        inside->isWorld = false;
        inside->moves = isMesh ? scene.movesOfMesh(instance.mesh) : 0;
        if (isMesh)
          addMesh(*inside, i, 0);
        else
          addPrimitives(*inside, i);
        buildSpace(*inside, threads);
      }
      self->world.instances.push_back({i, inside.get()});
    } else if (isMesh) {
      addMesh(self->world, i, i);
    } else {
      addPrimitives(self->world, i);
    }
  }
  buildSpace(self->world, threads);
}

void EmbreeScene::update(const Scene &scene, unsigned threads) {
  self->launch = scene.launch();
  bool isNew = false;
  for (const auto &[number, space] : self->spaces)
    if (number < self->launch.meshCount && space->moves != scene.movesOfMesh(number)) {
      isNew |= updateSpace(*space, number, threads);
      space->moves = scene.movesOfMesh(number);
    }
  isNew |= updateSpace(self->world, 0, threads);
  if (isNew)
    self->number = newNumber(); // blocks that occluded a ray may be no more
}

void EmbreeScene::rememberBoxes() {
  const auto remember = [](EmbreeSpace &space) {
    space.boxes.clear();
    addBoxes(space, space.boxes);
  };
  remember(self->world);
  for (const auto &[number, space] : self->spaces)
    remember(*space);
}

bool EmbreeScene::follow(const Scene &scene, const Program::Slots &slots, unsigned threads) {
  self->launch = scene.launch();
  self->slots = &slots;
  if (treeContents(self->launch) != self->contents)
    return false;
  for (const auto &[number, space] : self->spaces) {
    useScene(*space, number, scene, slots);
    followSpace(*space, number, threads);
    space->moves = number < self->launch.meshCount ? scene.movesOfMesh(number) : 0;
  }
  useScene(self->world, 0, scene, slots);
  followSpace(self->world, 0, threads);
  self->number = newNumber(); // blocks that occluded a ray may be no more, or elsewhere
  return true;
}

EmbreeScene::~EmbreeScene() = default;

bool EmbreeScene::canFollow(const RtslState &state) {
  return isEasy(state) ||
         canFollow(device::load(state.RayOrigin), device::load(state.RayDirection));
}

bool EmbreeScene::canFollow(device::Vec3 origin, device::Vec3 direction) {
  const int exponent = device::exponentOf(device::largest(direction));
  return device::largest(origin) < largestOrigin && exponent >= -largestExponent &&
         exponent <= largestExponent;
}

std::uint32_t EmbreeScene::traverse(RtslState &state, bool anyHit) const {
  if (isEasy(state))
    return traverseEasy(state, anyHit);
  ++rayCounters().rescaledRays;
  const int exponent = device::exponentOf(device::largest(device::load(state.RayDirection)));
  return self->query(state, anyHit, device::powerOfTwo(exponent), device::powerOfTwo(-exponent));
}

void EmbreeScene::visit(RtslState &state, const device::TriangleRay &ray,
                        const EmbreeVisitor &visitor) const {
  int exponent = 0;
  if (!isEasy(state)) {
    ++rayCounters().rescaledRays;
    exponent = device::exponentOf(device::largest(device::load(state.RayDirection)));
  }
  EmbreeContext context;
  rtcInitIntersectContext(&context.embree);
  context.state = &state;
  context.ray = &ray;
  context.space = &self->world;
  context.visitor = &visitor;
  context.seesAll = false;
  context.toEmbree = device::powerOfTwo(exponent);
  RTCRayHit rayHit;
  Implementation::fill(rayHit.ray, state, context.toEmbree, device::powerOfTwo(-exponent),
                       context.end(context.limit()));
  rayHit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayHit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(self->world.treeFor(device::load(state.RayOrigin)), &context.embree, &rayHit);
}

} // namespace rtsl::runtime
