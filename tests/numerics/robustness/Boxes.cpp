//===- Boxes.cpp - slabs, and trees over useless boxes ------------===//
#include "BoxCases.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/device/traverse/Bvh.h"

#include <string>
#include <vector>

namespace rtsl::numerics {

namespace {

bool isEntered(const Ray &ray, const Box &box) {
  const device::Vec3 inverse = {1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z};
  const float lower[] = {box.lower.x, box.lower.y, box.lower.z},
              upper[] = {box.upper.x, box.upper.y, box.upper.z};
  return device::enterBox(lower, upper, ray.origin, inverse, 0, device::infinity) <
         device::infinity;
}

Outcome runKind(const BoxKind &kind, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const BoxCase given = kind.make(random, i);
    worst.count(!isEntered(given.ray, given.box) && given.meetsExactly(),
                [&] { return given.text(); });
  }
  return worst.outcome();
}

/// As many items with one centroid as there are cases: each must be in the tree once, in a box that
/// holds it, and no path may be longer than traversal has room for. Counts what is not so.
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
  for (const RtslTreeItem &item : tree.items)
    if (item.primitive < cases)
      ++seen[item.primitive];
  for (std::uint64_t i = 0; i < cases; ++i)
    worst.count(seen[i] != 1, [&] {
      return "item " + std::to_string(i) + " is there " + std::to_string(seen[i]) + " times";
    });
  worst.count(tree.depth() > unsigned(device::maxBvhDepth),
              [&] { return "a path of " + std::to_string(tree.depth()); });
  return worst.outcome();
}

double nanosecondsABox() {
  Random random(1);
  constexpr int count = 256, repeats = 2000;
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i)
    boxes.push_back(boxAround(random.inBox(1), random.inBox(1)));
  const Ray ray = {{0, 0, -3}, {0.01f, 0.02f, 1}};
  return timeOf(count * repeats, [&] {
    int found = 0;
    for (int repeat = 0; repeat < repeats; ++repeat)
      for (const Box &box : boxes)
        found += isEntered(ray, box);
    return found;
  });
}

double nanosecondsABuiltItem() {
  constexpr int count = 100'000;
  Random random(1);
  std::vector<runtime::BvhItem> items(count);
  for (runtime::BvhItem &item : items) {
    const Box box = boxAround(random.inBox(1), random.inBox(1));
    device::store(item.bounds.lower, box.lower);
    device::store(item.bounds.upper, box.upper);
  }
  return timeOf(count, [&] { return runtime::buildBvh(items).nodes.size(); });
}

} // namespace

std::vector<Row> boxRows() {
  std::vector<Row> rows;
  for (const BoxKind &kind : boxKinds())
    rows.push_back(
        {std::string("boxes.") + kind.name, kind.description, "misses", 200'000,
         [&kind](std::uint64_t cases, std::uint32_t seed) { return runKind(kind, cases, seed); },
         nanosecondsABox});
  rows.push_back({"boxes.equalCentroids",
                  "a tree over items that all have one centroid: items lost or doubled, paths that "
                  "are too long",
                  "faults", 1'000'000, runEqualCentroids, nanosecondsABuiltItem});
  return rows;
}

} // namespace rtsl::numerics
