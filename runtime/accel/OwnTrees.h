//===- OwnTrees.h - our own trees of a scene, which follow what moves -----===//
#pragma once

#include "runtime/accel/BvhBuilder.h"
#include "runtime/accel/TreeContents.h"

#include <optional>
#include <vector>

namespace rtsl::runtime {

class OwnTrees {
public:
  /// Empty before they are built.
  const Bvh &trees() const { return bvh; }
  const std::optional<TreeFigures> &treeFigures() const { return figures; }

  /// Makes the trees those of `launch`: they keep their shapes if it has the same contents, and if
  /// the expected cost of a ray has not grown too much (Refit.h); otherwise they are built anew.
  /// The pointers of the launch must be valid here. `threads` 0: one per core; `kind` nothing:
  /// treeKind decides.
  void follow(const RtslLaunch &launch, unsigned threads, std::optional<TreeKind> kind);

private:
  void build(const RtslLaunch &launch, unsigned threads, std::optional<TreeKind> kind);

  Bvh bvh;
  std::vector<InstanceContents> contents;
  std::vector<double> costsWhenBuilt; // once they have followed
  std::optional<TreeFigures> figures;
};

} // namespace rtsl::runtime
