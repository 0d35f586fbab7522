#include "runtime/device/ray/Hit.h"
#include "runtime/device/ray/HitError.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rtsl::device;

namespace {

/// Candidate (5, 7) in a box from 0 to 100, on a ray that has hit something at `nearest`.
RtslState state(float epsilon, float distance, float nearest, std::uint32_t instance = RTSL_NO_HIT,
                std::uint32_t primitive = RTSL_NO_HIT) {
  RtslState s{};
  s.Epsilon = epsilon;
  s.HitDistance = distance;
  s.nearest = s.foundDistance = nearest;
  s.instance = instance;
  s.primitive = primitive;
  s.candidateInstance = 5;
  s.candidatePrimitive = 7;
  s.candidateNear = 0;
  s.candidateFar = 100;
  return s;
}

} // namespace

TEST(Hit, OnlyBetweenEpsilonAndTheEndOfTheRay) {
  RtslState s = state(1, 10, 10);
  EXPECT_FALSE(reportHit(s, 1));
  EXPECT_FALSE(reportHit(s, 10)); // the end of the ray is no hit
  EXPECT_FALSE(reportHit(s, NAN));
  EXPECT_FALSE(reportHit(s, -3));
  EXPECT_EQ(s.instance, RTSL_NO_HIT);
  EXPECT_TRUE(reportHit(s, 4));
  EXPECT_EQ(s.HitDistance, 4);
  EXPECT_EQ(s.instance, 5u);
  EXPECT_EQ(s.primitive, 7u);
  EXPECT_FALSE(reportHit(s, 4)); // not nearer than itself
  EXPECT_TRUE(reportHit(s, 3));
  EXPECT_EQ(endSearch(s), RTSL_HIT);
  EXPECT_EQ(s.HitDistance, 3);
}

TEST(Hit, TheLowerInstanceAndPrimitiveWinsATie) {
  for (auto [instance, primitive, wins] : {std::tuple(6u, 0u, true), std::tuple(5u, 8u, true),
                                           std::tuple(5u, 6u, false), std::tuple(4u, 9u, false)}) {
    RtslState s = state(0, 10, 4, instance, primitive);
    EXPECT_TRUE(reportHit(s, 4));
    EXPECT_EQ(s.instance == 5 && s.primitive == 7, wins) << instance << ", " << primitive;
  }
}

// What `intersect` sees of its own hits must not depend on what else has been hit.
TEST(Hit, BehindAnotherOneIsAHitThatLoses) {
  RtslState s = state(0, 10, 2, 1, 1);
  EXPECT_TRUE(reportHit(s, 4));
  EXPECT_EQ(s.HitDistance, 4);
  EXPECT_FALSE(reportHit(s, 5));
  EXPECT_TRUE(reportHit(s, 3));
  EXPECT_EQ(endSearch(s), RTSL_HIT);
  EXPECT_EQ(s.HitDistance, 2);
  EXPECT_EQ(s.instance, 1u);
}

// A traversal that leaves out a box behind the nearest hit must not lose one that would have won.
TEST(Hit, OutsideOfTheBoxIsComparedAtItsSide) {
  RtslState s = state(0, 10, 2, 1, 1);
  s.candidateNear = 3;
  EXPECT_TRUE(reportHit(s, 1.5f));
  s = state(0, 10, 5, 1, 1);
  s.candidateNear = 3;
  EXPECT_TRUE(reportHit(s, 1.5f));
  EXPECT_EQ(s.nearest, 3);
  EXPECT_EQ(endSearch(s), RTSL_HIT);
  EXPECT_EQ(s.HitDistance, 1.5f);
}

TEST(Hit, TheErrorIsThatOfTheHitThatWins) {
  RtslLaunch launch{};
  launch.needs = RTSL_HAS_COUNTS;
  for (auto [instance, primitive, error] :
       {std::tuple(5u, 8u, 0.25f), std::tuple(5u, 6u, 0.5f), std::tuple(4u, 9u, 0.5f)}) {
    RtslState s = state(0, 10, 4, instance, primitive);
    s.launch = &launch;
    s.hitError = 0.5f;
    EXPECT_TRUE(reportHitWithin(s, 4, 0.25f));
    EXPECT_EQ(s.hitError, error) << instance << ", " << primitive;
  }
}
