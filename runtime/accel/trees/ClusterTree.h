//===- ClusterTree.h - trees built by many threads, on any device ---------===//
//
// The order of the steps of runtime/device/trees, which are functions for each element or warp. On
// a CPU and on a GPU they give the same tree, bit for bit.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/trees/TreeBuild.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

enum class BuildStep : std::uint8_t {
#define RTSL_BUILD_STEP(name, call) name,
#include "runtime/device/trees/Steps.def"
};

/// What runs the steps of a build, one after the other, and has the memory for it.
class BuildDevice {
public:
  using Address = std::uint64_t;

  virtual ~BuildDevice() = default;
  /// The memory belongs to the device. `what` is for messages.
  virtual Address allocate(std::size_t bytes, const char *what) = 0;
  virtual void release(Address address) = 0;
  virtual void upload(Address to, const void *from, std::size_t bytes) = 0;
  virtual void download(void *to, Address from, std::size_t bytes) = 0;
  virtual void copy(Address to, Address from, std::size_t bytes) = 0; // within the device
  /// The lanes of a warp.
  virtual std::uint32_t lanes() const = 0;
  /// Runs a step of the build at an address for threads 0 to count - 1, with these numbers.
  virtual void run(BuildStep step, Address build, std::uint32_t count, std::uint32_t a = 0,
                   std::uint32_t b = 0, std::uint32_t c = 0) = 0;
  /// Until all steps are done.
  virtual void wait() = 0;
};

/// A tree in the memory of a device; its nodes begin with the root, and its items with 0.
struct ClusterTree {
  BuildDevice::Address nodes = 0, items = 0, contents = 0;
  std::uint32_t nodeCount = 0, itemCount = 0;
  float cost = 0; // as WideTree::cost
};

/// Builds the tree of items, at least one. `items` and what it points to are in the device's
/// memory; if its launch is null, the boxes are those given, in this process, and the tree has no
/// items, only their numbers in `contents`. Throws OutOfMemory, and what the device throws.
ClusterTree buildClusterTree(BuildDevice &device, const device::build::Items &items,
                             const RtslBox *boxes = nullptr);

/// Adds to the first nodes and items of nodes on a device.
void moveNodes(BuildDevice &device, BuildDevice::Address nodes, std::uint32_t count,
               std::uint32_t firstNode, std::uint32_t firstItem);

} // namespace rtsl::runtime
