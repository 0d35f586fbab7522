#include "tests/unit/runtime/FakeProgram.h"
#include "tests/unit/runtime/TraversalRays.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/device/traverse/Traverse.h"
#include "runtime/device/trees/Bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <random>

using namespace rtsl;
using namespace rtsl::runtime;
using namespace rtsl::runtime::test;

namespace {

/// What a tree must be: each item is in one leaf, and each box on a grid contains the boxes below.
class Checked {
public:
  Checked(const Bvh &tree, const std::vector<BvhItem> &items) : tree(tree), items(items) {
    seen.resize(items.size());
    visit(0, 1);
    EXPECT_EQ(visitedNodes, tree.nodes.size());
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(items.size()));
    EXPECT_EQ(tree.items.size(), items.size());
  }

  unsigned depth = 0;

private:
  Bounds visit(std::uint32_t number, unsigned depthHere) {
    ++visitedNodes;
    depth = std::max(depth, depthHere);
    const RtslBvhNode &node = tree.nodes[number];
    Bounds all = device::build::emptyBox();
    std::uint32_t inner = 0;
    for (unsigned slot = 0; slot < 8; ++slot) {
      if (node.child[slot] == 0)
        continue;
      Bounds below = device::build::emptyBox();
      if (node.inner >> slot & 1)
        below = visit(node.firstNode + inner++, depthHere + 1);
      else
        for (std::uint32_t bits = device::childBits(node.child[slot], 0); bits; bits &= bits - 1)
          device::build::extend(below, item(node.firstItem + std::uint32_t(__builtin_ctz(bits))));
      expectInside(node, slot, below);
      device::build::extend(all, below);
    }
    return all;
  }

  const Bounds &item(std::uint32_t number) {
    const std::uint32_t primitive = tree.items[number].primitive;
    ++seen[primitive];
    return items[primitive].bounds;
  }

  static void expectInside(const RtslBvhNode &node, unsigned slot, const Bounds &box) {
    for (int axis = 0; axis < 3; ++axis) {
      const __float128 origin = node.origin[axis],
                       step = std::ldexp(1.0, int(node.exponent[axis]) - 127);
      EXPECT_TRUE(origin + step * node.lower[axis][slot] <= box.lower[axis]);
      EXPECT_TRUE(origin + step * node.upper[axis][slot] >= box.upper[axis]);
    }
  }

  const Bvh &tree;
  const std::vector<BvhItem> &items;
  std::vector<int> seen; // how often
  std::size_t visitedNodes = 0;
};

using Corners = std::function<Bounds(std::uint32_t)>;

std::vector<BvhItem> itemsOf(std::uint32_t count, const Corners &boxOf) {
  std::vector<BvhItem> items;
  for (std::uint32_t i = 0; i < count; ++i)
    items.push_back({boxOf(i), {0, i}});
  return items;
}

Bounds smallBox(std::mt19937 &random, float size = 1) {
  std::uniform_real_distribution<float> wide(-10, 10), small(0, 0.2f);
  Bounds box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = size * wide(random);
    box.upper[axis] = box.lower[axis] + size * small(random);
  }
  return box;
}

Bvh fastTree(const std::vector<BvhItem> &items, unsigned threads = 0) {
  return buildBvh(items, threads, TreeKind::Fast);
}

} // namespace

TEST(ClusterTree, HoldsEachItemOnceInBoxesThatContainIt) {
  std::mt19937 random(1);
  std::vector<std::uint32_t> counts = {100, 1023, 1024, 1025, 5000, 70000};
  for (std::uint32_t count = 1; count < 40; ++count)
    counts.push_back(count);
  for (const std::uint32_t count : counts) {
    SCOPED_TRACE(count);
    const auto items = itemsOf(count, [&](std::uint32_t) { return smallBox(random); });
    Checked(fastTree(items), items);
  }
}

TEST(ClusterTree, DoesNotDependOnThreads) {
  std::mt19937 random(2);
  const auto items = itemsOf(30000, [&](std::uint32_t) { return smallBox(random); });
  const Bvh one = fastTree(items, 1), all = fastTree(items);
  ASSERT_EQ(one.nodes.size(), all.nodes.size());
  EXPECT_EQ(std::memcmp(one.nodes.data(), all.nodes.data(), one.nodes.size() * sizeof one.nodes[0]),
            0);
  EXPECT_EQ(std::memcmp(one.items.data(), all.items.data(), one.items.size() * sizeof one.items[0]),
            0);
}

TEST(ClusterTree, StaysShallowWhateverTheItems) {
  std::mt19937 random(3);
  const Corners equal = [](std::uint32_t) { return Bounds{{1, 1, 1}, {2, 2, 2}}; };
  const Corners point = [](std::uint32_t) { return Bounds{{-7, 0, 1}, {-7, 0, 1}}; };
  // Each a little larger than all before it together, so that one pair is joined in a round.
  const Corners nested = [](std::uint32_t i) {
    const float size = std::pow(1.004f, float(i));
    return Bounds{{-size, -size, 0}, {3 * size, size, size}};
  };
  const Corners apart = [](std::uint32_t i) {
    const float x = std::pow(1.015f, float(i % 5000));
    return Bounds{{x, 0, 0}, {x, 0, 0}};
  };
  const Corners grid = [](std::uint32_t i) {
    const float x = float(i % 100), y = float(i / 100);
    return Bounds{{x, y, 0}, {x + 1, y + 1, 0}};
  };
  const Corners huge = [&](std::uint32_t) { return smallBox(random, 1e30f); };
  const Corners largest = [&](std::uint32_t) { return smallBox(random, 1.6e37f); };
  const Corners tiny = [&](std::uint32_t) { return smallBox(random, 1e-44f); };
  struct Case {
    const char *name;
    const Corners &boxOf;
    unsigned depth;
  };
  for (const Case &one :
       {Case{"equal", equal, 12}, Case{"point", point, 16}, Case{"nested", nested, 63},
        Case{"apart", apart, 63}, Case{"grid", grid, 12}, Case{"huge", huge, 63},
        Case{"largest", largest, 63}, Case{"tiny", tiny, 63}}) {
    SCOPED_TRACE(one.name);
    const auto items = itemsOf(20000, one.boxOf);
    const Bvh tree = fastTree(items);
    const unsigned depth = Checked(tree, items).depth;
    EXPECT_EQ(depth, tree.depth());
    EXPECT_LE(depth, one.depth);
    EXPECT_LE(depth, unsigned(device::maxBvhDepth));
  }
}

TEST(ClusterTree, IsNearlyAsGoodAsTheOther) {
  std::mt19937 random(4);
  const auto items = itemsOf(50000, [&](std::uint32_t) { return smallBox(random); });
  const Bvh good = buildBvh(items), fast = fastTree(items);
  EXPECT_GT(good.cost, 1);
  EXPECT_LT(fast.cost, 1.1f * good.cost);
}
