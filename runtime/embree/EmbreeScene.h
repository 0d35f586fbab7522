//===- EmbreeScene.h - a scene for the host, and rays through it ----------===//
//
// Trees find the boxes that a ray meets; their contents are tested by the same functions as in the
// tree of the device traversal, so that both find the same hits, bit for bit. Triangles that do not
// move are in a tree of our own, eight in a block (runtime/accel/BlockTree.h). Embree's triangles
// are not suitable: near edges, between coincident triangles and for needles its test depends on
// its own rounding; and as Embree's user geometry blocks are slower to reach. RTSL primitives are
// user geometry of Embree, and so are instances with transforms of meshes and of objects with
// several primitives: these have trees of their own, which the ray in object space is traced
// through from a callback. Where there are few of both, they are tested without a tree
// (ItemList.h), and Embree has none.
//
// Embree's box test has rounding errors that depend on the distance of a ray's origin. Boxes are
// enlarged for origins up to some distance; for others there is another tree over the same items,
// built when the first such ray is traced.
//
// Some distributions build Embree with assertions: a ray that is not finite, or whose direction is
// too long, would end the process, and short directions give wrong hits. So rays are checked, and
// directions scaled by powers of two, which does not change the result.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/State.h"
#include "runtime/device/traverse/Instance.h"
#include "runtime/device/traverse/Triangle.h"
#include "runtime/scene/Scene.h"

#include <cstdint>
#include <memory>

namespace rtsl::runtime {

/// Processes all items that a ray may hit.
struct EmbreeVisitor {
  // `entered`: the ray in the space of the item, if that is not the world. True: the search is over
  bool (*visit)(void *self, const RtslLeafItem &item, const device::InstanceRay *entered);
  float (*limit)(void *self); // hits beyond it do not matter
  void *self;
};

class EmbreeScene {
public:
  /// Builds the trees. Throws OutOfMemory, Internal.
  EmbreeScene(const Scene &scene, const Program::Slots &slots, unsigned threads);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene &) = delete;
  EmbreeScene &operator=(const EmbreeScene &) = delete;

  /// Can Embree trace the ray of `state`, which must be good (device::isGoodRay)?
  static bool canFollow(const RtslState &state);
  /// The same for any finite ray.
  static bool canFollow(device::Vec3 origin, device::Vec3 direction);

  /// rtsl_traverse for a ray that canFollow accepts. It sees all instances, and they accept all
  /// hits. `how` is as for rtsl_traverse.
  std::uint32_t traverse(RtslState &state, std::uint32_t how) const;

  /// The same for a ray that isEasy. In EmbreeRay.h.
  std::uint32_t traverseEasy(RtslState &state, std::uint32_t how) const;

  /// How many rays a thread should trace in turns (support/Fibers.h), so that some go on while
  /// others wait for memory. At least 1.
  unsigned raysInTurns() const;

  /// Calls `visitor` for items that the ray may hit. canFollow must accept the ray.
  void visit(RtslState &state, const device::TriangleRay &ray, const EmbreeVisitor &visitor) const;

  /// Follows positions and transforms of the scene that have changed since it was built, or since
  /// the last call. Not while rays are traced.
  void update(const Scene &scene, unsigned threads);

  /// To be called before the scene is destroyed: stores the boxes by which follow() finds what has
  /// moved.
  void rememberBoxes();
  /// The same for another scene, after rememberBoxes(). False if it has other contents
  /// (TreeContents.h): nothing may be traced then.
  bool follow(const Scene &scene, const Program::Slots &slots, unsigned threads);

  struct Implementation;

  /// Is the ray of `state` good, and can Embree trace it unscaled? Nearly always true, and fast
  /// then.
  static bool isEasy(const RtslState &state) {
    return state.isEasy ||
           (needsNoScaling(device::load(state.RayOrigin), device::load(state.RayDirection)) &&
            state.Epsilon >= 0 && state.HitDistance == state.HitDistance);
  }

  /// Can Embree trace the ray as it is?
  static bool needsNoScaling(device::Vec3 origin, device::Vec3 direction) {
    auto sum = [](device::Vec3 v) {
      return __builtin_fabsf(v.x) + __builtin_fabsf(v.y) + __builtin_fabsf(v.z);
    };
    // Sums with NaN compare false, and infinite ones are too large.
    float length = sum(direction);
    return sum(origin) < largestOrigin && length < longest && length > 3 * shortest;
  }

private:
  /// Beyond this Embree's arithmetic on the origin would overflow.
  static constexpr float largestOrigin = 1e18f;
  /// Lengths of directions that Embree handles correctly, with a margin on both sides.
  static constexpr float shortest = 0x1p-20f, longest = 0x1p20f;
  /// Beyond these the powers of two for scaling or their inverses would not be exact.
  static constexpr int largestExponent = 100;

  std::unique_ptr<Implementation> self;
};

/// A tree for runtime/device/traverse/Traverse.h and AnyHit.h.
struct EmbreeTree {
  const EmbreeScene &scene;

  template <typename Limit, typename Enter, typename Visit>
  void forEach(RtslState &state, const device::TriangleRay &ray, Limit limit, Enter,
               Visit visit) const {
    struct Search {
      const device::TriangleRay &ray;
      Limit &limit;
      Visit &visit;
    } search{ray, limit, visit};
    EmbreeVisitor visitor{
        [](void *self, const RtslLeafItem &item, const device::InstanceRay *entered) {
          auto &search = *static_cast<Search *>(self);
          return entered ? search.visit(item, *entered) : search.visit(item, search.ray);
        },
        [](void *self) { return static_cast<Search *>(self)->limit(); }, &search};
    scene.visit(state, ray, visitor);
  }
};

} // namespace rtsl::runtime
