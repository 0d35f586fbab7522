// The tree over blocks of triangles, beside a test of every block: the same hit, to the bit.
#include "tests/unit/runtime/TraversalRays.h"

#include "runtime/accel/BlockSearch.h"
#include "runtime/accel/BlockTree.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

using namespace rtsl;
using namespace rtsl::runtime;
using namespace rtsl::runtime::test;
using device::TriangleRay;
using device::Vec3;

namespace {

/// Meshes of random triangles around centres that are scattered over `spread`.
class Soup {
public:
  Soup(unsigned seed, std::size_t triangles, float spread, float size) : random(seed) {
    for (std::size_t i = 0; i < triangles; ++i) {
      const Vec3 centre = point(spread);
      for (int corner = 0; corner < 3; ++corner) {
        const Vec3 p = centre + point(size);
        positions.insert(positions.end(), {p.x, p.y, p.z});
      }
    }
    for (std::uint32_t i = 0; i < 3 * triangles; ++i)
      indices.push_back(i);
    mesh.positions = positions.data();
    mesh.indices = indices.data();
    mesh.vertexCount = std::uint32_t(positions.size() / 3);
    mesh.triangleCount = std::uint32_t(triangles);
    mesh.keyCount = 1;
    launch.meshes = &mesh;
    launch.meshCount = 1;
    launch.instances = &instance;
    launch.instanceCount = 1;
  }

  Vec3 point(float scale) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const float x = unit(random), y = unit(random), z = unit(random);
    return {scale * x, scale * y, scale * z};
  }

  std::mt19937 random;
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  RtslMesh mesh{};
  RtslInstance instance{};
  RtslLaunch launch{};
};

struct Found {
  RtslState state;
  std::size_t tests = 0;
};

Found searchTree(const RtslLaunch &launch, const BlockTree &tree, const Ray &ray,
                 float epsilon = 0) {
  Found found{makeState(launch, ray.o, ray.d, epsilon)};
  device::beginSearch(found.state);
  const TriangleRay triangleRay = device::makeTriangleRay(ray.o, ray.d);
  searchBlocks(
      tree, triangleRay, epsilon, [&] { return found.state.nearest; },
      [&](std::uint32_t place) {
        ++found.tests;
        testBlock(found.state, triangleRay, tree.block(place), false);
        return false;
      });
  device::endSearch(found.state);
  return found;
}

Found testAll(const RtslLaunch &launch, const BlockTree &tree, const Ray &ray, float epsilon = 0) {
  Found found{makeState(launch, ray.o, ray.d, epsilon)};
  device::beginSearch(found.state);
  const TriangleRay triangleRay = device::makeTriangleRay(ray.o, ray.d);
  for (const TriangleBlock &block : tree.blocks)
    testBlock(found.state, triangleRay, block, false);
  device::endSearch(found.state);
  return found;
}

/// Returns how many of the rays hit something.
int expectSameHits(Soup &soup, const BlockTree &tree, int rays, float scale) {
  int hits = 0;
  for (int i = 0; i < rays; ++i) {
    Ray ray = randomRay(soup.random, scale);
    if (i % 4 == 0) // from the surface of a triangle
      ray.o = device::load(&soup.positions[9 * (soup.random() % soup.mesh.triangleCount)]);
    const float epsilon = i % 5 == 0 ? -scale : i % 5 == 1 ? -0.0f : i % 5 == 2 ? scale : 0;
    const Found all = testAll(soup.launch, tree, ray, epsilon);
    expectSame(all.state, searchTree(soup.launch, tree, ray, epsilon).state, i);
    hits += all.state.instance != RTSL_NO_HIT;
  }
  return hits;
}

TEST(BlockTree, FindsTheSameHitsAsATestOfEveryBlock) {
  for (const float scale : {1.0f, 0x1p-40f, 0x1p40f}) {
    for (const std::size_t triangles : {1u, 8u, 9u, 300u, 5000u}) {
      Soup soup(unsigned(triangles), triangles, 10 * scale, scale);
      const BlockTree tree({{0, &soup.mesh}}, 2);
      const int hits = expectSameHits(soup, tree, 400, scale);
      if (triangles > 1000)
        EXPECT_GT(hits, 100) << scale;
    }
  }
}

TEST(BlockTree, IsEmptyWithoutTriangles) {
  Soup soup(1, 0, 1, 1);
  const BlockTree tree({{0, &soup.mesh}}, 1);
  EXPECT_TRUE(tree.isEmpty());
  EXPECT_GT(tree.bounds().lower[0], tree.bounds().upper[0]);
  EXPECT_EQ(searchTree(soup.launch, tree, {{0, 0, 0}, {0, 0, 1}}).tests, 0u);
}

TEST(BlockTree, HasEveryBlockOnceAndChildrenAfterTheirParent) {
  Soup soup(3, 5000, 10, 1);
  const BlockTree tree({{0, &soup.mesh}}, 2);
  std::vector<int> ofBlocks(tree.blocks.size()), ofNodes(tree.nodes.size());
  for (std::size_t i = 0; i < tree.nodes.size(); ++i)
    for (const std::uint32_t child : tree.nodes[i].children) {
      if (child & BlockNode::isBlock) {
        ++ofBlocks[numberAt<TriangleBlock>(child & ~BlockNode::isBlock)];
      } else if (child != BlockNode::none) {
        EXPECT_GT(numberAt<BlockNode>(child), i);
        ++ofNodes[numberAt<BlockNode>(child)];
      }
    }
  EXPECT_EQ(ofBlocks, std::vector<int>(ofBlocks.size(), 1));
  ofNodes[0] = 1;
  EXPECT_EQ(ofNodes, std::vector<int>(ofNodes.size(), 1));
}

TEST(BlockTree, TestsFewBlocks) {
  Soup soup(4, 20000, 10, 0.1f);
  const BlockTree tree({{0, &soup.mesh}}, 2);
  std::size_t tests = 0;
  for (int i = 0; i < 100; ++i)
    tests += searchTree(soup.launch, tree, {soup.point(10), soup.point(1)}).tests;
  EXPECT_LT(tests, 100 * tree.blocks.size() / 20);
}

TEST(BlockTree, DoesNotDependOnTheNumberOfThreads) {
  Soup soup(5, 40000, 10, 0.1f);
  const BlockTree one({{0, &soup.mesh}}, 1), four({{0, &soup.mesh}}, 4);
  ASSERT_EQ(one.nodes.size(), four.nodes.size());
  ASSERT_EQ(one.blocks.size(), four.blocks.size());
  EXPECT_EQ(
      std::memcmp(one.nodes.begin(), four.nodes.begin(), one.nodes.size() * sizeof one.nodes[0]),
      0);
  EXPECT_EQ(std::memcmp(one.blocks.begin(), four.blocks.begin(),
                        one.blocks.size() * sizeof one.blocks[0]),
            0);
}

TEST(BlockTree, FollowsTrianglesThatMove) {
  Soup soup(6, 3000, 10, 0.5f);
  BlockTree tree({{0, &soup.mesh}}, 2);
  EXPECT_EQ(tree.degradation(), 1);
  for (int step = 0; step < 3; ++step) {
    for (float &x : soup.positions)
      x += std::uniform_real_distribution<float>(-0.5f, 0.5f)(soup.random);
    for (std::size_t i = 0; i < tree.blocks.size(); ++i) {
      TriangleBlock &block = tree.blocks[i];
      for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane)
        block.setLane(lane, device::triangleVertices(soup.mesh, block.triangle[lane]),
                      block.instance[lane], block.triangle[lane]);
    }
    tree.refit(2);
    EXPECT_GT(expectSameHits(soup, tree, 400, 1), 50);
  }
  EXPECT_GT(tree.degradation(), 1.05);
}

} // namespace
