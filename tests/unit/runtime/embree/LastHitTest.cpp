#include "runtime/embree/LastHit.h"

#include <gtest/gtest.h>

#include <cstdint>

using rtsl::runtime::LastHit;
using rtsl::runtime::Occluder;

namespace {

constexpr std::uint64_t scene = 1;
const Occluder nothing, block = {5, false}, instance = {5, true};

} // namespace

TEST(LastHit, IsTestedOnceItHasBeenHitTwice) {
  LastHit last;
  EXPECT_EQ(last.toTest(scene), nothing);
  last.learn(scene, block);
  EXPECT_EQ(last.toTest(scene), nothing);
  last.learn(scene, block);
  EXPECT_EQ(last.toTest(scene), block);
  last.learn(scene, instance); // of the same number
  EXPECT_EQ(last.toTest(scene), nothing);
}

TEST(LastHit, OneMissAfterManyHitsIsForgiven) {
  LastHit last;
  for (int i = 0; i < 10; ++i)
    last.learn(scene, instance);
  last.learn(scene, block);
  EXPECT_EQ(last.toTest(scene), block);
  for (int i = 0; i < 10; ++i)
    last.learn(scene, i % 2 ? block : instance);
  EXPECT_EQ(last.toTest(scene), nothing);
}

TEST(LastHit, NothingIsNotTestedHoweverOftenItIsHit) {
  LastHit last;
  for (int i = 0; i < 10; ++i)
    last.learn(scene, nothing);
  last.learn(scene, block);
  EXPECT_EQ(last.toTest(scene), nothing);
}

TEST(LastHit, ThatOfAnotherSceneIsForgotten) {
  LastHit last;
  last.learn(scene, block);
  last.learn(scene, block);
  EXPECT_EQ(last.toTest(scene + 1), nothing);
  last.learn(scene + 1, block);
  EXPECT_EQ(last.toTest(scene + 1), nothing);
}
