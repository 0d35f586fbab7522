#include "runtime/embree/EmbreeSpace.h"

#include "runtime/embree/EmbreeCallbacks.h"
#include "runtime/embree/EmbreeRay.h"
#include "support/ErrorMessages.h"
#include "support/Parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

namespace rtsl::runtime {

namespace {

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

RtslBox boxOf(const EmbreeInstance &one) {
  RtslBox box;
  std::copy_n(one.lower, 3, box.lower);
  std::copy_n(one.upper, 3, box.upper);
  return box;
}

void boundInstance(const RTCBoundsFunctionArguments *arguments) {
  const EmbreeInstance &one = levelOf(arguments).owner->instances[arguments->primID];
  setBounds(arguments, one.lower, one.upper);
}

} // namespace

void EmbreeInstance::update(const RtslLaunch &launch) {
  const RtslInstance &of = launch.instances[instance];
  const RtslTransform &transform = launch.transforms[of.transform];
  std::copy_n(of.lower, 3, lower);
  std::copy_n(of.upper, 3, upper);
  std::copy_n(transform.inverse, 9, inverse);
  if (transform.motion == 0)
    std::copy_n(transform.translation, 3, translation);
  else
    std::fill_n(translation, 3, std::numeric_limits<float>::quiet_NaN());
}

std::vector<RtslBox> boxesOf(const EmbreeSpace &space) {
  std::vector<RtslBox> boxes;
  boxes.reserve(space.primitives.size() + space.instances.size());
  for (const EmbreePrimitive &primitive : space.primitives)
    boxes.push_back(boxOf(space, primitive));
  for (const EmbreeInstance &one : space.instances)
    boxes.push_back(boxOf(one));
  return boxes;
}

//===----------------------------------------------------------------------===//
// Trees
//===----------------------------------------------------------------------===//

void checkEmbree(const EmbreeScene::Implementation &implementation) {
  if (implementation.error == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(message::noMemoryForTree());
  if (implementation.error != RTC_ERROR_NONE)
    throw Error(message::embreeFails(implementation.errorText));
}

namespace {

void attach(EmbreeLevel &level, std::size_t count, RTCBoundsFunction bounds,
            const SearchCallbacks &search) {
  if (count == 0)
    return;
  RTCGeometry geometry = rtcNewGeometry(level.owner->scene->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(count));
  rtcSetGeometryUserData(geometry, &level);
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, search.intersect);
  rtcSetGeometryOccludedFunction(geometry, search.occluded);
  const bool follows = level.owner->follows;
  rtcSetGeometryBuildQuality(geometry,
                             follows ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_MEDIUM);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(level.scene, geometry);
  if (follows)
    level.geometries.push_back(geometry); // which the scene keeps, too
  rtcReleaseGeometry(geometry);
}

void buildLevel(EmbreeLevel &level) {
  const EmbreeSpace &space = *level.owner;
  level.scene = rtcNewScene(space.scene->device);
  // Only a scene of low quality, which has a tree for each geometry, keeps the shapes of trees.
  rtcSetSceneBuildQuality(level.scene,
                          space.follows ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
  if (space.follows)
    rtcSetSceneFlags(level.scene, RTC_SCENE_FLAG_DYNAMIC);
  attach(level, space.primitives.size(), boundPrimitive, primitiveCallbacks(space.isWorld));
  attach(level, space.instances.size(), boundInstance, instanceCallbacks());
  rtcCommitScene(level.scene);
  checkEmbree(*space.scene);
}

/// Levels for origins up to 4 times the extent of half of these boxes, then 64 times as far each.
/// An infinite plane must not enlarge all boxes.
void addLevels(EmbreeSpace &self, const std::vector<RtslBox> &boxes) {
  std::vector<float> reaches;
  for (const RtslBox &box : boxes) {
    float reach = 0;
    for (int i = 0; i < 3; ++i)
      reach += std::max(std::fabs(box.lower[i]), std::fabs(box.upper[i]));
    reaches.push_back(reach);
  }
  auto middle = reaches.begin() + std::ptrdiff_t(reaches.size() / 2);
  std::nth_element(reaches.begin(), middle, reaches.end());
  const float reach = std::max(*middle, std::numeric_limits<float>::min());
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

/// Of triangles, and of the boxes of everything else.
void setBounds(EmbreeSpace &space, const std::vector<RtslBox> &boxes) {
  space.bounds = space.triangles.bounds();
  for (const RtslBox &box : boxes)
    for (int axis = 0; axis < 3; ++axis) {
      space.bounds.lower[axis] = std::min(space.bounds.lower[axis], box.lower[axis]);
      space.bounds.upper[axis] = std::max(space.bounds.upper[axis], box.upper[axis]);
    }
}

/// Lists the items of the world, where they are, if there are few.
void listItems(EmbreeSpace &space, const std::vector<RtslBox> &boxes) {
  if (space.isWorld && boxes.size() <= ItemList::most)
    space.list = ItemList(boxes);
}

/// Embree's tree for origins that are not far away, if there is anything in it.
void buildTree(EmbreeSpace &space, const std::vector<RtslBox> &boxes) {
  if (boxes.empty() || !space.list.isEmpty())
    return;
  addLevels(space, boxes);
  buildLevel(*space.levels[0]);
  space.firstLevel = space.levels[0]->scene;
  space.firstLevelOrigin = space.levels[0]->largestOrigin;
  space.secondLevelOrigin = space.levels.size() > 1 ? space.levels[1]->largestOrigin : 0;
}

} // namespace

void buildSpace(EmbreeSpace &space, unsigned threads) {
  space.triangles = BlockTree(space.meshes, threads);
  const std::vector<RtslBox> boxes = boxesOf(space);
  setBounds(space, boxes);
  listItems(space, boxes);
  buildTree(space, boxes);
}

RTCScene EmbreeSpace::treeForFar(float origin) const {
  std::size_t i = 1;
  while (i + 1 < levels.size() && !(origin <= levels[i]->largestOrigin))
    ++i;
  EmbreeLevel &level = *levels[i];
  std::call_once(level.built, [&] { buildLevel(level); });
  if (i == 1)
    secondLevel.store(level.scene, std::memory_order_release);
  return level.scene;
}

void releaseLevels(EmbreeSpace &space) {
  for (const auto &level : space.levels)
    if (level->scene)
      rtcReleaseScene(level->scene);
  space.levels.clear();
  space.secondLevel = nullptr;
}

//===----------------------------------------------------------------------===//
// What moves
//===----------------------------------------------------------------------===//

decltype(EmbreePrimitive::intersect) intersectOf(const Scene &scene, const Program::Slots &slots,
                                                 RtslRef primitive) {
  auto *const ofClass = scene.classOf(primitive).intersect;
  return ofClass ? ofClass : slots.rt_Primitive_intersect;
}

namespace {

void updateInstances(EmbreeSpace &space) {
  for (EmbreeInstance &one : space.instances)
    one.update(space.scene->launch);
}

/// Copies the vertices of all triangles to their blocks again. True if some are elsewhere.
bool updateBlocks(EmbreeSpace &space, std::uint32_t mesh, unsigned threads) {
  const RtslLaunch &launch = space.scene->launch;
  LargeArray<TriangleBlock> &blocks = space.triangles.blocks;
  std::atomic<bool> isChanged{false};
  forEachInParallel(threads, blocks.size(), 1024, [&](std::size_t i) {
    TriangleBlock &block = blocks[i];
    const TriangleBlock before = block;
    for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
      const bool isEmpty = block.instance[lane] == RTSL_NO_HIT; // it repeats the first
      const std::uint32_t instance = block.instance[isEmpty ? 0 : lane];
      const RtslMesh &of = launch.meshes[space.isWorld ? launch.instances[instance].mesh : mesh];
      block.setLane(lane, device::triangleVertices(of, block.triangle[lane]), block.instance[lane],
                    block.triangle[lane]);
    }
    if (std::memcmp(&before, &block, sizeof block) != 0)
      isChanged = true;
  });
  return isChanged;
}

/// The tree of triangles follows its blocks. True if it was built anew.
bool updateTriangles(EmbreeSpace &space, unsigned threads) {
  space.triangles.refit(threads);
  if (space.triangles.degradation() <= largestDegradation)
    return false;
  space.triangles = BlockTree(space.meshes, threads);
  return true;
}

/// Trees for distant origins are built when they are needed again.
void releaseDistantLevels(EmbreeSpace &space) {
  space.secondLevel = nullptr;
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

/// Embree's tree follows these boxes. The first change builds a tree that can follow the next ones.
void updateTree(EmbreeSpace &space, const std::vector<RtslBox> &boxes) {
  listItems(space, boxes);
  if (!space.hasTree())
    return;
  if (!space.follows || space.boxesWhenBuilt.degradation(boxes) > largestDegradation) {
    space.follows = true;
    releaseLevels(space);
    buildTree(space, boxes);
    space.boxesWhenBuilt = BoxOrder(boxes);
    return;
  }
  releaseDistantLevels(space);
  EmbreeLevel &level = *space.levels[0];
  for (const RTCGeometry geometry : level.geometries)
    rtcCommitGeometry(geometry);
  rtcCommitScene(level.scene);
  checkEmbree(*space.scene);
}

/// Makes a space that of another scene, whose launch is the current one.
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

} // namespace

bool updateSpace(EmbreeSpace &space, std::uint32_t mesh, unsigned threads) {
  updateInstances(space);
  const bool isNew = updateBlocks(space, mesh, threads) && updateTriangles(space, threads);
  const std::vector<RtslBox> boxes = boxesOf(space);
  setBounds(space, boxes);
  updateTree(space, boxes);
  return isNew;
}

void followSpace(EmbreeSpace &space, std::uint32_t mesh, const Scene &scene,
                 const Program::Slots &slots, unsigned threads) {
  useScene(space, mesh, scene, slots);
  updateInstances(space);
  if (updateBlocks(space, mesh, threads))
    updateTriangles(space, threads);
  const std::vector<RtslBox> boxes = boxesOf(space);
  setBounds(space, boxes);
  const auto isSame = [](const RtslBox &a, const RtslBox &b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
  };
  if (!std::equal(boxes.begin(), boxes.end(), space.boxes.begin(), space.boxes.end(), isSame))
    updateTree(space, boxes);
}

} // namespace rtsl::runtime
