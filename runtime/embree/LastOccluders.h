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

/// The blocks that the last occluded rays in roughly the same direction have hit, the latest first.
class LastOccluders {
public:
  /// Those of this thread, by the signs of the ray's direction, which separates lights.
  static LastOccluders &towards(const float direction[3]) {
    static thread_local std::array<LastOccluders, 8> all;
    return all[unsigned(direction[0] < 0) | unsigned(direction[1] < 0) << 1 |
               unsigned(direction[2] < 0) << 2];
  }

  /// Does a ray hit one of them? `test` tests a block of the scene with this number, which is not
  /// 0. Blocks whose tests did not pay off recently are skipped.
  template <typename Test>
  bool isMet(std::uint64_t ofScene, Test test) {
    if (scene != ofScene)
      return false;
    for (unsigned i = 0; i < count && credit[i] != 0; ++i) {
      if (test(blocks[i])) {
        pay(i);
        moveToFront(i, blocks[i]);
        return true;
      }
      --credit[i];
    }
    return false;
  }

  /// Records the block that a search has found.
  void learn(std::uint64_t ofScene, std::uint32_t found) {
    if (scene != ofScene) {
      scene = ofScene;
      count = 0;
      credit.fill(0);
    }
    unsigned i = 0;
    while (i < count && blocks[i] != found)
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
  /// The approximate cost of a search, in tests; the credit limits how many tests of an entry may
  /// fail.
  static constexpr unsigned searchCost = 8, mostCredit = 64;

  void pay(unsigned place) { credit[place] = std::min(credit[place] + searchCost, mostCredit); }
  void moveToFront(unsigned from, std::uint32_t block) {
    for (; from > 0; --from)
      blocks[from] = blocks[from - 1];
    blocks[0] = block;
  }

  std::uint64_t scene = 0; // whose blocks they are
  std::array<std::uint32_t, length> blocks{};
  std::array<unsigned, length> credit{}; // of an entry of the list, not of its block
  unsigned count = 0;
};

} // namespace rtsl::runtime
