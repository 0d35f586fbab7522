//===- HostScene.h - the scene for rtsl_traverse on the host --------------===//
#pragma once

#include "runtime/accel/BvhBuilder.h"
#include "runtime/embree/EmbreeScene.h"
#include "runtime/program/ProgramHost.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

namespace rtsl::runtime {

/// Rare events of one thread's rays.
struct RayCounters {
  std::uint64_t badRays = 0, retracedRays = 0, rescaledRays = 0;
};

/// This thread's counters.
RayCounters &rayCounters();

/// RtslLaunch::host points to one of these.
class HostScene : public ProgramHost {
public:
  HostScene(const Scene &scene, bool useEmbree, unsigned threads,
            std::optional<TreeKind> tree = {});

  /// The launch with our own tree. With Embree it is built on first use, such as for a ray that
  /// Embree cannot trace (EmbreeScene::canFollow).
  const RtslLaunch &deviceLaunch() const;

  /// Follows what has moved in the scene since the trees were built, or since the last call. Trees
  /// keep their shapes, unless they have become bad (runtime/accel/Refit.h) or instances were
  /// added. Not while rays are traced.
  void update();

  /// Has our own tree been built?
  bool hasOwnTree() const { return launch.host != nullptr; }

  /// Of our own tree, if it has been built.
  const std::optional<TreeFigures> &treeFigures() const { return figures; }

  /// rtsl_traverse.
  std::uint32_t traverse(RtslState &state, std::uint32_t how) const;
  /// The same, inline for HostTraversal.cpp only.
  std::uint32_t traverseFast(RtslState &state, std::uint32_t how) const;

private:
  void buildEmbree();
  void buildOwnTree() const;
  std::uint32_t traverseAny(RtslState &state, std::uint32_t how) const;
  template <typename Tree>
  std::uint32_t search(RtslState &state, std::uint32_t how, const Tree &tree) const;
  std::uint32_t searchOwnTree(RtslState &state, std::uint32_t how) const;

  const Scene &scene;
  const unsigned threads;
  const std::optional<TreeKind> tree;
  std::unique_ptr<EmbreeScene> embree; // null: our own traversal
  // the same, if rays with the usual mask and root see all instances
  const EmbreeScene *seenByAll = nullptr;
  std::uint64_t structure, moves; // of the scene, as the trees are
  mutable std::once_flag built;
  mutable Bvh bvh;
  mutable std::vector<double> costsWhenBuilt; // of `bvh`
  mutable std::optional<TreeFigures> figures;
  mutable RtslLaunch launch{};
};

} // namespace rtsl::runtime
