//===- EmbreeContext.h - what a search needs beside Embree's ray ----------===//
#pragma once

#include "runtime/device/traverse/TestItem.h"
#include "runtime/embree/EmbreeScene.h"
#include "runtime/embree/EmbreeSpace.h"
#include "runtime/embree/LastOccluders.h"

#include <embree3/rtcore.h>

namespace rtsl::runtime {

/// Embree's context of a ray, followed by the data for our callbacks.
struct EmbreeContext {
  mutable RTCIntersectContext embree; // Embree does not change it, but takes it as if it did
  RtslState *state;
  const device::TriangleRay *ray; // in `space`; an InstanceRay if that is not the world
  const EmbreeSpace *space;
  const EmbreeVisitor *visitor; // null: candidates are tested, and committed if they win
  bool seesAll;                 // the ray sees all instances
  bool endsIfHidden;            // the search is device::towardsPoint
  float toEmbree;               // a power of two that turns our t into Embree's
  // what was hit, if any hit was sufficient, or hides the point that the ray goes towards
  mutable Occluder occluder;
  Occluder tested;        // before the search, in the world
  mutable Occluder found; // what has won so far, in the world

  /// Where Embree's search may end, if hits beyond t do not matter.
  float end(float t) const { return t * toEmbree * device::cullSlack; }
  /// Hits beyond it do not matter.
  float limit() const { return visitor ? visitor->limit(visitor->self) : state->nearest; }

  /// The ray, which is an InstanceRay in any space but the world.
  template <typename Ray>
  const Ray &rayAs() const {
    return static_cast<const Ray &>(*ray);
  }

  /// Passes an item to the visitor. True if the search is over.
  bool visitItem(const RtslLeafItem &item) const {
    return visitor->visit(visitor->self, item,
                          space->isWorld ? nullptr : &rayAs<device::InstanceRay>());
  }

  /// Has it been tested before the search?
  bool isTested(const Occluder &item) const { return __builtin_expect(tested == item, 0); }

  /// Does the search end at a hit that was committed? `by`: what was hit.
  bool endsAtHit(const Occluder &by) const {
    if (!endsIfHidden || !device::isPointHidden(*state))
      return false;
    occluder = by;
    return true;
  }
};

} // namespace rtsl::runtime
