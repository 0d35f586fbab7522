//===- BuildMemory.h - the arrays of a build on a device ------------------===//
#pragma once

#include "runtime/accel/trees/ClusterTree.h"

#include <algorithm>
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

/// What sums of up to so many elements need.
inline void placeSums(device::build::TreeBuild &build, Block &block, std::size_t elements,
                      std::uint32_t lanes) {
  const std::uint32_t tiles = device::build::mostTiles(std::uint32_t(elements), lanes);
  block.place(build.calls, 2);
  for (std::uint64_t *&words : build.words)
    block.place(words, std::max<std::uint32_t>(tiles, 2));
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

  /// Before the first step that sums up to so many elements.
  void beginSums(std::size_t elements) {
    const std::uint32_t tiles = device::build::mostTiles(std::uint32_t(elements), device.lanes());
    run(BuildStep::BeginSums, std::max<std::uint32_t>(tiles, 2));
  }
  /// Runs a step that sums up to so many elements (runtime/device/trees/Sums.h). Its last number is
  /// that of the call.
  void sum(BuildStep step, std::uint32_t elements, std::uint32_t a) {
    run(step, threadsOfSums(elements), a, nextCall());
  }
  void sum(BuildStep step, std::uint32_t elements, std::uint32_t a, std::uint32_t b) {
    run(step, threadsOfSums(elements), a, b, nextCall());
  }
  /// The sum of all elements of the last call.
  std::uint64_t sumOfAll() {
    device::build::SumCall call;
    device.download(&call, addressOf(build.calls + (calls - 1) % 2), sizeof call);
    return call.sum;
  }

private:
  std::uint32_t threadsOfSums(std::uint32_t elements) const {
    return device::build::mostTiles(elements, device.lanes()) * device.lanes();
  }
  std::uint32_t nextCall() { return calls++ % 2; }

  BuildDevice &device;
  BuildDevice::Address start = 0, address = 0; // of the arrays, of the build
  std::uint32_t calls = 0;                     // that sum
};

} // namespace rtsl::runtime
