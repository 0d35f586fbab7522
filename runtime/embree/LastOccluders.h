//===- LastOccluders.h - recent occluders of shadow rays ------------------===//
//
// Shadow rays of one sample and the next go to the same lights from nearby points: the occluder of
// one is likely to occlude the other, and then one test replaces a search (Pearce and Jevans,
// "Exploiting shadow coherence in ray tracing", Graphics Interface 1991). Whether there is a hit at
// all does not depend on the order of tests.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace rtsl::runtime {

/// What hides a point, or is hit: a block of triangles of the world, or an instance that has a
/// space of its own.
struct Occluder {
  static constexpr std::uint32_t none = ~0u;

  std::uint32_t number = none; // the place of the block, or a number in EmbreeSpace::instances
  bool isInstance = false;

  bool operator==(const Occluder &other) const {
    return number == other.number && isInstance == other.isInstance;
  }
};

/// What the last occluded rays in roughly the same direction have hit, the latest first.
class LastOccluders {
public:
  /// The occluders of this thread, by the signs of the ray's direction, which separates lights.
  static LastOccluders &towards(const float direction[3]) {
    static thread_local std::array<LastOccluders, 8> all;
    return all[unsigned(direction[0] < 0) | unsigned(direction[1] < 0) << 1 |
               unsigned(direction[2] < 0) << 2];
  }

  /// Does a ray hit one of them? `test` tests an occluder in the scene with this number, which is
  /// not 0. Those whose tests did not pay off recently are skipped. During a test other rays of
  /// this thread may go on, and change the list: then this one pays for another occluder.
  template <typename Test>
  bool isMet(std::uint64_t ofScene, Test test) {
    if (scene != ofScene)
      return false;
    for (unsigned i = 0; i < count && credit[i] != 0; ++i) {
      if (test(occluders[i])) {
        pay(i);
        moveToFront(i, occluders[i]);
        return true;
      }
      credit[i] -= std::min(credit[i], occluders[i].isInstance ? instanceCost : 1u);
    }
    return false;
  }

  /// Records what a search has found.
  void learn(std::uint64_t ofScene, const Occluder &found) {
    if (scene != ofScene) {
      scene = ofScene;
      count = 0;
      credit.fill(0);
    }
    unsigned i = 0;
    while (i < count && !(occluders[i] == found))
      ++i;
    if (i < count)
      pay(i); // it would have been hit
    else if (count < length)
      ++count;
    else
      i = length - 1;
    moveToFront(i, found);
  }

private:
  static constexpr unsigned length = 8;
  /// The approximate costs of a search, and of one in an instance, in tests of a block; the credit
  /// limits how many tests of an entry may fail.
  static constexpr unsigned searchCost = 8, instanceCost = 4, mostCredit = 64;

  void pay(unsigned place) { credit[place] = std::min(credit[place] + searchCost, mostCredit); }
  void moveToFront(unsigned from, Occluder occluder) {
    for (; from > 0; --from)
      occluders[from] = occluders[from - 1];
    occluders[0] = occluder;
  }

  std::uint64_t scene = 0; // whose they are
  std::array<Occluder, length> occluders{};
  std::array<unsigned, length> credit{}; // of an entry of the list, not of its occluder
  unsigned count = 0;
};

} // namespace rtsl::runtime
