#include "tests/unit/runtime/FakeProgram.h"
#include "tests/unit/runtime/InstanceScenes.h"
#include "tests/unit/runtime/TraversalRays.h"

#include "runtime/device/traverse/AnyHit.h"
#include "runtime/device/traverse/Instance.h"
#include "runtime/device/traverse/Surface.h"
#include "runtime/embree/HostScene.h"
#include "runtime/scene/InstanceTransform.h"

#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::runtime;
using namespace rtsl::runtime::test;
using device::Vec3;

namespace {

/// Every triangle and sphere, one after the other, last ones first.
void bruteForce(RtslState &state) {
  const RtslLaunch &launch = *state.launch;
  const device::TriangleRay world =
      device::makeTriangleRay(device::load(state.RayOrigin), device::load(state.RayDirection));
  device::beginSearch(state);
  for (std::uint32_t i = launch.instanceCount; i-- > 0;) {
    const RtslInstance &instance = launch.instances[i];
    if (!device::isSeen(state, instance, device::LinkedSlots()))
      continue;
    const std::uint32_t count = instance.primitive == 0 ? launch.meshes[instance.mesh].triangleCount
                                                        : std::max(instance.boxCount, 1u);
    for (std::uint32_t number = count; number-- > 0;)
      device::visitInItsSpace(
          state, world, {i, number}, state.nearest, [&](const RtslLeafItem &item, const auto &ray) {
            return device::testItem(state, ray, item, rtsl_rt_Primitive_intersect);
          });
  }
  device::endSearch(state);
}

/// In long double: a component of the linear part times a vector, plus `offset`.
long double exact(const RtslTransform &transform, int row, Vec3 v, long double offset) {
  return offset + static_cast<long double>(transform.linear[row]) * v.x +
         static_cast<long double>(transform.linear[3 + row]) * v.y +
         static_cast<long double>(transform.linear[6 + row]) * v.z;
}

} // namespace

namespace {

struct HitCounts {
  int all = 0, ofInstances = 0, ofRows = 0, belowSelectors = 0, inMotion = 0, ofMovingMeshes = 0;
};

/// Random rays at random times are traced in every way.
void traceInEveryWay(const Scene &scene, unsigned seed, HitCounts &hits) {
  const HostScene embree(scene, true, 1), own(scene, false, 1);
  RtslLaunch launch = scene.launch();
  launch.host = &embree;
  // All that traversals see, but for back faces that are left out.
  EXPECT_EQ(launch.needs & RTSL_HAS_ALL, RTSL_HAS_ALL & ~RTSL_HAS_SAMPLED_BACKGROUND &
                                             ~RTSL_HAS_NO_BACKS & ~RTSL_HAS_LIGHT_TREE);
  std::mt19937 random(seed);
  for (int i = 0; i < 6000; ++i) {
    const Ray ray = randomRay(random, 1);
    const float epsilon = i % 3 ? 0 : 0.25f, distance = i % 5 ? INFINITY : 4;
    RtslState brute = makeState(own.deviceLaunch(), ray.o, ray.d, epsilon, distance);
    brute.Time = i % 11 ? float(random()) * 0x1p-32f : i % 22 ? NAN : 2;
    brute.rayMask = i % 2 ? ~0u : 2;
    brute.rayRoot = i % 7 == 0 ? 1 : 0;
    RtslState ofOwn = brute, ofEmbree = brute, any = brute;
    ofEmbree.launch = any.launch = &launch;
    bruteForce(brute);
    const bool isHit = brute.instance != RTSL_NO_HIT;
    EXPECT_EQ(own.traverse(ofOwn, 0), isHit ? RTSL_HIT : RTSL_MISS);
    EXPECT_EQ(embree.traverse(ofEmbree, 0), isHit ? RTSL_HIT : RTSL_MISS);
    EXPECT_EQ(embree.traverse(any, RTSL_FIRST_HIT), isHit ? RTSL_HIT : RTSL_MISS);
    ASSERT_NO_FATAL_FAILURE(expectSame(ofOwn, brute, i));
    ASSERT_NO_FATAL_FAILURE(expectSame(ofEmbree, brute, i));
    hits.all += isHit;
    if (!isHit)
      continue;
    const RtslInstance &hit = launch.instances[brute.instance];
    hits.ofInstances += hit.transform != 0;
    hits.inMotion += launch.transforms[hit.transform].motion != 0;
    hits.ofMovingMeshes += hit.primitive == 0 && launch.meshes[hit.mesh].keyTimes;
    hits.ofRows += hit.boxCount != 0;
    hits.belowSelectors += hit.selection != 0;
  }
}

} // namespace

TEST(Instances, AreFoundAlikeByEveryTraversal) {
  HitCounts hits;
  for (unsigned seed : {3, 11, 12, 13})
    ASSERT_NO_FATAL_FAILURE(traceInEveryWay(randomScene(seed, 60), seed, hits));
  for (unsigned seed : {14, 15})
    ASSERT_NO_FATAL_FAILURE(traceInEveryWay(randomScene(seed, few), seed, hits));
  EXPECT_GT(hits.all, 8000);
  EXPECT_GT(hits.ofInstances, 6000);
  EXPECT_GT(hits.inMotion, 100);
  EXPECT_GT(hits.ofMovingMeshes, 300);
  EXPECT_GT(hits.ofRows, 200);
  EXPECT_GT(hits.belowSelectors, 300);
}

TEST(Instances, AreDescribedInWorldSpace) {
  const Scene scene = randomScene(4, 60);
  const HostScene own(scene, false, 1);
  const RtslLaunch &launch = own.deviceLaunch();
  std::mt19937 random(6);
  int described = 0;
  for (int i = 0; i < 4000; ++i) {
    const Ray ray = randomRay(random, 1);
    RtslState state = makeState(launch, ray.o, ray.d);
    state.Time = float(random()) * 0x1p-32f;
    if (own.traverse(state, 0) != RTSL_HIT || launch.instances[state.instance].transform == 0)
      continue;
    ++described;
    const RtslInstance &instance = launch.instances[state.instance];
    const device::TransformAt atTime(launch, instance, state.Time);
    const RtslTransform &transform = atTime;
    describeHit(state, RTSL_NEEDS_ALL & ~RTSL_NEEDS_HIT_ERRORS, device::LinkedSlots());
    EXPECT_EQ(state.InstanceId,
              int(state.instance) - 23); // three instances come before those with ids
    const Vec3 normal = device::load(state.GeometricNormal);
    EXPECT_NEAR(device::dot(normal, normal), 1, 1e-6f);
    // The ray is in world space again.
    EXPECT_EQ(std::memcmp(state.RayOrigin, &ray.o, sizeof ray.o), 0);
    EXPECT_EQ(std::memcmp(state.RayDirection, &ray.d, sizeof ray.d), 0);
    // The matrices are each other's inverse.
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) {
        double sum = 0, size = 0;
        for (int k = 0; k < 4; ++k) {
          const double product = double(state.ObjectToWorld[4 * k + row]) *
                                 double(state.WorldToObject[4 * column + k]);
          sum += product;
          size += std::fabs(product);
        }
        EXPECT_NEAR(sum, row == column, 4e-7 * size + 1e-12);
      }
    if (instance.primitive != 0)
      continue;
    // The point is as close to the exact plane as its error says, and the normal that of the plane.
    const device::TriangleVertices p =
        device::triangleVertices(launch, launch.meshes[instance.mesh], state.primitive, state.Time);
    long double v[3][3];
    for (int row = 0; row < 3; ++row) {
      v[0][row] = exact(transform, row, p.v0, transform.translation[row]);
      v[1][row] = exact(transform, row, p.v1, transform.translation[row]);
      v[2][row] = exact(transform, row, p.v2, transform.translation[row]);
    }
    long double n[3], length = 0, distance = 0, along = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      n[k] = (v[1][a] - v[0][a]) * (v[2][b] - v[0][b]) - (v[1][b] - v[0][b]) * (v[2][a] - v[0][a]);
      length += n[k] * n[k];
      distance += n[k] * (state.HitPoint[k] - v[0][k]);
      along += n[k] * normal[k];
    }
    length = std::sqrt(length);
    EXPECT_LE(std::fabs(distance / length), static_cast<long double>(state.hitPointError));
    EXPECT_NEAR(double(std::fabs(along / length)), 1, 1e-5);
  }
  EXPECT_GT(described, 1000);
}

TEST(Instances, RefuseTransformsThatFlatten) {
  const auto message = [](const Transform &transform) {
    try {
      roundedTransform(transform, "ball", Place{"s.json", 3, 7, 1});
    } catch (const Error &error) {
      EXPECT_EQ(error.place->line, 3u);
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(Transform::scale(1e-6, 1e-6, 1e-6)), "");
  EXPECT_EQ(message(Transform::scale(1e6, 1e6, -1e6)), "");
  EXPECT_EQ(message(Transform::scale(1e-7, 1, 1)), "");
  EXPECT_EQ(message(Transform::scale(1e-9, 1, 1)),
            "the transform of `ball` nearly flattens it: its condition number is 1.4e+09, more "
            "than 1e+08");
  EXPECT_EQ(message(Transform::scale(0, 1, 1)), "the transform of `ball` flattens it");
  EXPECT_EQ(message(Transform::scale(1e-60, 1e-60, 1e-60)), "the transform of `ball` flattens it");
  EXPECT_EQ(message(Transform::translate(0, 1e30, 0)),
            "the transform of `ball` is out of range: row 1 of column 3 is 1e+30");
  EXPECT_EQ(message(Transform::scale(NAN, 1, 1)),
            "the transform of `ball` is out of range: row 0 of column 0 is nan");
}

TEST(Instances, HaveExactInverses) {
  std::mt19937 random(9);
  for (int i = 0; i < 1000; ++i) {
    const RtslTransform transform = roundedTransform(randomTransform(random), "x", std::nullopt);
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row) {
        long double sum = 0;
        for (int k = 0; k < 3; ++k)
          sum += static_cast<long double>(transform.linear[3 * k + row]) *
                 static_cast<long double>(transform.inverse[3 * column + k]);
        EXPECT_NEAR(double(sum), row == column, 1e-13);
      }
  }
}
