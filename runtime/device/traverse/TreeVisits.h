//===- TreeVisits.h - counts what searches of a tree visit ----------------===//
//
// How good a tree is for the rays of a scene. Programs that do not count have no code for it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"

namespace rtsl::device {

/// Counts the visits of one search. Destroying it adds them to RtslStatus::visits.
class TreeVisits {
public:
  explicit TreeVisits(const RtslLaunch &launch) : launch(launch) {}
  TreeVisits(const TreeVisits &) = delete;
  TreeVisits &operator=(const TreeVisits &) = delete;

  ~TreeVisits() {
    if (!rtsl_counts_steps(&launch) || !launch.status)
      return;
    RtslTreeVisits &all = launch.status->visits;
    __atomic_fetch_add(&all.rays, uint64_t(1), __ATOMIC_RELAXED);
    __atomic_fetch_add(&all.nodes, uint64_t(nodes), __ATOMIC_RELAXED);
    __atomic_fetch_add(&all.items, uint64_t(items), __ATOMIC_RELAXED);
  }

  void node() { ++nodes; }
  void item() { ++items; }

private:
  const RtslLaunch &launch;
  uint32_t nodes = 0, items = 0;
};

} // namespace rtsl::device
