#include "runtime/device/Hit.h"

#include <gtest/gtest.h>

#include <cmath>

using rtsl::device::commitCandidate;

namespace {

RtslState state(float epsilon, float distance, std::uint32_t instance = RTSL_NO_HIT,
                std::uint32_t primitive = RTSL_NO_HIT) {
  RtslState s{};
  s.Epsilon = epsilon;
  s.HitDistance = distance;
  s.instance = instance;
  s.primitive = primitive;
  s.candidateInstance = 5;
  s.candidatePrimitive = 7;
  return s;
}

} // namespace

TEST(Hit, OnlyBetweenEpsilonAndTheHitSoFar) {
  RtslState s = state(1, 10);
  EXPECT_FALSE(commitCandidate(s, 1));
  EXPECT_FALSE(commitCandidate(s, 10)); // the end of the ray is no hit
  EXPECT_FALSE(commitCandidate(s, NAN));
  EXPECT_FALSE(commitCandidate(s, -3));
  EXPECT_EQ(s.instance, RTSL_NO_HIT);
  EXPECT_TRUE(commitCandidate(s, 4));
  EXPECT_EQ(s.HitDistance, 4);
  EXPECT_EQ(s.instance, 5u);
  EXPECT_EQ(s.primitive, 7u);
  EXPECT_FALSE(commitCandidate(s, 4)); // not lower than itself
}

TEST(Hit, TheLowerInstanceAndPrimitiveWinsATie) {
  for (auto [instance, primitive, wins] :
       {std::tuple(6u, 0u, true), std::tuple(5u, 8u, true), std::tuple(5u, 7u, false),
        std::tuple(5u, 6u, false), std::tuple(4u, 9u, false)}) {
    RtslState s = state(0, 4, instance, primitive);
    EXPECT_EQ(commitCandidate(s, 4), wins) << instance << ", " << primitive;
  }
}
