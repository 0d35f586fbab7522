//===- Boxes.cpp - slabs, and trees over boxes that help nobody ------------===//
#include "Exact.h"
#include "Generators.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/BvhBuilder.h"
#include "runtime/device/Bvh.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rtsl::numerics {

namespace {

using device::Vec3;

struct Box {
  float lower[3], upper[3];
};

/// Whether the line meets the box for some t in [0, tMax], exactly, ends and sides included.
bool meetsExactly(Vec3 origin, Vec3 direction, const Box &box, float tMax) {
  std::optional<Rational> near = Rational(0), far;
  if (std::isfinite(tMax))
    far = exact(tMax);
  for (int axis = 0; axis < 3; ++axis) {
    const Rational lower = exact(box.lower[axis]) - exact(origin[axis]), upper = exact(box.upper[axis]) - exact(origin[axis]);
    if (direction[axis] == 0) {
      if (lower > 0 || upper < 0)
        return false;
      continue;
    }
    const Rational d = exact(direction[axis]);
    Rational enter = lower / d, leave = upper / d;
    if (leave < enter)
      std::swap(enter, leave);
    near = std::max(*near, enter);
    far = far ? std::min(*far, leave) : leave;
  }
  return !far || *near <= *far;
}

std::string describe(Vec3 origin, Vec3 direction, const Box &box) {
  return "ray " + show(origin) + " " + show(direction) + ", box " + show(device::load(box.lower)) + " " + show(device::load(box.upper));
}

/// A box must be entered wherever the exact ray meets it; entering one too many costs time, not a hit.
void judge(Worst &worst, Vec3 origin, Vec3 direction, const Box &box) {
  const Vec3 inverse = {1 / direction.x, 1 / direction.y, 1 / direction.z};
  const bool isEntered = device::enterBox(box.lower, box.upper, origin, inverse, 0, device::infinity) < device::infinity;
  worst.count(!isEntered && meetsExactly(origin, direction, box, device::infinity), [&] { return describe(origin, direction, box); });
}

Box boxAround(Vec3 a, Vec3 b) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::min(a[axis], b[axis]);
    box.upper[axis] = std::max(a[axis], b[axis]);
  }
  return box;
}

/// A direction with components of 0, -0 and of almost 0.
Vec3 thinDirection(Random &random) {
  const float tiny[] = {0.0f, -0.0f, 1e-30f, -1e-30f};
  float direction[3];
  for (float &component : direction)
    component = random.index(2) ? tiny[random.index(4)] : random.between(-1, 1);
  direction[random.index(3)] = random.index(2) ? 1.0f : -0.75f;
  return device::load(direction);
}

Outcome runOriginsOnSlabs(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Box box = boxAround(random.inBox(2), random.inBox(2));
    float origin[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float choices[] = {box.lower[axis], box.upper[axis], random.between(-3, 3), 0.5f * (box.lower[axis] + box.upper[axis])};
      origin[axis] = choices[random.index(4)];
    }
    judge(worst, device::load(origin), thinDirection(random), box);
  }
  return worst.outcome();
}

Outcome runFlatBoxes(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    Box box = boxAround(random.inBox(2), random.inBox(2));
    const int axis = int(random.index(3));
    box.upper[axis] = box.lower[axis];
    if (i % 4 == 0)
      box.upper[(axis + 1) % 3] = box.lower[(axis + 1) % 3];
    // At a point of it.
    float target[3];
    for (int j = 0; j < 3; ++j)
      target[j] = random.between(box.lower[j], box.upper[j]);
    const Vec3 origin = random.inBox(5);
    judge(worst, origin, device::load(target) - origin, box);
    judge(worst, device::load(target), thinDirection(random), box);
  }
  return worst.outcome();
}

Outcome runFarBoxes(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Vec3 place = random.inBox(i % 2 ? 1e8f : 1e-8f);
    const Box box = boxAround(place, place + random.inBox(i % 4 < 2 ? 1.0f : 1e-9f));
    const Vec3 origin = random.inBox(10);
    judge(worst, origin, (device::load(box.lower) - origin) * std::ldexp(1.0f, random.integer(-40, 40)), box);
  }
  return worst.outcome();
}

/// As many items with one centroid as there are cases: each must be in the tree once, in a box that holds it, and no path
/// may be longer than traversal has room for. Counts what is not so.
Outcome runEqualCentroids(std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  std::vector<runtime::BvhItem> items(cases);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const float size = random.between(0, 1);
    for (int axis = 0; axis < 3; ++axis) {
      items[i].bounds.lower[axis] = -size;
      items[i].bounds.upper[axis] = size;
    }
    items[i].item.instance = 0;
    items[i].item.primitive = std::uint32_t(i);
  }
  const runtime::Bvh tree = runtime::buildBvh(items);
  std::vector<int> seen(cases, 0);
  for (const RtslLeafItem &item : tree.items)
    if (item.primitive < cases)
      ++seen[item.primitive];
  for (std::uint64_t i = 0; i < cases; ++i)
    worst.count(seen[i] != 1, [&] { return "item " + std::to_string(i) + " is there " + std::to_string(seen[i]) + " times"; });
  worst.count(tree.depth() > unsigned(device::maxBvhDepth), [&] { return "a path of " + std::to_string(tree.depth()); });
  return worst.outcome();
}

double nanosecondsABox() {
  Random random(1);
  constexpr int count = 256, repeats = 2000;
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i)
    boxes.push_back(boxAround(random.inBox(1), random.inBox(1)));
  return timeOf(count * repeats, [&] {
    float sum = 0;
    for (int repeat = 0; repeat < repeats; ++repeat)
      for (const Box &box : boxes) {
        const float near = device::enterBox(box.lower, box.upper, {0, 0, -3}, {100, 50, 1}, 0, device::infinity);
        sum += near < device::infinity ? near : 0;
      }
    return sum;
  });
}

double nanosecondsABuiltItem() {
  constexpr int count = 100'000;
  Random random(1);
  std::vector<runtime::BvhItem> items(count);
  for (runtime::BvhItem &item : items) {
    const Box box = boxAround(random.inBox(1), random.inBox(1));
    for (int axis = 0; axis < 3; ++axis) {
      item.bounds.lower[axis] = box.lower[axis];
      item.bounds.upper[axis] = box.upper[axis];
    }
  }
  return timeOf(count, [&] { return runtime::buildBvh(items).nodes.size(); });
}

} // namespace

std::vector<Row> boxRows() {
  return {
      {"boxes.originsOnSlabs", "origins in the planes of sides, direction components of 0, -0 and 1e-30: boxes that the exact ray meets and that are not entered", "misses", 200'000,
       runOriginsOnSlabs, nanosecondsABox},
      {"boxes.flat", "boxes without thickness, aimed at or started from", "misses", 100'000, runFlatBoxes, nanosecondsABox},
      {"boxes.far", "boxes of size 1 and 1e-9 at 1e8 and 1e-8, directions of length 2^-40 to 2^40", "misses", 200'000, runFarBoxes, nanosecondsABox},
      {"boxes.equalCentroids", "a tree over items that all have one centroid: items lost or doubled, paths that are too long", "faults", 1'000'000, runEqualCentroids,
       nanosecondsABuiltItem},
  };
}

} // namespace rtsl::numerics
