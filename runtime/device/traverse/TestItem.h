//===- TestItem.h - tests of triangles and RTSL primitives ----------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Hit.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/traverse/Bvh.h"
#include "runtime/device/traverse/Candidate.h"
#include "runtime/device/traverse/ModerateRay.h"
#include "runtime/device/traverse/Selector.h"
#include "runtime/device/traverse/Triangle.h"

namespace rtsl::device {

/// Is the instance visible to the ray?
template <typename Slots>
bool isSeen(RtslState &state, const RtslInstance &instance, const Slots &slots) {
  const bool isBelowRoot = rtsl_needs(state.launch) & RTSL_HAS_ROOTS
                               ? uint32_t(state.rayRoot) < 32 &&
                                     (instance.roots >> (uint32_t(state.rayRoot) & 31) & 1) != 0
                               : state.rayRoot == 0;
  const uint32_t mask = rtsl_needs(state.launch) & RTSL_HAS_MASKS ? instance.mask : ~0u;
  return isBelowRoot && (mask & state.rayMask) && isSelected(state, instance, slots);
}

/// The same for an item with the ray in its space: an instance that the ray has entered is seen.
template <typename Slots>
bool isSeen(RtslState &state, const RtslLeafItem &item, const TriangleRay &, const Slots &slots) {
  return isSeen(state, instanceAt(*state.launch, item.instance), slots);
}
template <typename Slots>
bool isSeen(RtslState &, const RtslLeafItem &, const InstanceRay &, const Slots &) {
  return true;
}
template <typename Slots>
bool isSeen(RtslState &state, const RtslLeafItem &item, const SearchRay &ray, const Slots &slots) {
  return !ray.isInWorld() || isSeen(state, instanceAt(*state.launch, item.instance), slots);
}

/// Have the primitives of the instance boxes in its own space? Then they are tested with the ray
/// that has entered it.
inline bool hasOwnSpace(const RtslLaunch &launch, const RtslInstance &instance) {
  return isTransformed(launch, instance) &&
         (instance.primitive == 0 || isCounted(launch, instance));
}

/// The number of the tree of such an instance in RtslLaunch::meshTrees.
inline uint32_t treeNumber(const RtslLaunch &launch, const RtslInstance &instance) {
  return instance.primitive == 0 ? instance.mesh : launch.meshCount + instance.mesh;
}

struct TriangleVertices {
  Vec3 v0, v1, v2;
};

/// The vertices in a mesh that does not move, or at its first key.
inline TriangleVertices triangleVertices(const RtslMesh &mesh, uint32_t triangle) {
  const uint32_t *index = mesh.indices + 3 * size_t(triangle);
  return {load(mesh.positions + 3 * size_t(index[0])), load(mesh.positions + 3 * size_t(index[1])),
          load(mesh.positions + 3 * size_t(index[2]))};
}
inline TriangleVertices triangleVertices(const RtslLaunch &launch, const RtslMesh &mesh,
                                         uint32_t triangle, float time) {
  if (!moves(launch, mesh))
    return triangleVertices(mesh, triangle);
  time = timeInShutter(launch, time);
  const uint32_t *index = mesh.indices + 3 * size_t(triangle);
  return {vertexAt(mesh, mesh.positions, index[0], time),
          vertexAt(mesh, mesh.positions, index[1], time),
          vertexAt(mesh, mesh.positions, index[2], time)};
}

/// The vertices of the triangle of state's hit. On the host they are in a cache if they are read
/// where the traversal has just read them; those of the mesh, of which three indices must be loaded
/// first, often are in none.
inline TriangleVertices verticesOfHit(const RtslState &state, const RtslMesh &mesh) {
#ifndef __NVPTX__
  if (const float *vertices = state.vertices) {
    const auto vertex = [&](int i) -> Vec3 {
      const float *at = vertices + 3 * i * RTSL_VERTEX_STRIDE;
      return {at[0], at[RTSL_VERTEX_STRIDE], at[2 * RTSL_VERTEX_STRIDE]};
    };
    return {vertex(0), vertex(1), vertex(2)};
  }
#endif
  return triangleVertices(*state.launch, mesh, state.primitive, state.Time);
}

/// The words of an item of the tree.
struct ItemWords {
  Words words[3];

  explicit ItemWords(const RtslTreeItem &item)
      : words{wordsAt(&item, 0), wordsAt(&item, 1), wordsAt(&item, 2)} {}

  uint32_t word(int i) const { return words[i / 4].word[i % 4]; }
  Vec3 vertex(int i) const {
    return {floatOf(word(3 * i)), floatOf(word(3 * i + 1)), floatOf(word(3 * i + 2))};
  }
  RtslLeafItem leafItem() const { return {word(9), word(10)}; }
  bool hasVertices() const { return word(11) != 0; }
};
static_assert(offsetof(RtslTreeItem, instance) == 36 && offsetof(RtslTreeItem, primitive) == 40 &&
              offsetof(RtslTreeItem, hasVertices) == 44 && sizeof(RtslTreeItem) == 48);

/// An item of the tree, of the instance that the ray is in.
struct TreeItem : RtslLeafItem {
  ItemWords stored;

  TriangleVertices vertices() const {
    return {stored.vertex(0), stored.vertex(1), stored.vertex(2)};
  }
};

/// Has the scene triangles alone, of meshes that do not move? Then all items of the trees of meshes
/// have vertices, and those of the world's tree unless they are instances to be entered.
inline bool hasStillTrianglesAlone(const RtslLaunch &launch) {
  return !rtsl_has_primitives() && !(rtsl_needs(&launch) & RTSL_HAS_MESH_KEYS);
}

/// Has the item, which is found with the ray in its space, vertices?
inline bool hasVertices(const RtslLaunch &launch, const TreeItem &item) {
  return hasStillTrianglesAlone(launch) || item.stored.hasVertices();
}

/// Moves t, where intersectTriangle has found a hit, into the range of the ray in the triangle's
/// box, within rangeShare. False if the ray misses the box: then it does in every traversal.
inline bool moveIntoBox(const TriangleRay &ray, const TriangleVertices &p, float &t) {
  float lower[3], upper[3];
  for (int i = 0; i < 3; ++i) {
    float a = p.v0[i], b = p.v1[i], c = p.v2[i];
    lower[i] = lowered(lowered(a, b), c);
    upper[i] = raised(raised(a, b), c);
  }
  Range range = rangeInBox(lower, upper, ray.origin, ray.inverse, 0, infinity);
  if (range.isEmpty())
    return false;
  t = movedInto(range.widened(), t);
  return true;
}

/// Are the back faces of the instance, a mesh, left out?
inline bool hasNoBacks(const RtslLaunch &launch, uint32_t instance) {
  return (rtsl_needs(&launch) & RTSL_HAS_NO_BACKS) != 0 &&
         (instanceAt(launch, instance).needs & RTSL_HAS_NO_BACKS) != 0;
}

/// Tests one triangle and commits it if it wins and isSeen(), which is called only then. `Ray` is a
/// TriangleRay in world space or an InstanceRay.
template <typename Ray, typename Seen>
bool testTriangle(RtslState &state, const Ray &ray, const TriangleVertices &vertices,
                  uint32_t instance, uint32_t triangle, Seen isSeen) {
  TriangleHit hit;
  if (!intersectTriangle(ray, vertices.v0, vertices.v1, vertices.v2, hit) ||
      !moveIntoBox(ray, vertices, hit.t))
    return false;
  hit.t = moveIntoInstance(ray, hit.t);
  if (!(hit.t > state.Epsilon) || !wins(state, hit.t, instance, triangle) ||
      (hit.isBack && hasNoBacks(*state.launch, instance)) || !isSeen())
    return false;
  commit(state, hit.t, hit.t, instance, triangle);
  state.u = hit.u;
  state.v = hit.v;
  return true;
}

template <typename Ray>
bool testTriangle(RtslState &state, const Ray &ray, const TriangleVertices &vertices,
                  uint32_t instance, uint32_t triangle) {
  return testTriangle(state, ray, vertices, instance, triangle, [] { return true; });
}

template <typename Ray>
bool testTriangle(RtslState &state, const Ray &ray, const RtslMesh &mesh, uint32_t instance,
                  uint32_t triangle) {
  return testTriangle(state, ray, triangleVertices(*state.launch, mesh, triangle, state.Time),
                      instance, triangle);
}

/// An RTSL primitive whose box the ray enters, and the range in which its hits count.
struct EnteredItem : RtslLeafItem {
  Range range;
};

/// May an RTSL primitive be hit? Its hits count in the part of the ray in its box; with --fp=fast
/// on all of the ray in a scene without a tree, where the result does not depend on the boxes.
template <typename Ray>
bool hasHitsIn(Range &range, const RtslLaunch &launch, const Ray &ray, const RtslInstance &instance,
               uint32_t primitive) {
  range = {-infinity, infinity};
  if (rtsl_is_fast() && rtsl_listed_instances(&launch))
    return true;
  const RtslBox box = boxOf(launch, instance, primitive);
  const Range exact = rangeInBox(box.lower, box.upper, ray.origin, ray.inverse, 0, infinity);
  if (exact.isEmpty())
    return false;
  const Range inBox = exact.widened();
  range = {moveIntoInstance(ray, inBox.near), moveIntoInstance(ray, inBox.far)};
  return true;
}

/// Runs `intersect` of an RTSL primitive, intersect(state, object), as if nothing else had been
/// hit, unless all of the range is beyond the nearest hit or before the ray's start. True if it
/// commits a hit that wins. It must not be the hit so far. `Ray` is a TriangleRay in world space or
/// an InstanceRay.
template <typename Ray, typename Intersect>
bool testInRange(RtslState &state, const Ray &ray, const RtslInstance &instance,
                 const RtslLeafItem &item, Range range, Intersect intersect) {
  if (range.near > state.nearest || range.far < state.Epsilon)
    return false;
  const float end = state.HitDistance;
  const uint32_t dimension = state.dimension;
  beginCandidate(state, item.instance, item.primitive);
  state.candidateNear = range.near;
  state.candidateFar = range.far;
  state.dimension = dimensionOf(PrimitiveMethod::Intersect, item.instance, item.primitive);
  {
    const InObjectSpace space(state, instance, ray);
    intersect(&state, instance.primitive);
  }
  const bool hasHit = state.HitDistance < end;
  const bool hasWon = state.instance == item.instance &&
                      (!isCounted(*state.launch, instance) || state.primitive == item.primitive);
  state.dimension = dimension;
  state.HitDistance = end;
  if (hasHit && !hasWon && rtsl_needs(state.launch) & RTSL_NEEDS_ATTRIBUTES)
    state.areAttributesLost = 1;
  return hasWon;
}

/// The same with the range of the ray in the primitive's box, if it enters that.
template <typename Ray, typename Intersect>
bool testPrimitive(RtslState &state, const Ray &ray, const RtslInstance &instance,
                   const RtslLeafItem &item, Intersect intersect) {
  Range range;
  return hasHitsIn(range, *state.launch, ray, instance, item.primitive) &&
         testInRange(state, ray, instance, item, range, intersect);
}

/// Calls visit(item, ray) for an item with the ray in its space. False if the ray does not enter
/// that before `limit`, or if visit returns false.
template <typename Visit>
bool visitInItsSpace(const RtslState &state, const TriangleRay &ray, const RtslLeafItem &item,
                     float limit, Visit visit) {
  const RtslLaunch &launch = *state.launch;
  if (!hasOwnSpace(launch, instanceAt(launch, item.instance)))
    return visit(item, ray);
  InstanceRay entered;
  return enterInstance(launch, ray, item.instance, state.Time, state.Epsilon, limit, entered) &&
         visit(item, entered);
}

/// To be called after a search: `intersect` stores the attributes of its hit, whether it wins or
/// not. If they are not those of the winning hit, its `intersect` runs again.
template <typename Intersect>
void findLostAttributes(RtslState &state, const TriangleRay &ray, Intersect intersect) {
  if (!(rtsl_needs(state.launch) & RTSL_NEEDS_ATTRIBUTES) || !state.areAttributesLost ||
      state.instance == RTSL_NO_HIT)
    return;
  const RtslInstance &instance = instanceAt(*state.launch, state.instance);
  if (instance.primitive == 0)
    return;
  const RtslLeafItem item = {state.instance, state.primitive};
  state.nearest = state.HitDistance;
  state.instance = RTSL_NO_HIT;
  visitInItsSpace(state, ray, item, state.nearest, [&](const RtslLeafItem &, const auto &inside) {
    return testPrimitive(state, inside, instance, item, intersect);
  });
}

/// Tests one leaf item, in the space of a ray that has entered the item's instance if that has its
/// own, and commits it if it wins.
template <typename Ray, typename Intersect>
bool testItem(RtslState &state, const Ray &ray, const RtslLeafItem &item, Intersect intersect) {
  const RtslInstance &instance = instanceAt(*state.launch, item.instance);
  return instance.primitive == 0 ? testTriangle(state, ray, state.launch->meshes[instance.mesh],
                                                item.instance, item.primitive)
                                 : testPrimitive(state, ray, instance, item, intersect);
}
template <typename Ray, typename Intersect>
bool testItem(RtslState &state, const Ray &ray, const TreeItem &item, Intersect intersect) {
  if (!hasVertices(*state.launch, item))
    return testItem(state, ray, static_cast<const RtslLeafItem &>(item), intersect);
  return testTriangle(state, ray, item.vertices(), item.instance, item.primitive);
}

/// The same for one that the ray may not see.
template <typename Ray, typename Slots, typename Intersect>
bool testIfSeen(RtslState &state, const Ray &ray, const RtslLeafItem &item, const Slots &slots,
                Intersect intersect) {
  return isSeen(state, item, ray, slots) && testItem(state, ray, item, intersect);
}
template <typename Ray, typename Slots, typename Intersect>
bool testIfSeen(RtslState &state, const Ray &ray, const TreeItem &item, const Slots &slots,
                Intersect intersect) {
  if (!hasVertices(*state.launch, item))
    return testIfSeen(state, ray, static_cast<const RtslLeafItem &>(item), slots, intersect);
  return testTriangle(state, ray, item.vertices(), item.instance, item.primitive,
                      [&] { return isSeen(state, item, ray, slots); });
}

/// The same for a primitive that every ray sees.
template <typename Slots, typename Intersect>
bool testIfSeen(RtslState &state, const TriangleRay &ray, const EnteredItem &item, const Slots &,
                Intersect intersect) {
  return testInRange(state, ray, instanceAt(*state.launch, item.instance), item, item.range,
                     intersect);
}

} // namespace rtsl::device
