//===- FindingsTest.cpp - which findings are those of a batch --------------===//
#include "Findings.h"

#include <gtest/gtest.h>

namespace rtsl::random {
namespace {

std::vector<Finding> failing(const std::vector<Failure> &failures) {
  std::vector<Finding> findings;
  for (Failure failure : failures)
    findings.push_back({failure, "", false, ""});
  return findings;
}

// A mismatch on one path, before the next one rejects the batch, hides the rejection of one program
// only; the others are still not known to be at fault.
TEST(Random, ABatchThatIsRejectedIsHalvedWhateverElseWasFound) {
  EXPECT_TRUE(areOfBatch(failing({Failure::Rejected, Failure::Rejected}), 2));
  EXPECT_TRUE(areOfBatch(failing({Failure::Rejected, Failure::Mismatch, Failure::Rejected}), 3));
  EXPECT_TRUE(areOfBatch(failing({Failure::Fault, Failure::Mismatch}), 2));
  EXPECT_TRUE(areOfBatch(failing({Failure::Crash}), 2)); // one for all of them
}

TEST(Random, WhatIsKnownOfEachProgramIsItsOwn) {
  EXPECT_FALSE(areOfBatch(failing({Failure::None, Failure::Mismatch}), 2));
  EXPECT_FALSE(areOfBatch(failing({Failure::Rejected}), 1));
  EXPECT_FALSE(areOfBatch(failing({Failure::Crash}), 1));
}

} // namespace
} // namespace rtsl::random
