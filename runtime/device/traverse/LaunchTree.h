//===- LaunchTree.h - the tree of a launch, or its list of instances ------===//
#pragma once

#include "runtime/device/ray/InOrder.h"
#include "runtime/device/ray/ListedBox.h"
#include "runtime/device/ray/ListedPairs.h"
#include "runtime/device/ray/Rough.h"
#include "runtime/device/traverse/Bvh.h"
#include "runtime/device/traverse/TestItem.h"

namespace rtsl::device {

/// The inverse of the direction for ListedBoxRay. The exact tests of boxes have the same; with
/// --fp=fast there are none. If it would be rounded to 0, the axis excludes no box.
inline Vec3 inverseForList(const TriangleRay &ray) {
  if (!rtsl_is_fast())
    return ray.inverse;
  const auto inverse = [](float component) {
    const float rough = roughReciprocal(component);
    return rough == 0 ? infinity : rough;
  };
  return {inverse(ray.direction.x), inverse(ray.direction.y), inverse(ray.direction.z)};
}

/// The instances of a list whose boxes the ray may enter between tMin and tMax, as a set of bits:
/// of instance i bit i, or that of ListedPairs.h.
struct EnteredList {
  uint32_t bits, count;
  bool isOfPairs;

  /// `leaves`: the instance that the ray leaves, or RTSL_NO_HIT.
  EnteredList(const RtslLaunch &launch, uint32_t count, const TriangleRay &ray, float tMin,
              float tMax, [[maybe_unused]] uint32_t leaves)
      : bits(0), count(count), isOfPairs(false) {
    const Vec3 inverse = inverseForList(ray);
#ifdef __NVPTX__
    if (rtsl_has_half_pairs() && rtsl_listed_pairs(&launch)) {
      const RtslListedPairs &list = *rtsl_listed_pairs(&launch);
      bits = enteredInPairs(list, count, {list, ray.origin, ray.direction, inverse, tMin, tMax});
      isOfPairs = true;
      // A ray begins in the box of what it leaves, or so near that halves do not tell.
      if (leaves < count &&
          endsBefore(rtsl_listed_boxes(&launch)[leaves], ray.origin, inverse, tMin))
        bits &= ~(1u << bitOfInstance(leaves, count));
      return;
    }
#endif
    const ListedBoxRay boxRay(ray.origin, inverse);
    const auto *boxes = static_cast<const RtslListedBox *>(
        __builtin_assume_aligned(rtsl_listed_boxes(&launch), 16));
#ifdef __clang__
#pragma clang loop unroll_count(4) vectorize(disable)
#endif
    for (uint32_t i = count; i-- > 0;)
      bits = 2 * bits + uint32_t(boxRay.mayEnter(boxes[i], tMin, tMax));
  }

  uint32_t takeInstance() {
    const auto bit = uint32_t(__builtin_ctz(bits));
    bits &= bits - 1;
    return isOfPairs ? instanceOfBit(bit, count) : bit;
  }
};

/// Calls visit(item, ray) for all of `count` primitives, whatever it returns. The loop is unrolled:
/// all that an `intersect` reads of its object is constant, and the lanes of a GPU test the same
/// primitive together. One that the ray leaves follows at the end, if it has a hit that may count.
template <typename Visit>
void forEachInOrder(RtslState &state, uint32_t count, const TriangleRay &ray, Visit visit) {
  {
    const InOrder inOrder(state);
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
    for (uint32_t i = 0; i < count; ++i)
      visit(RtslLeafItem{i, 0}, ray);
  }
  if (state.isStartPutOff)
    visit(RtslLeafItem{state.leaves, 0}, ray);
}

/// Calls visit(item, ray) for the instances, at most 32 primitives, whose boxes the ray enters
/// between tMin and limit(), until it returns true; `leaves` as for EnteredList. All boxes are
/// tested first: the lanes of a GPU that have primitives left then test them together, each its
/// own. Unrolling both loops completely would be slower: the program exceeds the instruction cache.
template <typename Limit, typename Visit>
void forEachListed(const RtslLaunch &launch, uint32_t count, const TriangleRay &ray, float tMin,
                   uint32_t leaves, Limit limit, Visit visit) {
  if (count == 1 && (!rtsl_is_fast() || rtsl_is_intersect_cheap())) { // its own test will do
    visit(RtslLeafItem{0, 0}, ray);
    return;
  }
  EnteredList entered(launch, count, ray, tMin * (1.0f - 2 * rangeShare), limit() * cullSlack,
                      leaves);
  while (entered.bits != 0)
    if (visit(RtslLeafItem{entered.takeInstance(), 0}, ray))
      return;
}

/// The tree of the launch, or the list of its instances. A tree calls visit(item, ray) for each
/// leaf item that may have hits before limit(), nearer ones first on the whole, until it returns
/// true. `ray` is the ray in world space, or, where the launch has transforms, the SearchRay in the
/// item's space. It passes over instances with a space that enter(instance) is false for.
struct LaunchTree {
  bool putsOff;                           // as in traverseBvh
  [[maybe_unused]] bool testsAll = false; // of a list, if the program does (rtsl_tests_all_listed)

  template <typename Limit, typename Enter, typename Visit>
  void forEach(RtslState &state, const TriangleRay &ray, Limit limit, Enter enter,
               Visit visit) const {
    const RtslLaunch &launch = *state.launch;
    const float tMin = maximum(state.Epsilon, 0.0f);
    if (const uint32_t count = rtsl_listed_instances(&launch)) {
#ifdef RTSL_IN_PROGRAM
      if (testsAll && rtsl_tests_all_listed()) {
        forEachInOrder(state, count, ray, visit);
        return;
      }
#endif
      const bool isKnown = (rtsl_needs(&launch) & RTSL_NEEDS_HIT_ERRORS) != 0;
      forEachListed(launch, count, ray, tMin, isKnown ? state.leaves : RTSL_NO_HIT, limit, visit);
      return;
    }
    if (!hasTransforms(launch)) {
      traverseBvh(launch, ray, tMin, limit, putsOff, [&](const RtslTreeItem &inMemory) {
        const ItemWords stored(inMemory);
        return visit(TreeItem{stored.leafItem(), stored}, ray);
      });
      return;
    }
    Spaces<Limit, Enter, Visit> spaces = {state, ray, SearchRay(ray), limit, enter, visit};
    traverseSpaces<true>(launch, spaces, tMin, limit, putsOff);
  }

private:
  /// The world's tree and those of the instances that have a space of their own, for
  /// traverseSpaces.
  template <typename Limit, typename Enter, typename Visit>
  struct Spaces {
    const RtslState &state;
    const TriangleRay &world;
    SearchRay current;
    Limit &limit;
    Enter &enter;
    Visit &visit;

    const TriangleRay &ray() const { return current; }
    void leave() { current.leaveInstance(world); }
    uint32_t root() const {
      return state.launch->meshTrees[treeNumber(*state.launch, instance(current.instance))];
    }

    Next test(const RtslTreeItem &inMemory) {
      const ItemWords stored(inMemory);
      TreeItem item = {stored.leafItem(), stored};
      if (!current.isInWorld())
        item.instance = current.instance;
      else if (!stored.hasVertices() && hasOwnSpace(*state.launch, instance(item.instance)))
        return tryToEnter(item.instance);
      return visit(item, current) ? Next::Nothing : Next::Item;
    }

    const RtslInstance &instance(uint32_t number) const {
      return instanceAt(*state.launch, number);
    }
    Next tryToEnter(uint32_t number) {
      return enter(instance(number)) && enterInstance(*state.launch, world, number, state.Time,
                                                      state.Epsilon, limit(), current)
                 ? Next::Inside
                 : Next::Item;
    }
  };
};

} // namespace rtsl::device
