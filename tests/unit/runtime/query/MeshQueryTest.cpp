// Rays of an application's own: against all triangles one by one, whatever the threads and turns.
#include "runtime/query/MeshQuery.h"
#include "tests/unit/runtime/InstanceScenes.h"

#include "runtime/device/traverse/TestItem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

using namespace rtsl::runtime;
using namespace rtsl::runtime::test;

namespace {

std::vector<QueryRay> randomRays(std::mt19937 &random, std::size_t count) {
  std::uniform_real_distribution<float> wide(-2, 2), late(0, 3);
  std::vector<QueryRay> rays(count);
  for (QueryRay &ray : rays) {
    for (int i = 0; i < 3; ++i) {
      ray.origin[i] = wide(random);
      ray.direction[i] = wide(random);
    }
    ray.tMin = 0;
    ray.tMax = random() % 2 ? std::numeric_limits<float>::infinity() : late(random);
  }
  rays[1].direction[0] = std::nanf("");
  std::fill_n(rays[2].direction, 3, 0.0f);
  return rays;
}

/// The nearest of all triangles, of two at the same distance the first.
QueryHit expected(const Mesh &mesh, const QueryRay &ray) {
  QueryHit nearest = {-1, -1, 0, 0};
  const auto hasDirection = [&](float x) { return x != 0; };
  if (!std::all_of(ray.direction, ray.direction + 3, [](float x) { return std::isfinite(x); }) ||
      std::none_of(ray.direction, ray.direction + 3, hasDirection))
    return nearest;
  const auto triangleRay = rtsl::device::makeTriangleRay(rtsl::device::load(ray.origin),
                                                         rtsl::device::load(ray.direction));
  for (std::size_t i = 0; i < mesh.triangleCount(); ++i) {
    const auto vertex = [&](std::size_t corner) {
      return rtsl::device::load(&mesh.positions[3 * mesh.indices[3 * i + corner]]);
    };
    const rtsl::device::TriangleVertices vertices = {vertex(0), vertex(1), vertex(2)};
    rtsl::device::TriangleHit hit;
    if (rtsl::device::intersectTriangle(triangleRay, vertices.v0, vertices.v1, vertices.v2, hit) &&
        rtsl::device::moveIntoBox(triangleRay, vertices, hit.t) && hit.t > ray.tMin &&
        hit.t < ray.tMax && (nearest.triangle < 0 || hit.t < nearest.t))
      nearest = {hit.t, std::int32_t(i), hit.u, hit.v};
  }
  return nearest;
}

} // namespace

TEST(MeshQuery, HitsDoNotDependOnThreadsAndTurns) {
  std::mt19937 random(11);
  const Mesh mesh = clump(random, 300);
  const std::vector<QueryRay> rays = randomRays(random, 5000); // more than one thread takes at once
  std::vector<QueryHit> all;
  std::size_t found = 0;
  for (const QueryRay &ray : rays) {
    all.push_back(expected(mesh, ray));
    found += all.back().triangle >= 0;
  }
  EXPECT_GT(found, 500u);
  EXPECT_LT(found, 4500u);
  for (const unsigned threads : {1u, 3u})
    for (const unsigned inTurns : {0u, 1u, 2u, 3u, 8u}) {
      const MeshQuery query(mesh, threads, inTurns);
      std::vector<QueryHit> hits(rays.size());
      query.nearest(rays.data(), rays.size(), hits.data());
      std::vector<std::uint8_t> any(rays.size());
      query.any(rays.data(), rays.size(), any.data());
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(std::memcmp(&hits[i], &all[i], sizeof all[i]), 0) << i << ", " << inTurns;
        ASSERT_EQ(any[i], all[i].triangle >= 0) << i << ", " << inTurns;
      }
    }
}

TEST(MeshQuery, TreesFollowVerticesThatMove) {
  std::mt19937 random(12);
  Mesh mesh = clump(random, 100);
  const std::vector<QueryRay> rays = randomRays(random, 500);
  MeshQuery query(mesh, 1, 3);
  for (float &x : mesh.positions)
    x = 1.5f * x + 0.25f;
  query.move(mesh.positions);
  std::vector<QueryHit> hits(rays.size());
  query.nearest(rays.data(), rays.size(), hits.data());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const QueryHit one = expected(mesh, rays[i]);
    ASSERT_EQ(std::memcmp(&hits[i], &one, sizeof one), 0) << i;
  }
}
