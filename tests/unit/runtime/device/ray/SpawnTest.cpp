#include "tests/unit/runtime/FakeProgram.h"

#include "runtime/device/ray/Spawn.h"
#include "runtime/device/traverse/Surface.h"
#include "runtime/embree/HostScene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace rtsl::runtime;
using namespace rtsl::runtime::test;
using namespace rtsl::device;

namespace {

RtslState makeRay(const RtslLaunch &launch, Vec3 o, Vec3 d, float epsilon) {
  RtslState state{};
  state.rayMask = ~0u;
  state.launch = &launch;
  store(state.RayOrigin, o);
  store(state.RayDirection, d);
  state.Epsilon = epsilon;
  state.HitDistance = INFINITY;
  state.instance = state.primitive = RTSL_NO_HIT;
  return state;
}

Vec3 onSphere(std::mt19937 &random) {
  std::normal_distribution<float> normal;
  return normalized({normal(random), normal(random), normal(random)});
}

struct Counts {
  int spawned = 0, selfHits = 0, passed = 0;
};

/// Hits the object from all sides, leaves it in all directions, and counts rays that meet it again
/// where they must not. `away`: do all rays in the direction leave it?
template <typename Leaves>
Counts leaveSurface(const Scene &scene, Vec3 centre, float size, float scaleOfDirections,
                    Leaves leaves) {
  Counts counts;
  std::mt19937 random(11);
  for (bool useEmbree : {true, false}) {
    HostScene host(scene, useEmbree, 1);
    RtslLaunch launch = useEmbree ? scene.launch() : host.deviceLaunch();
    for (int i = 0; i < 20000; ++i) {
      Vec3 o = centre + onSphere(random) * (size * (1.5f + float(i % 100)));
      RtslState hit = makeRay(
          launch, o, ((centre + onSphere(random) * (0.6f * size)) - o) * scaleOfDirections, 0);
      if (host.traverse(hit, false) != RTSL_HIT)
        continue;
      describeHit(hit);
      Vec3 d = onSphere(random) * scaleOfDirections, p = load(hit.HitPoint),
           n = load(hit.GeometricNormal);
      float epsilon = spawnEpsilon(hit, p, d);
      float cosine = std::fabs(dot(normalized(d), normalized(n)));
      if (cosine < 0x1p-11f) // the bound is given up there
        continue;
      EXPECT_GE(epsilon, 0);
      RtslState next = makeRay(launch, p, d, epsilon);
      std::uint32_t found = host.traverse(next, false);
      if (leaves(d, n)) {
        ++counts.spawned;
        counts.selfHits += found == RTSL_HIT;
      } else {
        counts.passed += found == RTSL_HIT;
      }
    }
  }
  return counts;
}

Scene sphereScene(double x, double y, double z, double radius) {
  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
  scene.addPrimitive(scene.addObject("Sphere", {vector(x, y, z), radius}),
                     scene.addObject("Normal", members({})));
  return scene;
}

} // namespace

TEST(SpawnEpsilon, RaysThatLeaveASphereDoNotMeetItAgain) {
  struct Case {
    double x, y, z, radius;
    float direction;
  };
  for (Case c : {Case{0, 0, 0, 1, 1}, Case{10, -5, 3, 1, 1}, Case{1000, 200, -300, 10, 1},
                 Case{0, 0, 0, 1e-4, 1}, Case{1e5, 1e5, 1e5, 1e4, 1}, Case{3, 1, 2, 1, 1e6},
                 Case{3, 1, 2, 1, 1e-6}}) {
    Scene scene = sphereScene(c.x, c.y, c.z, c.radius);
    Counts counts = leaveSurface(scene, {float(c.x), float(c.y), float(c.z)}, float(c.radius),
                                 c.direction, [](Vec3 d, Vec3 n) { return dot(d, n) > 0; });
    EXPECT_GT(counts.spawned, 10000);
    EXPECT_EQ(counts.selfHits, 0) << "sphere of radius " << c.radius << " at " << c.x;
    // Into the sphere: the far side must be found.
    EXPECT_GT(counts.passed, counts.spawned * 9 / 10);
  }
}

TEST(SpawnEpsilon, RaysThatLeaveAPlaneDoNotMeetItAgain) {
  std::mt19937 random(12);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (float scale : {1e-3f, 1.0f, 1e4f})
    for (float distance : {0.0f, 10.0f, 1000.0f}) {
      Scene scene(fakeProgram());
      setCameraAtOrigin(scene);
      Vec3 centre = Vec3{unit(random), unit(random), unit(random)} * (scale * distance);
      Vec3 a = onSphere(random), b = normalized(cross(a, onSphere(random)));
      // A tilted grid: neighbours lie in almost one plane.
      Mesh mesh;
      constexpr int n = 8;
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) {
          Vec3 p = centre + (a * (float(i) / n * 2 - 1) + b * (float(j) / n * 2 - 1)) * scale;
          mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
        }
      for (unsigned i = 0; i < n; ++i)
        for (unsigned j = 0; j < n; ++j) {
          unsigned v = i * (n + 1) + j;
          mesh.indices.insert(mesh.indices.end(),
                              {v, v + n + 1, v + 1, v + 1, v + n + 1, v + n + 2});
        }
      scene.addMeshInstance(scene.addMesh(mesh), scene.addObject("Normal", members({})));
      Counts counts = leaveSurface(scene, centre, scale, 1, [](Vec3, Vec3) { return true; });
      EXPECT_GT(counts.spawned, 5000);
      EXPECT_EQ(counts.selfHits, 0) << "scale " << scale << ", " << distance << " away";
    }
}

/// A tilted triangle in object space, of about size 1: no ray that leaves it meets it again.
static Mesh tiltedTriangle() {
  Mesh mesh;
  mesh.positions = {-0.9f, -0.7f, 0.31f, 0.8f, -0.77f, -0.42f, 0.11f, 0.93f, 0.37f};
  mesh.indices = {0, 1, 2};
  return mesh;
}

TEST(SpawnEpsilon, RaysThatLeaveAnInstanceDoNotMeetItAgain) {
  const auto turned = [](double size, double distance) {
    return Transform::scale(size, size, size)
        .then(Transform::rotate({1, 2, -0.5}, 77))
        .then(Transform::translate(distance, -0.7 * distance, 0.3 * distance));
  };
  Transform sheared;
  sheared.columns[1] = {3, 1, 0};
  sheared.columns[2] = {0, -2, 1};
  Transform levels = turned(1.5, 3); // eight of them
  for (int i = 1; i < 8; ++i)
    levels = levels.then(turned(i % 2 ? 0.6 : 1.5, 3));
  struct Case {
    const char *name;
    Transform transform;
  };
  for (const Case &c : {Case{"tiny", turned(1e-6, 0)}, Case{"tiny, far", turned(1e-6, 1e-3)},
                        Case{"huge", turned(1e6, 0)}, Case{"far", turned(1, 1e5)},
                        Case{"huge, very far", turned(1e6, 1e7)}, Case{"eight levels", levels},
                        Case{"mirrored", Transform::scale(1, 1, -1).then(turned(1, 20))},
                        Case{"sheared", sheared.then(turned(1, 5))},
                        Case{"flat", Transform::scale(1, 1, 1e-4).then(turned(1, 5))}})
    for (bool isMesh : {true, false}) {
      Scene scene(fakeProgram());
      setCameraAtOrigin(scene);
      const RtslRef material = scene.addObject("Normal", members({}));
      Placement placement;
      placement.transform = c.transform;
      if (isMesh)
        scene.addMeshInstance(scene.addMesh(tiltedTriangle()), material, placement);
      else
        scene.addPrimitive(scene.addObject("Sphere", {vector(0.2, -0.1, 0.3), 0.8}), material,
                           placement);
      const auto &columns = c.transform.columns;
      const Vec3 centre = {float(columns[3][0]), float(columns[3][1]), float(columns[3][2])};
      double size = 0;
      for (int i = 0; i < 3; ++i)
        for (double x : columns[i])
          size = std::max(size, std::fabs(x));
      const Counts counts = leaveSurface(scene, centre, float(size), 1,
                                         [&](Vec3 d, Vec3 n) { return isMesh || dot(d, n) > 0; });
      EXPECT_GT(counts.spawned, 1000) << c.name;
      EXPECT_EQ(counts.selfHits, 0)
          << c.name << (isMesh ? ", mesh" : ", sphere") << " of " << counts.spawned;
    }
}

TEST(SpawnEpsilon, StaysSmall) {
  Scene scene = sphereScene(0, 0, 0, 1);
  HostScene host(scene, false, 1);
  RtslState hit = makeRay(host.deviceLaunch(), {0, 0, 5}, {0, 0, -1}, 0);
  ASSERT_EQ(host.traverse(hit, false), RTSL_HIT);
  describeHit(hit);
  float epsilon = spawnEpsilon(hit, load(hit.HitPoint), {0, 0, 1});
  EXPECT_GT(epsilon, 1e-7f);
  EXPECT_LT(epsilon, 5e-5f);
  EXPECT_NEAR(spawnEpsilon(hit, load(hit.HitPoint), {0, 0, 1000}), epsilon / 1000,
              1e-3f * epsilon / 1000);
  // Far from the hit point the angle to its normal means nothing.
  EXPECT_LT(spawnEpsilon(hit, {0, 0, 3}, {1, 0, 0}), 5e-5f);
}
