//===- EmbreeCallbacks.h - tests of what a ray of Embree reaches ----------===//
#pragma once

#include <embree3/rtcore.h>

namespace rtsl::runtime {

/// What Embree calls when a ray reaches the box of an item: to find the nearest hit, and to find
/// any. Rays bring an EmbreeContext with them.
struct SearchCallbacks {
  RTCIntersectFunctionN intersect;
  RTCOccludedFunctionN occluded;
};

/// The callbacks of items of a space (EmbreeSpace.h), which is the world or one that rays are
/// transformed to.
SearchCallbacks primitiveCallbacks(bool isWorld);
/// The callbacks of instances of other spaces, in the world.
SearchCallbacks instanceCallbacks();

} // namespace rtsl::runtime
