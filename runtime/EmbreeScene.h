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

  /// The same for a ray that isEasy. In EmbreeRay.h.
  EmbreeAnswer traverseEasy(RtslState &state, bool anyHit) const;

  struct Implementation;

  /// Is the ray of `state` good, and can Embree take it as it is? Most are; the test is made for
  /// them.
  static bool isEasy(const RtslState &state) {
    if (state.isEasy)
      return true;
    const float *o = state.RayOrigin, *d = state.RayDirection;
    auto sum = [](const float *v) {
      return __builtin_fabsf(v[0]) + __builtin_fabsf(v[1]) + __builtin_fabsf(v[2]);
    };
    // The sums of what is no number compare false, and infinite ones are too large.
    float length = sum(d);
    return sum(o) < largestOrigin && length < longest && length > 3 * shortest &&
           state.Epsilon >= 0 && state.HitDistance == state.HitDistance;
  }

private:
  /// Beyond this Embree's arithmetic on the origin would overflow.
  static constexpr float largestOrigin = 1e18f;
  /// Lengths of directions for which Embree works as it should, with room on both sides.
  static constexpr float shortest = 0x1p-20f, longest = 0x1p20f;

  std::unique_ptr<Implementation> self;
};

} // namespace rtsl::runtime
