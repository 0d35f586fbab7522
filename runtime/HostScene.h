//===- HostScene.h - what rtsl_traverse of the host works on --------------===//
#pragma once

#include "runtime/BvhBuilder.h"
#include "runtime/EmbreeScene.h"
#include "runtime/ProgramHost.h"

#include <cstdint>
#include <memory>
#include <mutex>

namespace rtsl::runtime {

/// Events of one thread's rays, all of them rare.
struct RayCounters {
  std::uint64_t badRays = 0, retracedRays = 0, rescaledRays = 0;
};

/// This thread's counters.
RayCounters &rayCounters();

/// RtslLaunch::host points to one of these.
class HostScene : public ProgramHost {
public:
  HostScene(const Scene &scene, bool useEmbree, unsigned threads);

  /// The launch with our own tree; with Embree it is built when the first ray needs it.
  const RtslLaunch &deviceLaunch() const;

  /// rtsl_traverse.
  std::uint32_t traverse(RtslState &state, std::uint32_t how) const;
  /// The same, inline in HostTraversal.cpp alone.
  std::uint32_t traverseFast(RtslState &state, std::uint32_t how) const;

private:
  std::uint32_t traverseCarefully(RtslState &state, bool anyHit) const;
  std::uint32_t traverseOurselves(RtslState &state, std::uint32_t how) const;
  template <typename Work>
  std::uint32_t withNodes(RtslState &state, Work work) const;
  std::uint32_t retrace(RtslState &state, bool anyHit, float distance) const;

  const Scene &scene;
  std::unique_ptr<EmbreeScene> embree; // null: our own traversal
  mutable std::once_flag built;
  mutable Bvh bvh;
  mutable RtslLaunch launch{};
};

} // namespace rtsl::runtime
