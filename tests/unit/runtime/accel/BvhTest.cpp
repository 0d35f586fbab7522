#include "tests/unit/runtime/FakeProgram.h"
#include "tests/unit/runtime/TraversalRays.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/device/traverse/Traverse.h"
#include "runtime/device/trees/Grid.h"
#include "runtime/embree/HostScene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace rtsl;
using namespace rtsl::runtime;
using namespace rtsl::runtime::test;
using device::Vec3;

namespace {

/// Of any size and anywhere, also flat.
Bounds randomBox(std::mt19937 &random, const Bounds *within = nullptr) {
  std::uniform_real_distribution<float> unit(0, 1);
  const float scale = std::ldexp(1.0f, int(random() % 200) - 100);
  const float offset = std::ldexp(unit(random) - 0.5f, int(random() % 200) - 100);
  Bounds box;
  for (int axis = 0; axis < 3; ++axis) {
    float a = unit(random), b = random() % 6 == 0 ? a : unit(random);
    if (within) {
      const float low = within->lower[axis], high = within->upper[axis];
      a = std::min(high, std::max(low, low + a * (high - low)));
      b = std::min(high, std::max(low, low + b * (high - low)));
      if (random() % 8 == 0)
        a = low;
    } else {
      a = offset + scale * a;
      b = offset + scale * b;
    }
    box.lower[axis] = std::min(a, b);
    box.upper[axis] = std::max(a, b);
  }
  return box;
}

struct RandomNode {
  Bounds all, boxes[8];
  RtslBvhNode node{};

  explicit RandomNode(std::mt19937 &random) : all(randomBox(random)) {
    device::build::setGrid(node, all);
    for (unsigned slot = 0; slot < 8; ++slot) {
      boxes[slot] = randomBox(random, &all);
      device::build::setBox(node, slot, boxes[slot]);
      node.child[slot] = RTSL_LEAF(slot, 1);
    }
  }
};

/// Towards the node's box, or one of those in it; of any length; some with components that are 0,
/// denormal or tiny, from points in the planes of sides.
Ray rayAtNode(std::mt19937 &random, const RandomNode &made) {
  std::uniform_real_distribution<float> unit(-1, 1);
  const Bounds &box = random() % 2 ? made.all : made.boxes[random() % 8];
  float origin[3], direction[3];
  const float distance = std::ldexp(1.0f, int(random() % 60) - 30);
  for (int axis = 0; axis < 3; ++axis) {
    const float size = made.all.upper[axis] - made.all.lower[axis];
    const float share = 0.5f + 0.6f * unit(random);
    const float target = box.lower[axis] + share * (box.upper[axis] - box.lower[axis]);
    origin[axis] = target + distance * size * unit(random);
    if (random() % 4 == 0)
      origin[axis] = random() % 2 ? box.lower[axis] : box.upper[axis];
    direction[axis] = target - origin[axis];
    if (random() % 8 == 0)
      direction[axis] = random() % 2 ? 0.0f : -0.0f;
    if (random() % 16 == 0)
      direction[axis] = std::ldexp(unit(random), -int(random() % 149));
  }
  const float length = random() % 2 ? 1.0f : std::ldexp(1.0f, int(random() % 180) - 90);
  return {device::load(origin), device::load(direction) * length};
}

/// Its product with itself is finite, and it is not zero.
bool isTraceable(const Ray &ray) {
  return device::isFinite(ray.o) && device::isFinite(ray.d) && !device::isZero(ray.d);
}

} // namespace

TEST(WideTree, BoxesOnTheGridContainTheirs) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    const RandomNode made(random);
    for (unsigned slot = 0; slot < 8; ++slot)
      for (int axis = 0; axis < 3; ++axis) {
        // Exact: 113 bits are enough for these sizes.
        const __float128 origin = made.node.origin[axis],
                         step = std::ldexp(1.0, int(made.node.exponent[axis]) - 127);
        const __float128 lower = origin + step * made.node.lower[axis][slot],
                         upper = origin + step * made.node.upper[axis][slot];
        ASSERT_TRUE(lower <= made.boxes[slot].lower[axis]) << i;
        ASSERT_TRUE(upper >= made.boxes[slot].upper[axis]) << i;
      }
  }
}

// The property that bits of pictures depend on: no child is left out if an item in it may be hit.
TEST(Bvh, ChildrenAreEnteredWhereverRaysHaveARangeInTheirBoxes) {
  std::mt19937 random(2);
  int met = 0, exact = 0, missed = 0;
  for (int i = 0; i < 300000; ++i) {
    const RandomNode made(random);
    const Ray ray = rayAtNode(random, made);
    if (!isTraceable(ray))
      continue;
    const device::TriangleRay triangleRay = device::makeTriangleRay(ray.o, ray.d);
    const float tMin = random() % 4 ? 0 : std::ldexp(1.0f, int(random() % 80) - 40),
                tMax = random() % 2 ? INFINITY : std::ldexp(1.0f, int(random() % 120) - 60);
    const std::uint32_t flipped = device::flippedSlots(triangleRay);
    const float widened = tMax * (device::bvhSlack * device::bvhSlack);
    const std::uint32_t entered = device::enteredChildren(device::NodeWords(made.node), made.node,
                                                          triangleRay, flipped, tMin, widened);
    const std::uint32_t exactly =
        device::enteredExactly(made.node, triangleRay, flipped, tMin, tMax);
    for (unsigned slot = 0; slot < 8; ++slot) {
      const bool meets = device::enterBox(made.boxes[slot].lower, made.boxes[slot].upper, ray.o,
                                          triangleRay.inverse, tMin, tMax) < device::infinity;
      ASSERT_TRUE(!meets || entered >> slot & 1) << i << ", " << slot;
      ASSERT_TRUE(!meets || exactly >> slot & 1) << i << ", " << slot;
      met += meets;
      exact += exactly >> slot & 1;
      missed += !(entered >> slot & 1);
    }
  }
  EXPECT_GT(met, 200000);
  EXPECT_GT(missed, 200000); // it does not simply enter all
  EXPECT_LT(exact, 2 * met);
}

namespace {

/// Calls visit(ray, the inverse of its direction, boxes) for rays at 300,000 nodes, up to the first
/// failure.
template <typename Visit>
void forRaysAtNodes(std::mt19937 &random, Visit visit) {
  for (int i = 0; i < 300000 && !testing::Test::HasFatalFailure(); ++i) {
    const RandomNode made(random);
    const Ray ray = rayAtNode(random, made);
    if (isTraceable(ray))
      visit(ray, device::makeTriangleRay(ray.o, ray.d).inverse, made.boxes);
  }
}

} // namespace

// The same for the boxes of scenes without a tree, whose first test is another one.
TEST(Bvh, ListedBoxesAreEnteredWhereverRaysHaveARangeInThem) {
  std::mt19937 random(4);
  int met = 0, entered = 0, missed = 0;
  forRaysAtNodes(random, [&](const Ray &ray, Vec3 inverse, const auto &boxes) {
    const device::ListedBoxRay boxRay(ray.o, inverse);
    const float tMin = random() % 4 ? 0 : std::ldexp(1.0f, int(random() % 80) - 40),
                tMax = random() % 2 ? INFINITY : std::ldexp(1.0f, int(random() % 120) - 60);
    for (const Bounds &box : boxes) {
      const bool meets =
          device::enterBox(box.lower, box.upper, ray.o, inverse, tMin, tMax) < device::infinity;
      const bool enters = boxRay.mayEnter(device::listedBox(box.lower, box.upper), tMin, tMax);
      ASSERT_TRUE(!meets || enters) << met;
      met += meets;
      entered += enters;
      missed += !enters;
    }
  });
  EXPECT_GT(met, 200000);
  EXPECT_GT(missed, 200000);   // it does not simply enter all
  EXPECT_LT(entered, 3 * met); // half of the rays have axes that leave out nothing
}

TEST(Bvh, RaysHaveNoRangeInListedBoxesThatEndBeforeTheyStart) {
  std::mt19937 random(6);
  int ends = 0;
  forRaysAtNodes(random, [&](const Ray &ray, Vec3 inverse, const auto &boxes) {
    const float tMin = std::ldexp(1.0f, int(random() % 80) - 40);
    for (const Bounds &box : boxes)
      if (device::endsBefore(device::listedBox(box.lower, box.upper), ray.o, inverse, tMin)) {
        ++ends;
        ASSERT_FALSE(device::enterBox(box.lower, box.upper, ray.o, inverse, tMin, INFINITY) <
                     device::infinity)
            << ends;
      }
  });
  EXPECT_GT(ends, 150000);
}

TEST(Bvh, ListedBoxesOfRoomsLeaveOutAsManyAsTheExactTest) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  int met = 0, entered = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3 origin = {10 * unit(random), 10 * unit(random), 10 * unit(random)},
               direction = {unit(random), unit(random), unit(random)};
    const Vec3 inverse = device::makeTriangleRay(origin, direction).inverse;
    float lower[3], upper[3];
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = 10 * unit(random);
      upper[axis] = lower[axis] + (random() % 3 ? 3 : 1e-4f) * (1 + unit(random));
    }
    met += device::enterBox(lower, upper, origin, inverse, 0, INFINITY) < device::infinity;
    entered += device::ListedBoxRay(origin, inverse)
                   .mayEnter(device::listedBox(lower, upper), 0, INFINITY);
  }
  EXPECT_GT(met, 500);
  EXPECT_LE(entered, met + met / 50);
}

namespace {

/// Small triangles everywhere in a cube, some of them in planes of the axes.
Scene cloud(int triangles) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> wide(-10, 10), small(-0.2f, 0.2f);
  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
  Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const float centre[3] = {wide(random), std::round(wide(random)), wide(random)};
    const bool isFlat = random() % 2;
    for (unsigned corner = 0; corner < 3; ++corner) {
      for (int axis = 0; axis < 3; ++axis)
        mesh.positions.push_back(centre[axis] + (isFlat && axis == 1 ? 0 : small(random)));
      mesh.indices.push_back(3 * unsigned(i) + corner);
    }
  }
  scene.addMeshInstance(scene.addMesh(std::move(mesh)), scene.addObject("Normal", members({})));
  return scene;
}

/// The nodes that a ray visits if nothing in its way counts.
int visitedNodes(const RtslLaunch &launch, const Ray &ray) {
  int nodes = 0;
  device::traverseBvh(
      launch, device::makeTriangleRay(ray.o, ray.d), 0,
      [&] {
        ++nodes;
        return device::infinity;
      },
      false, [](const RtslTreeItem &) { return false; });
  return nodes;
}

} // namespace

// A product of 0 and infinity is no number, and a comparison with it must not lead a ray through
// all of a tree.
TEST(Bvh, UnusualNumbersDoNotLeadRaysEverywhere) {
  const Scene scene = cloud(20000);
  const HostScene host(scene, false, 1);
  const RtslLaunch &launch = host.deviceLaunch();
  std::mt19937 random(4);
  std::uniform_real_distribution<float> wide(-10, 10);
  const float small[] = {0.0f, -0.0f, 1e-45f, -1e-40f, 1e-38f, 1e-30f, -1e-20f};
  long usual = 0, unusual = 0;
  int most = 0;
  for (int i = 0; i < 2000; ++i) {
    Vec3 origin = {wide(random), wide(random), wide(random)};
    if (i % 3 == 0) // in the plane of many triangles, and of sides of boxes
      origin.y = std::round(origin.y);
    const float a = small[random() % 7], b = small[random() % 7];
    const float sign = random() % 2 ? 1.0f : -1.0f;
    const Vec3 axes[] = {{sign, a, b}, {a, sign, b}, {a, b, sign}, {a, sign, sign}};
    const Vec3 tilted[] = {
        {sign, 1e-5f, 2e-5f}, {1e-5f, sign, 2e-5f}, {1e-5f, 2e-5f, sign}, {1e-5f, sign, sign}};
    const int number = visitedNodes(launch, {origin, axes[i % 4]});
    unusual += number;
    usual += visitedNodes(launch, {origin, tilted[i % 4]});
    most = std::max(most, number);
  }
  EXPECT_LT(unusual, usual + usual / 10);
  EXPECT_LT(most, int(launch.nodeCount) / 8);
  // Beyond the usual exponents.
  for (float scale : {1e-39f, 1e-30f, 1e30f, 1e37f}) {
    long scaled = 0, plain = 0;
    for (int i = 0; i < 100; ++i) {
      const Vec3 origin = {wide(random), wide(random), wide(random)},
                 direction = {wide(random), wide(random), 10};
      scaled += visitedNodes(launch, {origin, direction * scale});
      plain += visitedNodes(launch, {origin, direction});
    }
    EXPECT_LE(scaled, plain + plain / 10) << scale;
  }
  EXPECT_EQ(visitedNodes(launch, {{1e30f, 0, 0}, {1, 0, 0}}), 1);
}

TEST(Bvh, AnEmptySceneHasANode) {
  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
  const HostScene host(scene, false, 1);
  EXPECT_EQ(host.deviceLaunch().nodeCount, 1u);
  EXPECT_EQ(visitedNodes(host.deviceLaunch(), {{0, 0, 0}, {0, 0, 1}}), 1);
}
