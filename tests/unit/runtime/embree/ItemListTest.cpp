// The boxes of a list, eight at a time, beside the same boxes one by one: the same ranges, to the
// bit.
#include "runtime/embree/ItemList.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

using namespace rtsl;
using device::Vec3;

namespace {

class BoxCases {
public:
  float unit() { return std::uniform_real_distribution<float>(-1, 1)(random); }
  unsigned below(unsigned n) { return unsigned(random() % n); }

  /// Some have no extent along an axis.
  std::vector<RtslBox> boxes() {
    std::vector<RtslBox> all(1 + below(runtime::ItemList::most));
    for (RtslBox &box : all)
      for (int axis = 0; axis < 3; ++axis) {
        const float a = unit(), b = below(4) ? unit() : a;
        box.lower[axis] = std::min(a, b);
        box.upper[axis] = std::max(a, b);
      }
    return all;
  }

  /// From anywhere, or from a corner of a box; components of the direction may be 0.
  device::TriangleRay ray(const std::vector<RtslBox> &boxes) {
    const RtslBox &box = boxes[below(unsigned(boxes.size()))];
    const Vec3 origin =
        below(3) ? Vec3{2 * unit(), 2 * unit(), 2 * unit()} : device::load(box.lower);
    Vec3 direction{unit(), unit(), 1};
    if (below(3) == 0)
      direction.x = below(2) ? 0.0f : -0.0f;
    if (below(3) == 0)
      direction.y = 0;
    return device::makeTriangleRay(origin, below(2) ? direction : direction * -1.0f);
  }

private:
  std::mt19937 random{3};
};

bool haveSameBits(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(ItemList, HasTheRangesOfSingleBoxes) {
  BoxCases cases;
  unsigned entries = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::vector<RtslBox> boxes = cases.boxes();
    const device::TriangleRay ray = cases.ray(boxes);
    const float epsilon = cases.below(2) ? 0 : 0.5f, limit = cases.below(2) ? 1 : device::infinity;
    const auto entered = runtime::ItemList(boxes).enter(ray, epsilon, limit);
    for (unsigned k = 0; k < boxes.size(); ++k) {
      const device::Range exact = device::rangeInBox(boxes[k].lower, boxes[k].upper, ray.origin,
                                                     ray.inverse, 0, device::infinity);
      const device::Range range = exact.widened();
      const bool isEntered = !exact.isEmpty() && range.near <= limit && range.far >= epsilon;
      ASSERT_EQ(entered.items >> k & 1, unsigned(isEntered)) << i << ' ' << k;
      if (!isEntered)
        continue;
      ASSERT_TRUE(haveSameBits(entered.range(k).near, range.near)) << i << ' ' << k;
      ASSERT_TRUE(haveSameBits(entered.range(k).far, range.far)) << i << ' ' << k;
      ++entries;
    }
    if (boxes.size() < runtime::ItemList::most) {
      ASSERT_EQ(entered.items >> boxes.size(), 0u) << i;
    }
  }
  EXPECT_GT(entries, 5000u);
}

} // namespace
