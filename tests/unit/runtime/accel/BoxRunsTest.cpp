//===- BoxRunsTest.cpp ----------------------------------------------------===//
#include "runtime/accel/trees/BoxRuns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

namespace rtsl::runtime {
namespace {

using Place = std::function<float(std::mt19937 &)>; // a coordinate

LargeArray<TriangleBox> boxesAt(std::size_t count, const Place &place, float size) {
  std::mt19937 random(1);
  LargeArray<TriangleBox> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[i].lower[axis] = place(random);
      boxes[i].upper[axis] = boxes[i].lower[axis] + size * float(random() % 100);
    }
    boxes[i].triangle = std::uint32_t(i);
  }
  return boxes;
}

/// All boxes are in one run each, and the result is that of one thread. Returns the runs.
std::vector<BoxRun> check(LargeArray<TriangleBox> &boxes, LargeArray<TriangleBox> again) {
  const std::size_t count = boxes.size();
  const std::vector<BoxRun> runs = sortIntoRuns(boxes, 0), ofOneThread = sortIntoRuns(again, 1);
  EXPECT_TRUE(count == 0 ||
              std::memcmp(boxes.data(), again.data(), count * sizeof(TriangleBox)) == 0);
  EXPECT_EQ(runs.size(), ofOneThread.size());
  std::size_t next = 0;
  for (const BoxRun &run : runs) {
    EXPECT_EQ(run.first, next);
    EXPECT_TRUE(run.length >= 1 && run.length <= longestRun);
    next += run.length;
  }
  EXPECT_EQ(next, count);
  std::vector<bool> seen(count);
  for (const TriangleBox &box : boxes) {
    EXPECT_FALSE(seen.at(box.triangle));
    seen[box.triangle] = true;
  }
  return runs;
}

double surfaceOf(const LargeArray<TriangleBox> &boxes, const BoxRun &run) {
  double side[3];
  for (int axis = 0; axis < 3; ++axis) {
    float lower = boxes[run.first].lower[axis], upper = boxes[run.first].upper[axis];
    for (unsigned i = 1; i < run.length; ++i) {
      lower = std::min(lower, boxes[run.first + i].lower[axis]);
      upper = std::max(upper, boxes[run.first + i].upper[axis]);
    }
    side[axis] = double(upper) - lower;
  }
  return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

float uniform(std::mt19937 &random) {
  return float(random()) * 0x1p-32f;
}

} // namespace

TEST(BoxRuns, HoldAllBoxesOnce) {
  const Place places[] = {
      uniform, [](std::mt19937 &) { return 3.0f; }, // all in one place
      [](std::mt19937 &random) { return random() % 1000 == 0 ? 1e17f : 1e-3f * uniform(random); },
      [](std::mt19937 &random) { return std::ldexp(uniform(random), int(random() % 180) - 120); },
      [](std::mt19937 &random) { return float(random() % 3) - 1e18f; }};
  for (const Place &place : places)
    for (const std::size_t count : {0u, 1u, 8u, 9u, 100u, 1025u, 40'000u})
      for (const float size : {0.0f, 1e-4f}) {
        LargeArray<TriangleBox> boxes = boxesAt(count, place, size);
        check(boxes, boxesAt(count, place, size));
      }
}

// Eight boxes of 20,000 in the unit cube occupy a cube with sides of 0.074 on average, and so half
// of a surface of 0.016.
TEST(BoxRuns, AreFullAndSmall) {
  constexpr std::size_t count = 20'000;
  LargeArray<TriangleBox> boxes = boxesAt(count, uniform, 0);
  const std::vector<BoxRun> runs = check(boxes, boxesAt(count, uniform, 0));
  EXPECT_LT(double(runs.size()), 1.25 * count / longestRun);
  double surface = 0;
  for (const BoxRun &run : runs)
    surface += surfaceOf(boxes, run);
  EXPECT_LT(surface / double(runs.size()), 0.016);
}

// Distant boxes make the first grid too coarse for the others.
TEST(BoxRuns, AreSmallBesideDistantBoxes) {
  const Place clustered = [](std::mt19937 &random) {
    return random() % 1000 == 0 ? 1e6f * uniform(random) : uniform(random);
  };
  constexpr std::size_t count = 60'000;
  LargeArray<TriangleBox> boxes = boxesAt(count, clustered, 0);
  const std::vector<BoxRun> runs = check(boxes, boxesAt(count, clustered, 0));
  std::vector<double> surfaces;
  for (const BoxRun &run : runs)
    surfaces.push_back(surfaceOf(boxes, run));
  std::nth_element(surfaces.begin(), surfaces.begin() + surfaces.size() / 2, surfaces.end());
  EXPECT_LT(surfaces[surfaces.size() / 2], 0.008);
}

} // namespace rtsl::runtime
