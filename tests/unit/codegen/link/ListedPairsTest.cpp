//===- ListedPairsTest.cpp - boxes of a list in half precision ------------===//
#include "codegen/link/ListedPairs.h"

#include "runtime/device/ray/ListedPairs.h"
#include "runtime/device/traverse/BoxRange.h"
#include "runtime/device/traverse/Triangle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rtsl {
namespace {

using device::Vec3;

RtslInstance boxAt(const float (&middle)[3], const float (&half)[3]) {
  RtslInstance box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = middle[axis] - half[axis];
    box.upper[axis] = middle[axis] + half[axis];
  }
  return box;
}

/// Boxes of a room around a place, some of them flat.
std::vector<RtslInstance> room(std::mt19937 &random, std::size_t count, float size, Vec3 place) {
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<RtslInstance> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    float middle[3], half[3];
    for (int axis = 0; axis < 3; ++axis) {
      middle[axis] = place[axis] + size * unit(random);
      half[axis] = size * (0.3f + 0.2f * unit(random));
    }
    if (random() % 2)
      half[random() % 3] = 0;
    boxes.push_back(boxAt(middle, half));
  }
  return boxes;
}

TEST(ListedPairs, AreLeftOutWhereRaysWouldEnterTooMany) {
  std::mt19937 random(1);
  EXPECT_FALSE(listedPairs(room(random, 16, 1, {0, 0, 0})).empty());
  EXPECT_TRUE(listedPairs(room(random, 11, 1, {0, 0, 0})).empty());
  std::vector<RtslInstance> small = room(random, 16, 1e-3f, {0, 0, 0});
  small.push_back(boxAt({100, 0, 0}, {1e-3f, 1e-3f, 1e-3f}));
  EXPECT_TRUE(listedPairs(small).empty());
  RtslInstance infinite{};
  std::fill_n(infinite.lower, 3, -INFINITY);
  std::fill_n(infinite.upper, 3, INFINITY);
  EXPECT_TRUE(listedPairs(std::vector<RtslInstance>(16, infinite)).empty());
}

#ifdef __clang__ // which has numbers of half precision in C++

/// A number of any size.
float anySize(std::mt19937 &random, int exponents) {
  std::uniform_real_distribution<float> unit(-1, 1);
  return std::ldexp(unit(random), int(random() % unsigned(2 * exponents)) - exponents);
}

TEST(ListedPairs, AreEnteredWhereverRaysHaveARangeInThem) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-1, 1);
  int met = 0, missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const float size = std::ldexp(1.0f, int(random() % 60) - 30);
    const bool isFar = random() % 4 == 0;
    Vec3 place = {0, 0, 0};
    if (random() % 2)
      place = {10 * size * unit(random), size * unit(random), 100 * size * unit(random)};
    std::vector<RtslInstance> boxes = room(random, 12 + random() % 21, size, place);
    if (random() % 4 == 0)
      std::fill_n(boxes[1].upper, 3, INFINITY);
    const std::vector<std::int32_t> words = listedPairs(boxes);
    if (words.empty())
      continue;
    const auto &list = *reinterpret_cast<const RtslListedPairs *>(words.data());
    const auto count = std::uint32_t(boxes.size());
    for (int j = 0; j < 10; ++j) {
      Vec3 origin = place, direction;
      for (float *const o : {&origin.x, &origin.y, &origin.z})
        *o += size * (isFar ? anySize(random, 20) : 2 * unit(random));
      if (random() % 4 == 0) // in a plane of a side
        origin.y = boxes[0].lower[1];
      const bool isUneven = random() % 4 == 0;
      for (float *const d : {&direction.x, &direction.y, &direction.z})
        *d = isUneven ? anySize(random, 30) : unit(random);
      if (random() % 4 == 0)
        direction.x = 0;
      direction = direction * std::ldexp(1.0f, int(random() % 40) - 20);
      if (device::isZero(direction))
        continue;
      const Vec3 inverse = device::makeTriangleRay(origin, direction).inverse;
      const float across = size / device::largest(direction);
      const float tMin = random() % 2 ? 0 : across * std::abs(anySize(random, 4)),
                  tMax = random() % 2 ? INFINITY : across * std::abs(anySize(random, 20));
      const device::ListedPairsRay ray(list, origin, direction, inverse, tMin, tMax);
      const std::uint32_t bits = device::enteredInPairs(list, count, ray);
      std::uint32_t instances = 0;
      for (std::uint32_t bit = 0; bit < 32; ++bit)
        if (bits >> bit & 1)
          instances |= 1u << device::instanceOfBit(bit, count);
      EXPECT_EQ(__builtin_popcount(bits), __builtin_popcount(instances));
      for (std::uint32_t box = 0; box < count; ++box) {
        const bool meets = device::enterBox(boxes[box].lower, boxes[box].upper, origin, inverse,
                                            tMin, tMax) < device::infinity;
        const bool enters = instances >> box & 1;
        ASSERT_TRUE(!meets || enters) << i << " " << j << " " << box;
        met += meets;
        missed += !enters;
      }
      ASSERT_EQ(std::uint64_t(instances) >> count, 0u);
    }
  }
  EXPECT_GT(met, 40000);
  EXPECT_GT(missed, 400000); // it does not simply enter all
}

TEST(ListedPairs, OfRoomsLeaveOutNearlyAsManyAsTheExactTest) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1, 1);
  int met = 0, entered = 0;
  for (int i = 0; i < 500; ++i) {
    const std::vector<RtslInstance> boxes = room(random, 16, 5, {0, 0, 0});
    const std::vector<std::int32_t> words = listedPairs(boxes);
    ASSERT_FALSE(words.empty());
    const auto &list = *reinterpret_cast<const RtslListedPairs *>(words.data());
    for (int j = 0; j < 100; ++j) {
      const Vec3 origin = {5 * unit(random), 5 * unit(random), 5 * unit(random)},
                 direction = {unit(random), unit(random), unit(random)};
      const Vec3 inverse = device::makeTriangleRay(origin, direction).inverse;
      for (const RtslInstance &box : boxes)
        met +=
            device::enterBox(box.lower, box.upper, origin, inverse, 0, INFINITY) < device::infinity;
      const device::ListedPairsRay ray(list, origin, direction, inverse, 0, INFINITY);
      entered += __builtin_popcount(device::enteredInPairs(list, 16, ray));
    }
  }
  EXPECT_LE(entered, met + met / 10) << met;
}

#endif

} // namespace
} // namespace rtsl
