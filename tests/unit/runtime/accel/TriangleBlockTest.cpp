// Eight triangles at once, beside the same eight one by one: the same hit, to the bit.
#include "runtime/accel/TriangleBlock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

using namespace rtsl::runtime;
using rtsl::device::TriangleRay;
using rtsl::device::TriangleVertices;
using rtsl::device::Vec3;

namespace {

class Blocks {
public:
  explicit Blocks(unsigned seed) : random(seed) {}

  float unit() { return std::uniform_real_distribution<float>(-1, 1)(random); }
  unsigned below(unsigned n) { return unsigned(random() % n); }
  Vec3 point(float scale) { return {scale * unit(), scale * unit(), scale * unit()}; }

  /// Triangles that are large, small, needles, without area, or equal; some lanes are empty.
  TriangleBlock block(float scale) {
    TriangleBlock block;
    TriangleVertices before{point(scale), point(scale), point(scale)};
    const unsigned used = 1 + below(TriangleBlock::lanes);
    for (unsigned lane = 0; lane < TriangleBlock::lanes; ++lane) {
      TriangleVertices p{point(scale), point(scale), point(scale)};
      switch (below(8)) {
      case 0:
        p = before;
        break;
      case 1:
        p.v2 = p.v1;
        break;
      case 2:
        p.v2 = (p.v0 + p.v1) * 0.5f;
        break;
      case 3:
        p.v1 = p.v0 + point(scale * 0x1p-20f);
        break;
      case 4:
        p.v0.z = p.v1.z = p.v2.z = scale * 0.25f;
        break;
      }
      before = p;
      if (lane >= used)
        p = block.lane(0);
      block.setLane(lane, p, lane < used ? below(3) : RTSL_NO_HIT, lane ^ 5u);
    }
    return block;
  }

  /// From anywhere, or from a vertex or an inner point of a triangle.
  TriangleRay ray(const TriangleBlock &block, float scale) {
    const TriangleVertices p = block.lane(below(TriangleBlock::lanes)),
                           to = block.lane(below(TriangleBlock::lanes));
    Vec3 origin = point(2 * scale);
    if (below(3) == 0)
      origin = p.v0;
    else if (below(2) == 0)
      origin = p.v0 * 0.5f + p.v1 * 0.25f + p.v2 * 0.25f;
    Vec3 direction = (to.v0 + to.v1 + to.v2) * (1.0f / 3) - origin;
    if (below(4) == 0 || rtsl::device::isZero(direction))
      direction = {0, unit(), 1};
    else if (below(4) == 0)
      direction = to.v0 - origin;
    if (below(4) == 0)
      direction = direction * std::ldexp(1.0f, int(below(100)) - 50);
    if (rtsl::device::isZero(direction) || !rtsl::device::isFinite(direction))
      direction = {1, 0, 0};
    return rtsl::device::makeTriangleRay(origin, direction);
  }

  RtslState state() {
    RtslState state;
    std::memset(&state, 0x7f, sizeof state);
    state.launch = &launch;
    state.Epsilon = below(3) ? 0 : 0x1p-10f;
    state.HitDistance = below(3) ? INFINITY : 0.5f + 0.5f * unit();
    state.instance = state.primitive = RTSL_NO_HIT;
    rtsl::device::beginSearch(state);
    return state;
  }

private:
  std::mt19937 random;
  RtslLaunch launch{}; // its scene needs nothing, and all triangles have back faces
};

/// The vertices of a triangle of the block.
rtsl::device::TriangleVertices verticesIn(const TriangleBlock &block, std::uint32_t instance,
                                          std::uint32_t triangle) {
  unsigned lane = 0;
  while (block.instance[lane] != instance || block.triangle[lane] != triangle)
    ++lane;
  return block.lane(lane);
}

} // namespace

TEST(TriangleBlock, FindsWhatTheTrianglesFindOneByOne) {
  Blocks blocks(1);
  int hits = 0, kept = 0;
  for (int exponent = -140; exponent <= 58; ++exponent)
    for (int i = 0; i < 400; ++i) {
      const float scale = std::ldexp(1.0f, exponent);
      const TriangleBlock block = blocks.block(scale);
      const TriangleRay ray = blocks.ray(block, scale);
      RtslState together = blocks.state(), alone = together, any = together;
      const bool found = testBlock(together, ray, block, false);
      bool foundAlone = false;
      for (unsigned lane = TriangleBlock::lanes; lane-- > 0;)
        if (block.instance[lane] != RTSL_NO_HIT)
          foundAlone |= rtsl::device::testTriangle(alone, ray, block.lane(lane),
                                                   block.instance[lane], block.triangle[lane]);
      ASSERT_EQ(found, foundAlone) << exponent << ' ' << i;
      ASSERT_EQ(testBlock(any, ray, block, true), found);
      if (found && together.vertices) {
        const auto expected = verticesIn(block, together.instance, together.primitive),
                   read = rtsl::device::verticesOfHit(together, RtslMesh{});
        ASSERT_EQ(std::memcmp(&read, &expected, sizeof read), 0) << exponent << ' ' << i;
        ++kept;
      }
      together.vertices = alone.vertices;
      ASSERT_EQ(std::memcmp(&together, &alone, sizeof alone), 0) << exponent << ' ' << i;
      hits += found;
    }
  EXPECT_GT(hits, 199 * 100);
  EXPECT_GT(kept, hits / 4);
}
