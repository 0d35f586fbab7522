#include "runtime/embree/LastOccluders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

using rtsl::runtime::LastOccluders;
using rtsl::runtime::Occluder;

namespace {

/// A ray that meets these blocks and no others: what is tested for it, in order.
struct Tests {
  std::vector<std::uint32_t> met, tested = {};
  bool operator()(const Occluder &occluder) {
    tested.push_back(occluder.number);
    return std::find(met.begin(), met.end(), occluder.number) != met.end();
  }
};

std::vector<std::uint32_t> testedFor(LastOccluders &last, std::uint64_t scene,
                                     std::vector<std::uint32_t> met, bool expected) {
  Tests tests{met};
  EXPECT_EQ(last.isMet(scene, std::ref(tests)), expected);
  return tests.tested;
}

using Blocks = std::vector<std::uint32_t>;

} // namespace

TEST(LastOccluders, NothingIsTestedBeforeSomethingWasFoundTwice) {
  LastOccluders last;
  EXPECT_EQ(testedFor(last, 1, {5}, false), Blocks{});
  last.learn(1, {5});
  EXPECT_EQ(testedFor(last, 1, {5}, false), Blocks{});
  last.learn(1, {5});
  EXPECT_EQ(testedFor(last, 1, {5}, true), Blocks{5});
}

TEST(LastOccluders, TheLatestIsTestedFirst) {
  LastOccluders last;
  for (int round = 0; round < 2; ++round)
    for (std::uint32_t block : {5, 6})
      last.learn(1, {block}); // found again, each was the second one
  last.learn(1, {6});
  EXPECT_EQ(testedFor(last, 1, {5}, true), (Blocks{6, 5}));
  EXPECT_EQ(testedFor(last, 1, {5}, true), Blocks{5});
}

TEST(LastOccluders, BlocksOfAnotherSceneAreForgotten) {
  LastOccluders last;
  last.learn(1, {5});
  last.learn(1, {5});
  EXPECT_EQ(testedFor(last, 2, {5}, false), Blocks{});
  last.learn(2, {7});
  last.learn(2, {7});
  EXPECT_EQ(testedFor(last, 2, {5}, false), Blocks{7});
  EXPECT_EQ(testedFor(last, 1, {5}, false), Blocks{});
}

TEST(LastOccluders, WhatIsNotWorthTheTestIsLeftOut) {
  LastOccluders last;
  last.learn(1, {5});
  last.learn(1, {5});
  std::size_t tests = 0;
  for (int ray = 0; ray < 1000; ++ray)
    tests += testedFor(last, 1, {}, false).size();
  EXPECT_GE(tests, 1u);
  EXPECT_LE(tests, 16u);
  last.learn(1, {5}); // it would have been met
  EXPECT_EQ(testedFor(last, 1, {5}, true), Blocks{5});
}

TEST(LastOccluders, ABlockAndAnInstanceOfOneNumberDiffer) {
  LastOccluders last;
  for (const bool isInstance : {false, true})
    last.learn(1, {5, isInstance}); // neither was found twice
  EXPECT_EQ(testedFor(last, 1, {5}, false), Blocks{});
  last.learn(1, {5, true});
  EXPECT_EQ(testedFor(last, 1, {5}, true), Blocks{5});
}

TEST(LastOccluders, InstancesAreTestedLessOftenInVain) {
  std::size_t tests[2] = {};
  for (const bool isInstance : {false, true}) {
    LastOccluders last;
    for (int i = 0; i < 4; ++i)
      last.learn(1, {5, isInstance});
    for (int ray = 0; ray < 100; ++ray)
      tests[isInstance] += testedFor(last, 1, {}, false).size();
  }
  EXPECT_GE(tests[1], 1u);
  EXPECT_LT(tests[1], tests[0]);
}

TEST(LastOccluders, ManyBlocksPushOutTheOldest) {
  LastOccluders last;
  for (int round = 0; round < 3; ++round)
    for (std::uint32_t block = 0; block < 8; ++block)
      last.learn(1, {block});
  for (std::uint32_t block = 8; block < 108; ++block)
    last.learn(1, {block});
  for (std::uint32_t block : testedFor(last, 1, {}, false))
    EXPECT_GE(block, 100u);
}
