// The rows that each of several devices keeps in a rendering in passes.
#include "runtime/render/Stripes.h"
#include "runtime/device/organisations/Slice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace rtsl::runtime;

namespace {

/// The device of each row; fails unless all rows are kept once, in whole bands.
std::vector<std::size_t> devicesOfRows(const Stripes &stripes, std::uint32_t rows,
                                       std::size_t devices) {
  std::vector<std::size_t> of(rows, devices);
  for (std::size_t i = 0; i < devices; ++i)
    for (const Rows &part : stripes.of(i)) {
      EXPECT_EQ(part.y0 % rtsl::device::rowsOfBand, 0u);
      EXPECT_TRUE(part.y1 % rtsl::device::rowsOfBand == 0 || part.y1 == rows);
      for (std::uint32_t y = part.y0; y < part.y1; ++y) {
        EXPECT_EQ(of[y], devices);
        of[y] = i;
      }
    }
  EXPECT_EQ(std::count(of.begin(), of.end(), devices), 0);
  return of;
}

} // namespace

TEST(Stripes, KeepAllRowsOnce) {
  for (const std::size_t devices : {1, 2, 3, 8})
    for (const std::uint32_t rows : {1u, 3u, 4u, 5u, 61u, 1000u, 65536u}) {
      const std::vector<std::size_t> of = devicesOfRows(Stripes(rows, devices), rows, devices);
      for (std::size_t i = 0; i < devices; ++i) // as many, but for a stripe
        EXPECT_NEAR(double(std::count(of.begin(), of.end(), i)), double(rows) / double(devices),
                    4 + 1.1 * rows / (32.0 * double(devices)));
    }
}

TEST(Stripes, StayWithDevicesThatTakeAsLong) {
  Stripes stripes(1000, 4);
  EXPECT_TRUE(stripes.balance({1, 1.02, 0.99, 1}).empty());
  EXPECT_TRUE(stripes.balance({0, 0, 0, 0}).empty());
}

/// Devices of other speeds, and rows of other costs: after some passes they end together.
TEST(Stripes, MoveUntilDevicesEndTogether) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0, 1);
  for (int round = 0; round < 100; ++round) {
    const std::size_t devices = 2 + round % 4;
    const std::uint32_t rows = 1500 + std::uint32_t(500 * any(random));
    std::vector<double> speed, cost;
    double allSpeed = 0, allCost = 0;
    for (std::size_t i = 0; i < devices; ++i)
      allSpeed += speed.emplace_back(1 + 2 * any(random));
    for (std::uint32_t y = 0; y < rows; ++y)
      allCost += cost.emplace_back(1 + std::sin(0.01 * y) + 0.3 * any(random));
    Stripes stripes(rows, devices);
    std::vector<double> seconds;
    std::size_t moves = 1;
    for (int pass = 0; pass < 12 && moves > 0; ++pass) {
      const std::vector<std::size_t> of = devicesOfRows(stripes, rows, devices);
      seconds.assign(devices, 0);
      for (std::uint32_t y = 0; y < rows; ++y)
        seconds[of[y]] += cost[y] / speed[of[y]];
      moves = stripes.balance(seconds).size();
    }
    EXPECT_EQ(moves, 0u); // they do not go back and forth
    EXPECT_LT(*std::max_element(seconds.begin(), seconds.end()), 1.1 * allCost / allSpeed);
  }
}

/// A device whose pixels were all complete was done at once, and is not given everything.
TEST(Stripes, ADeviceWithoutWorkTakesItsShare) {
  Stripes stripes(1000, 2);
  const std::size_t before = stripes.of(0).size();
  const std::size_t moves = stripes.balance({1, 0}).size();
  EXPECT_GT(moves, before / 2 - 2);
  EXPECT_LT(moves, before / 2 + 2);
  Stripes few(4, 3); // one device has all
  EXPECT_LE(few.balance({1, 0, 0}).size(), 1u);
}
