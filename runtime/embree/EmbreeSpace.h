//===- EmbreeSpace.h - the contents of one space, with Embree's trees -----===//
//
// The world is a space, and so is each mesh, or object with several primitives, that has instances
// with transforms.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/BlockTree.h"
#include "runtime/accel/Refit.h"
#include "runtime/embree/EmbreeScene.h"
#include "runtime/embree/ItemList.h"

#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace rtsl::runtime {

struct EmbreeSpace;

/// An RTSL primitive in Embree, or a triangle of a mesh that has several keys.
struct EmbreePrimitive {
  void (*intersect)(RtslState *, RtslRef); // null: a triangle
  std::uint32_t instance; // in a space of its own: some instance of the object or mesh
  std::uint32_t number;   // of several of one object, or of the triangle
};

/// An instance in Embree that has a space of its own, with all that a ray needs to enter it: in two
/// lines of the cache, where the tables of the launch would be six in three places.
struct alignas(64) EmbreeInstance {
  double inverse[9];        // of its RtslTransform
  double loadedToo = 1;     // with the last column
  float lower[3], upper[3]; // of RtslInstance
  float translation[3];     // of its RtslTransform; NaN: that moves
  std::uint32_t instance;
  const EmbreeSpace *inside;

  EmbreeInstance(const RtslLaunch &launch, std::uint32_t instance, const EmbreeSpace *inside)
      : instance(instance), inside(inside) {
    update(launch);
  }
  /// Copies what may have changed.
  void update(const RtslLaunch &launch);
};
static_assert(sizeof(EmbreeInstance) == 128);

/// A tree for rays with origins up to some distance.
struct EmbreeLevel {
  const EmbreeSpace *owner = nullptr;
  float largestOrigin = 0; // the sum of its coordinates
  RTCScene scene = nullptr;
  std::vector<RTCGeometry> geometries; // of a scene whose trees can follow what moves
  std::once_flag built;
};

/// What can be hit in the space, and trees over it.
struct EmbreeSpace {
  const EmbreeScene::Implementation *scene = nullptr;
  bool isWorld = true;
  BlockTree triangles;
  std::vector<EmbreePrimitive> primitives;
  std::vector<EmbreeInstance> instances; // of the world
  // the boxes of primitives, then those of instances, if the world has few: they are not in trees
  ItemList list;
  RtslBox bounds;              // of all that is tested in the space
  std::vector<MeshUse> meshes; // in `triangles`
  BoxOrder boxesWhenBuilt;     // once something has moved
  bool follows = false;        // since then
  std::uint64_t moves = 0;     // Scene::movesOfMesh, of a mesh's space
  std::vector<RtslBox> boxes;  // EmbreeScene::rememberBoxes: of all but `triangles`
  // by largestOrigin; the first one is built
  mutable std::vector<std::unique_ptr<EmbreeLevel>> levels;
  float firstLevelOrigin = 0; // of levels[0]
  RTCScene firstLevel = nullptr;
  // The same of levels[1], where most rays that enter an instance from elsewhere begin; null: it is
  // not built.
  float secondLevelOrigin = 0;
  mutable std::atomic<RTCScene> secondLevel{nullptr};

  /// Has Embree a tree? Nothing else is searched there.
  bool hasTree() const { return !levels.empty(); }

  /// The tree for rays from this origin.
  RTCScene treeFor(device::Vec3 origin) const {
    float size = __builtin_fabsf(origin.x) + __builtin_fabsf(origin.y) + __builtin_fabsf(origin.z);
    if (size <= firstLevelOrigin)
      return firstLevel;
    const RTCScene second = secondLevel.load(std::memory_order_acquire);
    return second && size <= secondLevelOrigin ? second : treeForFar(size);
  }
  RTCScene treeForFar(float origin) const;
};

/// The function that tests primitives of the object.
decltype(EmbreePrimitive::intersect) intersectOf(const Scene &scene, const Program::Slots &slots,
                                                 RtslRef primitive);

/// Throws the error that Embree has reported, if any.
void checkEmbree(const EmbreeScene::Implementation &scene);

/// Builds the tree of triangles, and Embree's for origins that are not far away if anything else is
/// not in the list.
void buildSpace(EmbreeSpace &space, unsigned threads);

/// Frees all trees.
void releaseLevels(EmbreeSpace &space);

/// The boxes of everything in the space but triangles in blocks.
std::vector<RtslBox> boxesOf(const EmbreeSpace &space);

/// Follows what has moved. `mesh`: that of a space of its own. True if blocks have other numbers.
bool updateSpace(EmbreeSpace &space, std::uint32_t mesh, unsigned threads);

/// Makes a space that of another scene, whose launch is the current one, and updates the trees if
/// anything in it has moved since `boxes` and blocks were stored.
void followSpace(EmbreeSpace &space, std::uint32_t mesh, const Scene &scene,
                 const Program::Slots &slots, unsigned threads);

} // namespace rtsl::runtime
