//===- DeviceTrees.h - the trees of a scene, built where it is ------------===//
#pragma once

#include "runtime/accel/Refit.h"
#include "runtime/accel/TreeContents.h"
#include "runtime/accel/TreeKind.h"

#include <memory>
#include <optional>
#include <vector>

namespace rtsl::runtime {

/// RtslLaunch::nodes, treeItems, meshTrees and nodeCount in the memory of a device, which follow
/// what moves, as OwnTrees do in the memory of this process.
class DeviceTrees {
public:
  explicit DeviceTrees(std::unique_ptr<BuildDevice> device);
  ~DeviceTrees();
  DeviceTrees(const DeviceTrees &) = delete;
  DeviceTrees &operator=(const DeviceTrees &) = delete;

  /// Makes the trees those of a scene, which is `there` on the device; its launch with pointers
  /// that are valid in this process is `here`. They keep their shapes if the scene has the same
  /// contents as the one before, and if the expected cost of a ray has not grown too much
  /// (Refit.h); otherwise they are built anew: fast trees of many items on the device, others in
  /// this process, because the device runs steps for each level of a tree, and a small tree has too
  /// few items for its threads. `threads` 0: one per core; `kind` nothing: treeKind decides. Throws
  /// OutOfMemory, and what the device throws.
  void follow(const RtslLaunch &here, BuildDevice::Address there, unsigned threads,
              std::optional<TreeKind> kind);

  const TreeFigures &treeFigures() const { return figures; }
  /// Installs the trees in a launch, which must not outlive them.
  void install(RtslLaunch &launch) const;

private:
  bool refit(const RtslLaunch &here, BuildDevice::Address there);
  void build(const RtslLaunch &here, BuildDevice::Address there, unsigned threads,
             std::optional<TreeKind> kind);
  void release();

  const std::unique_ptr<BuildDevice> device;
  TreesThere trees;
  BuildDevice::Address meshTrees = 0; // 0: none
  TreeFigures figures;
  std::optional<std::vector<InstanceContents>> contents; // nothing: there are no trees
  std::unique_ptr<Refit> refitted;                       // once they have followed
  std::vector<double> costsWhenBuilt;                    // likewise
};

/// The trees of a picture for the next one, by device; null: there are none.
using KeptDeviceTrees = std::vector<std::shared_ptr<DeviceTrees>>;

} // namespace rtsl::runtime
