//===- ClosestNameTest.cpp - names for "did you mean" ---------------------===//
#include "support/ClosestName.h"

#include <gtest/gtest.h>

namespace rtsl {

TEST(Suggestions, AreCloseNames) {
  EXPECT_EQ(closestName("radus", {"radius", "center"}), "radius");
  EXPECT_EQ(closestName("Radius", {"radius"}), "radius");
  EXPECT_EQ(closestName("RADIUS", {"radius"}), "radius");
  EXPECT_EQ(closestName("raidus", {"radius"}), "radius");
  EXPECT_EQ(closestName("x", {"y"}), "");
  EXPECT_EQ(closestName("completely", {"different"}), "");
  EXPECT_EQ(closestName(std::string(100000, 'a'), {"a"}), "");
}

} // namespace rtsl
