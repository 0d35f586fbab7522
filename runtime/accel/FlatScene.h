//===- FlatScene.h - a scene as one block of bytes ------------------------===//
//
// Everything that an RtslLaunch points to, the launch first: records, tables, the tree, meshes,
// buffers. Pointers contain offsets from the start; the scene can be used at any address, in the
// memory of this process or of a GPU, after the address was added to them.
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "support/MachineMemory.h"

#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

namespace rtsl::runtime {

class Scene;
struct Bvh;

struct FlatScene {
  std::vector<std::uint8_t> bytes;
  /// The positions of the pointers, in bytes from the start and ascending. Each is 64 bits wide,
  /// with an alignment of 4; null pointers are not included.
  std::vector<std::uint64_t> pointers;
  /// The elements of the output buffers: where they lie here, and in the scene.
  struct Output {
    std::uint64_t offset, bytes;
    std::uint8_t *elements;
  };
  std::vector<Output> outputs;
  std::shared_ptr<const MemoryReservation> reservation; // of the buffers

  RtslLaunch launch() const {
    RtslLaunch launch;
    std::memcpy(&launch, bytes.data(), sizeof launch);
    return launch;
  }
  void setLaunch(const RtslLaunch &launch) { std::memcpy(bytes.data(), &launch, sizeof launch); }

  bool hasTrees() const { return launch().nodeCount != 0; }
  /// Removes the trees. To be called before relocate().
  void removeTrees();

  /// Sets the pointers for a scene at `address`, which is a multiple of 64.
  void relocate(std::uint64_t address) {
    for (std::uint64_t place : pointers) {
      std::uint64_t pointer;
      std::memcpy(&pointer, bytes.data() + place, sizeof pointer);
      pointer += address;
      std::memcpy(bytes.data() + place, &pointer, sizeof pointer);
    }
  }
};

/// The scene, without trees. Width, height, depth and seed of its launch are 0, and nothing depends
/// on addresses: the same scene gives the same bytes. Throws OutOfMemory.
FlatScene flatten(const Scene &scene);

/// The same with trees for the device traversal, at its end. They depend on the scene alone, too.
FlatScene flatten(const Scene &scene, const Bvh &bvh);

} // namespace rtsl::runtime
