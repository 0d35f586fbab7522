#include "runtime/render/passes/Passes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

using namespace rtsl::runtime;

namespace {

/// The numbers of samples per pixel at the ends of all passes.
std::vector<std::uint32_t> endsOf(std::uint32_t most, double secondsPerSample,
                                  const PassSizes &sizes = {}, const PassOptions &passes = {}) {
  std::vector<std::uint32_t> ends;
  PassState state;
  while (state.samplesPerPixel < most) {
    state.samplesPerPixel += samplesOfPass(state, passes, sizes, most);
    state.seconds = state.samplesPerPixel * secondsPerSample;
    ends.push_back(state.samplesPerPixel);
  }
  return ends;
}

using Ends = std::vector<std::uint32_t>;

} // namespace

TEST(Passes, GrowUntilTheyTakeHalfASecond) {
  EXPECT_EQ(endsOf(64, 1e-6), (Ends{1, 17, 64}));
  EXPECT_EQ(endsOf(10, 0.125), (Ends{1, 5, 9, 10}));
  EXPECT_EQ(endsOf(3, 10), (Ends{1, 2, 3}));
}

TEST(Passes, EndAtMultiplesThatTheyReach) {
  const PassSizes sizes = {64, 32};
  EXPECT_EQ(endsOf(40, 1e-6, sizes), (Ends{40}));
  EXPECT_EQ(endsOf(1000, 1e-6, sizes), (Ends{64, 1000}));
  EXPECT_EQ(endsOf(160, 0.0078125, sizes), (Ends{64, 128, 160})); // 64 in half a second
  EXPECT_EQ(endsOf(64, 1e-6, {1, 32}), (Ends{1, 17, 64}));
  EXPECT_EQ(endsOf(200, 0.01, {20, 32}), (Ends{20, 64, 96, 128, 160, 200}));
}

TEST(Passes, BeginWithOneSampleWhereTimeIsLimited) {
  PassOptions passes;
  passes.seconds = 100;
  EXPECT_EQ(endsOf(40, 1e-6, {64, 32}, passes), (Ends{1, 17, 40}));
}

TEST(Passes, EndWhereTheErrorIsMeasured) {
  PassOptions passes;
  passes.error = 0.1;
  EXPECT_EQ(endsOf(30, 1e-6, {64, 32}, passes), (Ends{16, 20, 25, 30}));
}
