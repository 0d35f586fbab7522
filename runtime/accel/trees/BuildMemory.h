//===- BuildMemory.h - the arrays of a build on a device ------------------===//
#pragma once

#include "runtime/accel/trees/ClusterTree.h"

#include <cstddef>
#include <cstdint>

namespace rtsl::runtime {

/// Arrays in one block of memory.
class Block {
public:
  explicit Block(BuildDevice::Address start = 0) : start(start) {}

  template <typename Element>
  void place(Element *&array, std::size_t count) {
    array = reinterpret_cast<Element *>(start + bytes);
    bytes += (count * sizeof(Element) + 255) / 256 * 256;
  }
  std::size_t size() const { return bytes; }

private:
  BuildDevice::Address start;
  std::size_t bytes = 0;
};

template <typename Element>
BuildDevice::Address addressOf(Element *element) {
  return reinterpret_cast<BuildDevice::Address>(element);
}

/// Places TreeBuild::sums, for so many elements, and sumsOfTiles.
inline void placeSums(device::build::TreeBuild &build, Block &block, std::size_t elements) {
  block.place(build.sums, elements);
  block.place(build.sumsOfTiles, device::build::tileCount(std::uint32_t(elements)) + 1);
}

/// A build and its arrays in the memory of a device, on which its steps run.
class BuildMemory {
public:
  /// `place(build, block)` places the arrays. Throws OutOfMemory.
  template <typename Place>
  BuildMemory(BuildDevice &device, const device::build::TreeBuild &begun, Place place)
      : build(begun), device(device) {
    Block measured;
    place(build, measured);
    start = device.allocate(measured.size() + sizeof build, "building the tree");
    Block block(start);
    place(build, block);
    address = start + block.size();
    upload();
  }
  ~BuildMemory() { device.release(start); }
  BuildMemory(const BuildMemory &) = delete;
  BuildMemory &operator=(const BuildMemory &) = delete;

  device::build::TreeBuild build;
  /// After `build` has changed.
  void upload() { device.upload(address, &build, sizeof build); }

  void run(BuildStep step, std::uint32_t count, std::uint32_t a = 0, std::uint32_t b = 0,
           std::uint32_t c = 0) {
    device.run(step, address, count, a, b, c);
  }

  /// Replaces each of the first elements of TreeBuild::sums by the sum of all before it.
  void sumBefore(std::uint32_t elements) {
    const std::uint32_t tiles = device::build::tileCount(elements), lanes = device.lanes();
    run(BuildStep::SumTile, tiles * lanes, elements);
    run(BuildStep::SumTilesBefore, lanes, tiles);
    run(BuildStep::SumElementsBefore, tiles * lanes, elements);
    total = addressOf(build.sumsOfTiles + tiles);
  }
  /// The last sum of all.
  std::uint64_t sumOfAll() {
    std::uint64_t sum = 0;
    device.download(&sum, total, sizeof sum);
    return sum;
  }

private:
  BuildDevice &device;
  BuildDevice::Address start = 0, address = 0; // of the arrays, of the build
  BuildDevice::Address total = 0;
};

} // namespace rtsl::runtime
