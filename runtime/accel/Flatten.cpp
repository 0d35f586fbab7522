#include "runtime/accel/FlatScene.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/scene/Scene.h"
#include "support/ErrorMessages.h"
#include "support/MachineMemory.h"

#include <algorithm>
#include <memory>
#include <new>

namespace rtsl::runtime {

namespace {

/// The size of a cache line. Nodes and items of trees are read 16 bytes at a time.
constexpr std::uint64_t alignment = 64;

class Flattener {
public:
  FlatScene take() {
    std::sort(flat.pointers.begin(), flat.pointers.end());
    return std::move(flat);
  }

  /// Adds a copy of an array; returns its offset from the start.
  template <typename Element>
  std::uint64_t add(const Element *elements, std::size_t count) {
    std::uint64_t start = (flat.bytes.size() + alignment - 1) / alignment * alignment;
    flat.bytes.resize(start + count * sizeof(Element));
    std::memcpy(flat.bytes.data() + start, elements, count * sizeof(Element));
    return start;
  }

  /// Adds an array and sets the pointer at `place` to it. An absent or empty array is null.
  template <typename Element>
  std::uint64_t addAt(std::uint64_t place, const Element *elements, std::size_t count) {
    std::uint64_t start = 0;
    if (elements && count) {
      start = add(elements, count);
      flat.pointers.push_back(place);
    }
    std::memcpy(flat.bytes.data() + place, &start, sizeof start);
    return start;
  }

  /// Makes room for buffers, which may be most of the memory. Throws OutOfMemory.
  void reserve(const std::vector<Scene::BufferPlace> &buffers) {
    std::uint64_t bytes = 0;
    for (const Scene::BufferPlace &buffer : buffers)
      bytes += buffer.bytes + alignment;
    try {
      flat.reservation = std::make_shared<const MemoryReservation>(bytes);
      flat.bytes.reserve(flat.bytes.size() + bytes);
    } catch (const std::bad_alloc &) {
      throw Error(message::noMemoryFor("a copy of the buffers", bytes));
    }
  }

  void addOutput(const FlatScene::Output &output) { flat.outputs.push_back(output); }

private:
  FlatScene flat;
};

} // namespace

static FlatScene flatten(const Scene &scene, const Bvh *bvh) {
  RtslLaunch launch = scene.launch();
  if (bvh)
    bvh->install(launch);

  Flattener flattener;
  flattener.add(&launch, 1);
  const std::uint64_t records =
      flattener.addAt(offsetof(RtslLaunch, records), launch.records, scene.recordBytes());
  flattener.addAt(offsetof(RtslLaunch, instances), launch.instances, launch.instanceCount);
  const std::uint64_t meshes =
      flattener.addAt(offsetof(RtslLaunch, meshes), launch.meshes, launch.meshCount);
  flattener.addAt(offsetof(RtslLaunch, meshAttributes), launch.meshAttributes,
                  launch.meshAttributeCount);
  flattener.addAt(offsetof(RtslLaunch, transforms), launch.transforms, launch.transformCount);
  const bool moves = launch.needs & RTSL_HAS_MOTION;
  flattener.addAt(offsetof(RtslLaunch, motions), launch.motions, moves ? launch.motionCount : 0);
  flattener.addAt(offsetof(RtslLaunch, motionFactors), launch.motionFactors,
                  moves ? launch.motionFactorCount : 0);
  flattener.addAt(offsetof(RtslLaunch, motionKeys), launch.motionKeys,
                  moves ? launch.motionKeyCount : 0);
  flattener.addAt(offsetof(RtslLaunch, boxes), launch.boxes, launch.boxCount);
  flattener.addAt(offsetof(RtslLaunch, selections), launch.selections, launch.selectionCount);
  flattener.addAt(offsetof(RtslLaunch, lights), launch.lights, launch.lightCount);
  flattener.addAt(offsetof(RtslLaunch, emitters), launch.emitters, launch.emitterCount);
  flattener.addAt(offsetof(RtslLaunch, partChances), launch.partChances, launch.partChanceCount);
  flattener.addAt(offsetof(RtslLaunch, lightNodes), launch.lightNodes, launch.lightNodeCount);
  flattener.addAt(offsetof(RtslLaunch, lightLeaves), launch.lightLeaves, launch.lightLeafCount);
  for (std::uint32_t i = 0; i < launch.meshCount; ++i) {
    const RtslMesh &mesh = launch.meshes[i];
    const std::uint64_t place = meshes + i * sizeof(RtslMesh);
    const std::size_t vertices = mesh.vertexCount, ofAllKeys = vertices * mesh.keyCount;
    flattener.addAt(place + offsetof(RtslMesh, positions), mesh.positions, 3 * ofAllKeys);
    flattener.addAt(place + offsetof(RtslMesh, normals), mesh.normals, 3 * ofAllKeys);
    flattener.addAt(place + offsetof(RtslMesh, keyTimes), mesh.keyTimes, mesh.keyCount);
    flattener.addAt(place + offsetof(RtslMesh, uvs), mesh.uvs, 2 * vertices);
    flattener.addAt(place + offsetof(RtslMesh, indices), mesh.indices,
                    3 * std::size_t(mesh.triangleCount));
    const std::uint64_t attributes =
        flattener.addAt(place + offsetof(RtslMesh, attributes), mesh.attributes,
                        mesh.attributes ? launch.meshAttributeCount : 0);
    for (std::uint32_t j = 0; mesh.attributes && j < launch.meshAttributeCount; ++j) {
      const RtslMeshValues &one = mesh.attributes[j];
      flattener.addAt(attributes + j * sizeof(RtslMeshValues) + offsetof(RtslMeshValues, values),
                      one.values,
                      launch.meshAttributes[j].words *
                          std::size_t(one.ofTriangles ? mesh.triangleCount : mesh.vertexCount));
    }
  }
  static_assert(offsetof(RtslBuffer, addressHigh) == offsetof(RtslBuffer, addressLow) + 4);
  const std::vector<Scene::BufferPlace> buffers = scene.buffers();
  flattener.reserve(buffers);
  for (const Scene::BufferPlace &buffer : buffers) {
    std::uint64_t elements;
    std::memcpy(&elements, launch.records + buffer.offset, sizeof elements);
    const std::uint64_t start = flattener.addAt(
        records + buffer.offset, reinterpret_cast<const std::uint8_t *>(elements), buffer.bytes);
    if (buffer.isOutput && buffer.bytes)
      flattener.addOutput({start, buffer.bytes, reinterpret_cast<std::uint8_t *>(elements)});
  }
  if (bvh) { // last: removeTrees()
    flattener.addAt(offsetof(RtslLaunch, nodes), launch.nodes, bvh->nodes.size());
    flattener.addAt(offsetof(RtslLaunch, treeItems), launch.treeItems, bvh->items.size());
    flattener.addAt(offsetof(RtslLaunch, meshTrees), launch.meshTrees, bvh->meshTrees.size());
  }
  return flattener.take();
}

FlatScene flatten(const Scene &scene) {
  return flatten(scene, nullptr);
}

FlatScene flatten(const Scene &scene, const Bvh &bvh) {
  return flatten(scene, &bvh);
}

} // namespace rtsl::runtime
