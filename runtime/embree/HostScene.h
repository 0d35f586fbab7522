//===- HostScene.h - the scene for rtsl_traverse on the host --------------===//
#pragma once

#include "runtime/accel/OwnTrees.h"
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

/// Trees of a scene that is gone, for another one that may have the same contents.
struct KeptTrees {
  std::unique_ptr<EmbreeScene> embree; // or null
  OwnTrees own;                        // if they are built
};

/// RtslLaunch::host points to one of these.
class HostScene : public ProgramHost {
public:
  /// `kept`: trees that follow to this scene if it has their contents.
  HostScene(const Scene &scene, bool useEmbree, unsigned threads, std::optional<TreeKind> tree = {},
            KeptTrees kept = {});

  /// The launch with our own tree. With Embree it is built on first use, such as for a ray that
  /// Embree cannot trace (EmbreeScene::canFollow).
  const RtslLaunch &deviceLaunch() const;

  /// Follows what has moved in the scene since the trees were built, or since the last call. Trees
  /// keep their shapes, unless they have become bad (runtime/accel/Refit.h) or instances were
  /// added. Not while rays are traced.
  void update();

  /// How many rays a thread should trace in turns: EmbreeScene::raysInTurns.
  unsigned raysInTurns() const { return embree ? embree->raysInTurns() : 1; }

  /// Has our own tree been built?
  bool hasOwnTree() const { return launch.host != nullptr; }

  /// The figures of our own tree, if it has been built.
  const std::optional<TreeFigures> &treeFigures() const { return own.treeFigures(); }

  /// Have the trees that were passed to the constructor been kept, updated to this scene if
  /// anything had moved?
  bool isRefitted() const { return refitted; }
  /// Gives the trees away. Nothing can be traced any more.
  KeptTrees takeTrees();

  /// rtsl_traverse.
  std::uint32_t traverse(RtslState &state, std::uint32_t how) const;
  /// The same, inline for HostTraversal.cpp only.
  std::uint32_t traverseFast(RtslState &state, std::uint32_t how) const;

private:
  void buildEmbree(std::unique_ptr<EmbreeScene> kept = nullptr);
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
  bool refitted = false;
  mutable std::once_flag built;
  mutable OwnTrees own;
  mutable RtslLaunch launch{};
};

} // namespace rtsl::runtime
