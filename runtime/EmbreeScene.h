//===- EmbreeScene.h - a scene in Embree, and rays through it -------------===//
//
// Triangle meshes are Embree's own triangles, RTSL primitives its user geometry. Embree is built
// with assertions by some distributions: a ray that is not finite, or whose direction is too long,
// would end the process, and short directions give wrong hits. So rays are checked, and directions
// scaled by powers of two, which changes no bit of what comes out.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/Scene.h"
#include "runtime/device/Abi.h"

#include <cstdint>
#include <memory>

namespace rtsl::runtime {

/// Embree's answer for a ray.
enum class EmbreeAnswer : std::uint8_t {
  Miss,
  Hit,     // committed to the state
  Refused, // our own traversal is to be asked
};

class EmbreeScene {
public:
  /// Builds. Throws OutOfMemory, Internal.
  EmbreeScene(const Scene &scene, const Program::Slots &slots, unsigned threads);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene &) = delete;
  EmbreeScene &operator=(const EmbreeScene &) = delete;

  /// The ray of `state` must be good (device::isGoodRay) and have no hit yet.
  EmbreeAnswer traverse(RtslState &state, bool anyHit) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> self;
};

} // namespace rtsl::runtime
