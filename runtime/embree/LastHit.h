//===- LastHit.h - what the last camera ray has hit -----------------------===//
//
// The camera rays of a pixel's samples mostly hit the same instance, or neighbouring triangles. So
// what the last one has hit is tested first: a search passes over all that is further away. What it
// finds does not depend on the order of tests.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/embree/LastOccluders.h"

#include <algorithm>
#include <cstdint>

namespace rtsl::runtime {

class LastHit {
public:
  static LastHit &ofThread() {
    static thread_local LastHit one;
    return one;
  }

  /// What is to be tested first in the scene with this number, which is not 0. Nothing, unless
  /// tests would have paid off recently.
  Occluder toTest(std::uint64_t ofScene) const {
    return scene == ofScene && credit > 0 ? item : Occluder{};
  }

  /// Records what a search has found.
  void learn(std::uint64_t ofScene, const Occluder &found) {
    if (scene != ofScene)
      credit = 0;
    else if (found == item && found.number != Occluder::none)
      credit = std::min(credit + 1, mostCredit);
    else
      credit -= std::min(credit, 1u);
    scene = ofScene;
    item = found;
  }

private:
  static constexpr unsigned mostCredit = 4; // so many tests may fail after a long time

  std::uint64_t scene = 0; // whose it is
  Occluder item;
  unsigned credit = 0;
};

} // namespace rtsl::runtime
