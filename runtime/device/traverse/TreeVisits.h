//===- TreeVisits.h - counts what searches of a tree visit ----------------===//
//
// How good a tree is for the rays of a scene. Programs that do not count have no code for it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

/// Counts the visits of one search below one root. Destroying it adds them to RtslStatus::visits.
class TreeVisits {
public:
  TreeVisits(const RtslLaunch &launch, uint32_t root) : launch(launch), root(root) {}
  TreeVisits(const TreeVisits &) = delete;
  TreeVisits &operator=(const TreeVisits &) = delete;

  ~TreeVisits() {
    if (!rtsl_counts_steps(&launch) || !launch.status)
      return;
    RtslTreeVisits &all = launch.status->visits;
    __atomic_fetch_add(&all.rays, uint64_t(root == 0), __ATOMIC_RELAXED);
    __atomic_fetch_add(&all.nodes, uint64_t(nodes), __ATOMIC_RELAXED);
    __atomic_fetch_add(&all.items, uint64_t(items), __ATOMIC_RELAXED);
  }

  void node() { ++nodes; }
  void item() { ++items; }

private:
  const RtslLaunch &launch;
  const uint32_t root;
  uint32_t nodes = 0, items = 0;
};

} // namespace rtsl::device
