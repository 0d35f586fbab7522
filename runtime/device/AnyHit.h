//===- AnyHit.h - traversal that asks materials ---------------------------===//
//
// A material may refuse a hit: where it has `anyHit` for the ray's payload, that runs for a hit
// before it counts. A primitive takes part in a ray with one hit, the nearest, so it is asked at
// most once; an instance whose material has no `anyHit` for the payload accepts.
//
// Where the order in which materials are asked can show (they write to the payload, say), it is
// that of (t, instance, primitive), and the first that accepts ends the search: nothing behind a
// hit that counts is ever asked. The tree does not give hits in order, so the nearest few are
// collected in one descent and asked in turn; when all of them refuse, the next few are collected,
// behind the last. What an `intersect` leaves in the state is not kept meanwhile: it runs again for
// the one that is asked.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/Abi.h"
#include "runtime/device/Candidate.h"
#include "runtime/device/Surface.h"
#include "runtime/device/Traverse.h"

namespace rtsl::device {

/// The methods of the program that this code is linked into.
struct LinkedPayloadSlots : LinkedSlots {
#define RTSL_PAYLOAD_SLOT(base, method)                                                            \
  static void base##_##method##_payload(RtslState *state, RtslRef object) {                        \
    rtsl_##base##_##method##_payload(state, object);                                               \
  }
#include "runtime/device/PayloadSlots.def"
};

/// A hit that may come to count.
struct Candidate {
  float t;
  uint32_t instance, primitive;
  uint32_t dimension; // of the ray's random numbers, before `intersect` ran
};

inline bool isBefore(const Candidate &a, const Candidate &b) {
  if (a.t != b.t)
    return a.t < b.t;
  return a.instance != b.instance ? a.instance < b.instance : a.primitive < b.primitive;
}

/// The nearest hits behind some other, in order, as many as there is room for.
struct NearestCandidates {
  static constexpr uint32_t room = 8;
  Candidate found[room];
  uint32_t count = 0;
  bool isClosed = false; // the last one surely counts: nothing behind it matters

  /// Is there no other hit that matters? Behind a full list nobody has looked.
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
    if (count == room) { // the last one has to go
      isClosed = false;
      --count;
    }
    for (uint32_t i = count; i > at; --i)
      found[i] = found[i - 1];
    found[at] = candidate;
    ++count;
  }
};

/// One ray's way through the tree.
template <typename Slots>
class Search {
public:
  Search(RtslState &state, const Slots &slots)
      : state(state), slots(slots),
        triangleRay(makeTriangleRay(load(state.RayOrigin), load(state.RayDirection))) {}

  const RtslInstance &instanceOf(const RtslLeafItem &item) const {
    return state.launch->instances[item.instance];
  }

  /// Tests one thing and commits it if it wins. It must not be the hit so far.
  bool test(const RtslLeafItem &item) const {
    const RtslInstance &instance = instanceOf(item);
    if (instance.primitive == 0)
      return testTriangle(state, triangleRay, state.launch->meshes[instance.mesh], item.instance,
                          item.primitive);
    beginCandidate(state, item.instance, item.primitive);
    slots.rt_Primitive_intersect(&state, instance.primitive);
    return state.instance == item.instance;
  }

  /// Calls visit(item) for what may be hit before limit() until it returns true.
  template <typename Limit, typename Visit>
  void forEach(Limit limit, Visit visit) const {
    Vec3 direction = load(state.RayDirection);
    Vec3 inverse = {1.0f / direction.x, 1.0f / direction.y, 1.0f / direction.z};
    traverseBvh(
        *state.launch, load(state.RayOrigin), inverse, maximum(state.Epsilon, 0.0f), limit,
        [&](const RtslLeafItem &item) { return isSeen(state, instanceOf(item)) && visit(item); });
  }

  /// Describes the hit that state has and runs `anyHit`. Returns RTSL_ACCEPT, RTSL_IGNORE or
  /// RTSL_TERMINATE.
  uint32_t ask() const {
    const RtslInstance &instance = state.launch->instances[state.instance];
    describeHit(state, instance.needs, slots);
    state.hitAnswer = RTSL_ACCEPT;
    slots.rt_Material_anyHit_payload(&state, instance.material);
    const uint32_t answer = state.hitAnswer;
    state.hitAnswer = RTSL_ACCEPT; // what runs for the hit that counts has not answered anything
    return answer;
  }

  bool hasAnyHit(const RtslLeafItem &item) const {
    return instanceOf(item).anyHit & rtslRayTypeBit(state.rayType);
  }

  void forgetHit(float distance) const {
    state.HitDistance = distance;
    state.instance = state.primitive = RTSL_NO_HIT;
  }

private:
  RtslState &state;
  const Slots &slots;
  TriangleRay triangleRay;
};

/// Materials are asked in the order of hits.
template <typename Slots>
uint32_t searchInOrder(RtslState &state, const Slots &slots) {
  const float tMax = state.HitDistance;
  const Search<Slots> search(state, slots);
  bool isFirst = true;
  Candidate last = {0, 0, 0, 0};
  for (;;) {
    NearestCandidates nearest;
    search.forEach(
        [&] { return nearest.limit(tMax); },
        [&](const RtslLeafItem &item) {
          // As if nothing had been hit: a primitive's nearest hit is always the same.
          search.forgetHit(tMax);
          uint32_t dimension = state.dimension;
          if (search.test(item)) {
            Candidate candidate = {state.HitDistance, item.instance, item.primitive, dimension};
            if (isFirst || isBefore(last, candidate))
              nearest.insert(candidate, !search.hasAnyHit(item));
          }
          return false;
        });
    for (uint32_t i = 0; i < nearest.count; ++i) {
      const Candidate &candidate = nearest.found[i];
      const RtslLeafItem item = {candidate.instance, candidate.primitive};
      search.forgetHit(tMax);
      uint32_t dimension = state.dimension;
      state.dimension = candidate.dimension;
      search.test(item);
      state.dimension = dimension;
      if (!search.hasAnyHit(item) || search.ask() != RTSL_IGNORE)
        return RTSL_HIT;
    }
    search.forgetHit(tMax);
    if (nearest.isComplete())
      return RTSL_MISS;
    last = nearest.found[nearest.count - 1];
    isFirst = false;
  }
}

/// The hit that state has, to come back to.
struct CommittedHit {
  float distance, u, v;
  uint32_t instance, primitive;
  uint32_t attributes[RTSL_MAX_ATTRIBUTE_WORDS];

  explicit CommittedHit(const RtslState &state)
      : distance(state.HitDistance), u(state.u), v(state.v), instance(state.instance),
        primitive(state.primitive) {
    for (uint32_t i = 0; i < RTSL_MAX_ATTRIBUTE_WORDS; ++i)
      attributes[i] = state.attributes[i];
  }
  void restore(RtslState &state) const {
    state.HitDistance = distance;
    state.u = u;
    state.v = v;
    state.instance = instance;
    state.primitive = primitive;
    for (uint32_t i = 0; i < RTSL_MAX_ATTRIBUTE_WORDS; ++i)
      state.attributes[i] = attributes[i];
  }
};

/// Materials are asked as hits are found. With `first` the first that accepts ends the search.
template <typename Slots>
uint32_t searchAsFound(RtslState &state, bool first, const Slots &slots) {
  const Search<Slots> search(state, slots);
  search.forEach([&] { return state.HitDistance; },
                 [&](const RtslLeafItem &item) {
                   if (!search.hasAnyHit(item))
                     return search.test(item) && first;
                   const CommittedHit before(state);
                   if (!search.test(item))
                     return false;
                   uint32_t answer = search.ask();
                   if (answer == RTSL_IGNORE) {
                     before.restore(state);
                     return false;
                   }
                   return first || answer == RTSL_TERMINATE;
                 });
  return state.instance != RTSL_NO_HIT ? RTSL_HIT : RTSL_MISS;
}

/// rtsl_traverse by our own tree for a ray whose hits may be refused. `slots` has the methods that
/// it needs as members with the names of Slots.def and PayloadSlots.def.
template <typename Slots>
uint32_t traverseAsking(RtslState &state, uint32_t how, const Slots &slots) {
  if (!isGoodRay(state))
    return RTSL_BAD_RAY;
  return how & RTSL_IN_ORDER ? searchInOrder(state, slots)
                             : searchAsFound(state, how & RTSL_FIRST_HIT, slots);
}

} // namespace rtsl::device
