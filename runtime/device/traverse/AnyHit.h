//===- AnyHit.h - traversal with `anyHit` ---------------------------------===//
//
// A material may reject a hit: if it has `anyHit` for the ray's payload, that runs for a hit before
// it counts. A primitive contributes one hit to a ray, the nearest, so `anyHit` runs at most once
// per primitive; an instance whose material has no `anyHit` for the payload accepts.
//
// If the order of these calls can be observed (they write to the payload, say), it is that of (t,
// instance, primitive), and the first that accepts ends the search: `anyHit` never runs beyond a
// hit that counts. The tree does not give hits in order, so the nearest few are collected in one
// traversal and tested in turn; when all of them are rejected, the next few are collected, beyond
// the last. What an `intersect` writes to the state is not kept meanwhile: it runs again for the
// hit that is tested, with the same result, because it sees the same ray. Only with --fp=fast may
// the second of two copies of its code round otherwise, and miss at an edge, as may an `intersect`
// that reads what it writes to a buffer: such a hit does not count.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/traverse/Candidate.h"
#include "runtime/device/traverse/Surface.h"
#include "runtime/device/traverse/Traverse.h"

namespace rtsl::device {

/// The methods of the program that this code is linked into.
struct LinkedPayloadSlots : LinkedSlots {
#define RTSL_PAYLOAD_SLOT(base, method)                                                            \
  static void base##_##method##_payload(RtslState *state, RtslRef object) {                        \
    rtsl_##base##_##method##_payload(state, object);                                               \
  }
#include "language/PayloadSlots.def"
};

/// A hit that may count.
struct Candidate {
  float t;
  uint32_t instance, primitive;
};

inline bool isBefore(const Candidate &a, const Candidate &b) {
  if (a.t != b.t)
    return a.t < b.t;
  return a.instance != b.instance ? a.instance < b.instance : a.primitive < b.primitive;
}

/// The nearest hits beyond a given one, in order, up to a fixed number.
struct NearestCandidates {
  static constexpr uint32_t room = 8;
  Candidate found[room];
  uint32_t count = 0;
  bool isClosed = false; // the last one counts for certain: nothing beyond it matters

  /// Are there no other hits that matter? Beyond a full list there may be more.
  bool isComplete() const { return isClosed || count < room; }

  float limit(float tMax) const { return isClosed || count == room ? found[count - 1].t : tMax; }

  void insert(const Candidate &candidate, bool surelyCounts) {
    uint32_t at = count;
    while (at > 0 && isBefore(candidate, found[at - 1]))
      --at;
    if (at == count && isClosed)
      return;
    if (at == room)
      return;
    if (surelyCounts) {
      found[at] = candidate;
      count = at + 1;
      isClosed = true;
      return;
    }
    if (count == room) { // the last one is dropped
      isClosed = false;
      --count;
    }
    for (uint32_t i = count; i > at; --i)
      found[i] = found[i - 1];
    found[at] = candidate;
    ++count;
  }
};

/// The traversal of one ray through a tree (see LaunchTree.h).
template <typename Slots, typename Tree>
class Search {
public:
  Search(RtslState &state, const ModerateSearch &moderate, const Slots &slots, const Tree &tree)
      : state(state), moderate(moderate), slots(slots), tree(tree),
        triangleRay(makeTriangleRay(load(state.RayOrigin), load(state.RayDirection))) {
    beginSearch(state);
  }

  const RtslInstance &instanceOf(const RtslLeafItem &item) const {
    return instanceAt(*state.launch, item.instance);
  }

  /// Tests one leaf item, in its space, and commits it if it wins. It must not be the hit so far.
  template <typename Item, typename Ray>
  bool test(const Item &item, const Ray &ray) const {
    return testItem(state, ray, item, intersect());
  }

  /// The same for an item that was found before.
  void testAgain(const RtslLeafItem &item) const {
    visitInItsSpace(state, triangleRay, item, state.nearest,
                    [&](const RtslLeafItem &, const auto &ray) { return test(item, ray); });
  }

  /// Calls visit(item, ray in its space) for items that may be hit before limit() until it returns
  /// true.
  template <typename Limit, typename Visit>
  void forEach(Limit limit, Visit visit) const {
    const auto sees = [&](const RtslInstance &instance) { return isSeen(state, instance, slots); };
    tree.forEach(state, triangleRay, limit, sees, [&](const auto &item, const auto &ray) {
      return isSeen(state, item, ray, slots) && visit(item, ray);
    });
  }

  /// Describes the hit that state has and runs `anyHit`. Returns RTSL_ACCEPT, RTSL_IGNORE or
  /// RTSL_TERMINATE.
  uint32_t invoke() const {
    const RtslInstance &instance = instanceAt(*state.launch, state.instance);
    const float end = state.HitDistance;
    state.HitDistance = state.foundDistance;
    {
      const ModerateSearch::AsSent asSent(moderate);
      describeHit(state, instance.needs & rtsl_needs(state.launch), slots);
      state.hitAnswer = RTSL_ACCEPT;
      slots.rt_Material_anyHit_payload(&state, instance.material);
    }
    state.HitDistance = end;
    const uint32_t answer = state.hitAnswer;
    state.hitAnswer = RTSL_ACCEPT; // `anyHit` of the hit that counts runs with a fresh answer
    return answer;
  }

  bool hasAnyHit(const RtslLeafItem &item) const {
    return instanceOf(item).anyHit & rtslRayTypeBit(state.rayType);
  }

  /// Resets the hit: a primitive's nearest hit must not depend on other hits.
  void forgetHit() const {
    beginSearch(state);
    state.instance = state.primitive = RTSL_NO_HIT;
  }

  uint32_t end() const {
    findLostAttributes(state, triangleRay, intersect());
    return endSearch(state);
  }

private:
  auto intersect() const {
    return withModerateRay(
        [this](RtslState *ray, RtslRef object) { slots.rt_Primitive_intersect(ray, object); },
        scalesWholeSearch(*state.launch));
  }

  RtslState &state;
  const ModerateSearch &moderate;
  const Slots &slots;
  const Tree &tree;
  TriangleRay triangleRay;
};

/// Calls `anyHit` in the order of hits.
template <typename Slots, typename Tree>
uint32_t searchInOrder(RtslState &state, const ModerateSearch &moderate, const Slots &slots,
                       const Tree &tree) {
  const Search<Slots, Tree> search(state, moderate, slots, tree);
  bool isFirst = true;
  Candidate last = {0, 0, 0};
  for (;;) {
    NearestCandidates nearest;
    search.forEach([&] { return nearest.limit(state.HitDistance); },
                   [&](const auto &item, const auto &ray) {
                     search.forgetHit();
                     if (search.test(item, ray)) {
                       Candidate candidate = {state.nearest, item.instance, item.primitive};
                       if (isFirst || isBefore(last, candidate))
                         nearest.insert(candidate, !search.hasAnyHit(item));
                     }
                     return false;
                   });
    bool isLost = false; // the last one: others may count beyond it
    for (uint32_t i = 0; i < nearest.count; ++i) {
      const RtslLeafItem item = {nearest.found[i].instance, nearest.found[i].primitive};
      search.forgetHit();
      search.testAgain(item);
      isLost = state.instance == RTSL_NO_HIT;
      if (!isLost && (!search.hasAnyHit(item) || search.invoke() != RTSL_IGNORE))
        return search.end();
    }
    search.forgetHit();
    if (nearest.isComplete() && !isLost)
      return search.end();
    last = nearest.found[nearest.count - 1];
    isFirst = false;
  }
}

/// A saved hit, to return to.
struct CommittedHit {
  float found, nearest, error, u, v;
  uint32_t instance, primitive;
  uint32_t attributes[RTSL_MAX_ATTRIBUTE_WORDS];

  explicit CommittedHit(const RtslState &state)
      : found(state.foundDistance), nearest(state.nearest), error(state.hitError), u(state.u),
        v(state.v), instance(state.instance), primitive(state.primitive) {
    for (uint32_t i = 0; i < RTSL_MAX_ATTRIBUTE_WORDS; ++i)
      attributes[i] = state.attributes[i];
  }
  void restore(RtslState &state) const {
    state.foundDistance = found;
    state.nearest = nearest;
    state.hitError = error;
    state.u = u;
    state.v = v;
    state.instance = instance;
    state.primitive = primitive;
    keepVertices(state, nullptr);
    for (uint32_t i = 0; i < RTSL_MAX_ATTRIBUTE_WORDS; ++i)
      state.attributes[i] = attributes[i];
  }
};

/// Calls `anyHit` as hits are found. With `first` the first that accepts ends the search.
template <typename Slots, typename Tree>
uint32_t searchAsFound(RtslState &state, const ModerateSearch &moderate, bool first,
                       const Slots &slots, const Tree &tree) {
  const Search<Slots, Tree> search(state, moderate, slots, tree);
  search.forEach([&] { return state.nearest; },
                 [&](const auto &item, const auto &ray) {
                   if (!search.hasAnyHit(item))
                     return search.test(item, ray) && first;
                   const CommittedHit before(state);
                   if (!search.test(item, ray))
                     return false;
                   uint32_t answer = search.invoke();
                   if (answer == RTSL_IGNORE) {
                     before.restore(state);
                     return false;
                   }
                   return first || answer == RTSL_TERMINATE;
                 });
  return search.end();
}

/// rtsl_traverse for a ray whose hits may be rejected, with any tree. `slots` has the methods
/// that it needs as members with the names of Slots.def and PayloadSlots.def.
template <typename Slots, typename Tree>
uint32_t findHitAsking(RtslState &state, uint32_t how, const Slots &slots, const Tree &tree) {
  const ModerateSearch moderate(state, how);
  if (!moderate.isGood())
    return RTSL_BAD_RAY;
  return how & RTSL_IN_ORDER ? searchInOrder(state, moderate, slots, tree)
                             : searchAsFound(state, moderate, how & RTSL_FIRST_HIT, slots, tree);
}

/// The same with the tree of the launch.
template <typename Slots>
uint32_t traverseAsking(RtslState &state, uint32_t how, const Slots &slots) {
  return findHitAsking(state, how, slots, LaunchTree{!(how & RTSL_FIRST_HIT)});
}

} // namespace rtsl::device
