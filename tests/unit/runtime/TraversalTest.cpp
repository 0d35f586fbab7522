#include "FakeProgram.h"

#include "runtime/BvhBuilder.h"
#include "runtime/HostScene.h"
#include "runtime/device/Bvh.h"
#include "runtime/device/Traverse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

using namespace rtsl::runtime;
using namespace rtsl::runtime::test;
using rtsl::device::Vec3;

namespace {

/// Triangles in clumps, some of them twice, and spheres among them.
Scene randomScene(unsigned seed, int triangles, int spheres, float scale = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> wide(-10, 10), small(-1, 1);
  Scene scene(fakeProgram());
  scene.setCamera(scene.addObject(
      "Camera",
      members({{"eye", vector(0, 0, 0)}, {"gaze", vector(0, 0, 1)}, {"up", vector(0, 1, 0)}})));
  RtslRef material = scene.addObject("Normal", members({}));
  Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    float c[3] = {wide(random), wide(random), wide(random)};
    for (int corner = 0; corner < 3; ++corner)
      for (float x : c)
        mesh.positions.push_back(scale * (x + small(random)));
    for (unsigned k = 0; k < 3; ++k)
      mesh.indices.push_back(unsigned(3 * i) + k);
    if (i % 50 == 0) // the same triangle again: the lower number has to win
      for (unsigned k = 0; k < 3; ++k)
        mesh.indices.push_back(unsigned(3 * i) + k);
  }
  if (triangles)
    scene.addMeshInstance(scene.addMesh(std::move(mesh)), material);
  for (int i = 0; i < spheres; ++i)
    scene.addPrimitive(
        scene.addObject("Sphere",
                        {vector(scale * wide(random), scale * wide(random), scale * wide(random)),
                         double(scale * (0.2f + std::fabs(small(random))))}),
        material);
  return scene;
}

RtslState makeState(const RtslLaunch &launch, Vec3 o, Vec3 d, float epsilon = 0,
                    float distance = INFINITY) {
  RtslState state;
  std::memset(&state, 0x7f, sizeof state); // nothing may rely on cleared memory
  state.launch = &launch;
  state.rayMask = ~0u;
  state.rayRoot = 0;
  rtsl::device::store(state.RayOrigin, o);
  rtsl::device::store(state.RayDirection, d);
  state.Epsilon = epsilon;
  state.HitDistance = distance;
  state.isEasy = 0;
  state.instance = state.primitive = RTSL_NO_HIT;
  return state;
}

/// Every triangle and sphere, one after the other.
void bruteForce(RtslState &state) {
  const RtslLaunch &launch = *state.launch;
  auto ray = rtsl::device::makeTriangleRay(rtsl::device::load(state.RayOrigin),
                                           rtsl::device::load(state.RayDirection));
  for (std::uint32_t i = launch.instanceCount; i-- > 0;) { // backwards: order must not show
    const RtslInstance &instance = launch.instances[i];
    if (instance.primitive) {
      state.candidateInstance = i;
      state.candidatePrimitive = 0;
      rtsl_rt_Primitive_intersect(&state, instance.primitive);
      continue;
    }
    for (std::uint32_t t = launch.meshes[instance.mesh].triangleCount; t-- > 0;)
      rtsl::device::testTriangle(state, ray, launch.meshes[instance.mesh], i, t);
  }
}

struct Ray {
  Vec3 o, d;
};

/// All kinds: inside, outside, along axes, from grid planes, long and short directions.
Ray randomRay(std::mt19937 &random, float scale) {
  std::uniform_real_distribution<float> wide(-15, 15), unit(-1, 1);
  Ray ray{{scale * wide(random), scale * wide(random), scale * wide(random)},
          {unit(random), unit(random), unit(random)}};
  switch (random() % 8) {
  case 0:
    ray.d.x = 0;
    break;
  case 1:
    ray.d.y = -0.0f;
    break;
  case 2:
    ray.d = {0, 0, unit(random) < 0 ? -1.0f : 1.0f};
    break;
  case 3:
    ray.d = ray.d * std::ldexp(1.0f, int(random() % 100) - 50);
    break;
  }
  return ray;
}

void expectSame(const RtslState &a, const RtslState &b, int i) {
  ASSERT_EQ(a.instance, b.instance) << i;
  if (a.instance == RTSL_NO_HIT)
    return;
  EXPECT_EQ(a.primitive, b.primitive) << i;
  EXPECT_EQ(a.HitDistance, b.HitDistance) << i;
  if (a.launch->instances[a.instance].primitive == 0) {
    EXPECT_EQ(a.u, b.u) << i;
    EXPECT_EQ(a.v, b.v) << i;
  }
}

} // namespace

TEST(DeviceTraversal, FindsWhatTryingEverythingFinds) {
  for (auto [triangles, spheres] : {std::pair(400, 40), std::pair(0, 3), std::pair(3, 0),
                                    std::pair(0, 0), std::pair(1000, 0)}) {
    Scene scene = randomScene(7, triangles, spheres);
    HostScene host(scene, false, 1);
    std::mt19937 random(8);
    int hits = 0;
    for (int i = 0; i < 4000; ++i) {
      Ray ray = randomRay(random, 1);
      float epsilon = i % 3 ? 0 : 0.25f, distance = i % 5 ? INFINITY : 4;
      RtslState nearest = makeState(host.deviceLaunch(), ray.o, ray.d, epsilon, distance),
                brute = nearest, any = nearest;
      std::uint32_t answer = host.traverse(nearest, false);
      bruteForce(brute);
      ASSERT_NO_FATAL_FAILURE(expectSame(nearest, brute, i));
      EXPECT_EQ(answer, brute.instance != RTSL_NO_HIT ? RTSL_HIT : RTSL_MISS);
      EXPECT_EQ(host.traverse(any, true), answer);
      hits += answer == RTSL_HIT;
    }
    if (triangles + spheres > 100) {
      EXPECT_GT(hits, 300);
    }
  }
}

TEST(EmbreeTraversal, AgreesWithDeviceTraversal) {
  int rays = 0, differences = 0;
  for (float scale : {1.0f, 1e-6f, 1e6f}) {
    Scene scene = randomScene(9, 2000, 60, scale);
    HostScene embree(scene, true, 2), device(scene, false, 1);
    RtslLaunch launch = scene.launch();
    launch.host = &embree;
    std::mt19937 random(10);
    for (int i = 0; i < 30000; ++i) {
      Ray ray = randomRay(random, scale);
      RtslState a = makeState(launch, ray.o, ray.d),
                b = makeState(device.deviceLaunch(), ray.o, ray.d);
      RtslState anyA = a, anyB = b;
      std::uint32_t foundA = embree.traverse(a, false), foundB = device.traverse(b, false);
      bool same = foundA == foundB && a.instance == b.instance && a.HitDistance == b.HitDistance &&
                  (foundA == RTSL_MISS || a.primitive == b.primitive);
      same &= embree.traverse(anyA, true) == device.traverse(anyB, true);
      ++rays;
      differences += !same;
    }
  }
  // Equal triangles may be told apart by Embree's order; else about one ray in a million may
  // differ.
  EXPECT_LE(differences, 5) << "of " << rays;
}

TEST(HostTraversal, ExtremeDirections) {
  Scene scene(fakeProgram());
  scene.setCamera(scene.addObject(
      "Camera",
      members({{"eye", vector(0, 0, 0)}, {"gaze", vector(0, 0, 1)}, {"up", vector(0, 1, 0)}})));
  RtslRef material = scene.addObject("Normal", members({}));
  Mesh wall;
  wall.positions = {-1, -1, 4, 1, -1, 4, 0, 1, 4};
  wall.indices = {0, 1, 2};
  scene.addMeshInstance(scene.addMesh(wall), material);
  for (bool useEmbree : {true, false}) {
    HostScene host(scene, useEmbree, 1);
    RtslLaunch launch = useEmbree ? scene.launch() : host.deviceLaunch();
    for (float length : {2e-38f, 1e-30f, 1e-18f, 1e-10f, 1.0f, 1e10f, 1e19f, 1e30f, 1e38f}) {
      RtslState state = makeState(launch, {0, 0, 0}, {0, 0, length});
      ASSERT_EQ(host.traverse(state, false), RTSL_HIT) << length;
      EXPECT_FLOAT_EQ(state.HitDistance, 4 / length) << length;
      RtslState shadow = makeState(launch, {0, 0, 0}, {0, 0, length});
      EXPECT_EQ(host.traverse(shadow, true), RTSL_HIT) << length;
      RtslState tooShort = makeState(launch, {0, 0, 0}, {0, 0, length}, 0, 3 / length);
      EXPECT_EQ(host.traverse(tooShort, false), RTSL_MISS) << length;
    }
    RtslState far = makeState(launch, {0, 0, -1e30f}, {0, 0, 1});
    EXPECT_EQ(host.traverse(far, false), RTSL_HIT);
    for (Vec3 bad : {Vec3{NAN, 0, 0}, Vec3{INFINITY, 0, 1}, Vec3{0, 0, 0}, Vec3{-0.0f, 0, -0.0f}}) {
      RtslState state = makeState(launch, {0, 0, 0}, bad);
      EXPECT_EQ(host.traverse(state, false), RTSL_BAD_RAY);
    }
    RtslState state = makeState(launch, {0, NAN, 0}, {0, 0, 1});
    EXPECT_EQ(host.traverse(state, true), RTSL_BAD_RAY);
  }
}

TEST(EnterBox, ZeroComponentsInThePlaneOfASide) {
  const float lower[3] = {0, 0, 0}, upper[3] = {1, 1, 1};
  auto enters = [&](Vec3 o, Vec3 d) {
    Vec3 inverse = {1 / d.x, 1 / d.y, 1 / d.z};
    return rtsl::device::enterBox(lower, upper, o, inverse, 0, INFINITY) < INFINITY;
  };
  for (float zero : {0.0f, -0.0f})
    for (float side : {0.0f, 1.0f}) {
      EXPECT_TRUE(enters({side, 0.5f, -1}, {zero, 0, 1}));
      EXPECT_TRUE(enters({side, side, -1}, {zero, zero, 1}));
      EXPECT_FALSE(enters({side, side, -1}, {zero, zero, -1}));
    }
  EXPECT_FALSE(enters({1.001f, 0.5f, -1}, {0, 0, 1}));
  EXPECT_TRUE(enters({0.5f, 0.5f, 0.5f}, {1, 0, 0})); // from inside
}

// Boxes one in the other, each a little larger: the surface area heuristic peels off one at a time.
TEST(BvhBuilder, DepthIsBoundedWhateverTheItems) {
  std::vector<BvhItem> items;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    float size = std::pow(1.004f, float(i));
    items.push_back({{{-size, -size, 0}, {3 * size, size, size}}, {0, i}});
  }
  Bvh bvh = buildBvh(items);
  EXPECT_LE(bvh.depth(), unsigned(rtsl::device::maxBvhDepth));
  ASSERT_EQ(bvh.items.size(), items.size());
  std::vector<bool> seen(items.size());
  for (const RtslLeafItem &item : bvh.items)
    seen[item.primitive] = true;
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), std::ptrdiff_t(items.size()));
}

TEST(BvhBuilder, ItemsInOnePlaceAndInfinitePrimitives) {
  std::vector<BvhItem> items(1000, BvhItem{{{1, 1, 1}, {1, 1, 1}}, {0, 0}});
  for (std::uint32_t i = 0; i < items.size(); ++i)
    items[i].item.primitive = i;
  EXPECT_LE(buildBvh(items).depth(), 12u);

  Scene scene(fakeProgram());
  scene.setCamera(scene.addObject(
      "Camera",
      members({{"eye", vector(0, 0, 0)}, {"gaze", vector(0, 0, 1)}, {"up", vector(0, 1, 0)}})));
  RtslRef material = scene.addObject("Normal", members({}));
  double inf = INFINITY;
  for (int i = 0; i < 10; ++i)
    scene.addPrimitive(scene.addObject("Boxed", members({{"lower", vector(-inf, 0, -inf)},
                                                         {"upper", vector(inf, 0, inf)}})),
                       material);
  scene.addPrimitive(scene.addObject("Sphere", {vector(0, 0, 5), 1.0}), material);
  for (bool useEmbree : {true, false}) {
    HostScene host(scene, useEmbree, 1);
    RtslLaunch launch = useEmbree ? scene.launch() : host.deviceLaunch();
    RtslState state = makeState(launch, {0, 0, 0}, {0, 0, 1});
    EXPECT_EQ(host.traverse(state, false), RTSL_HIT);
    EXPECT_EQ(state.HitDistance, 4);
  }
}
