#include "tests/unit/runtime/FakeProgram.h"
#include "tests/unit/runtime/InstanceScenes.h"
#include "tests/unit/runtime/TraversalRays.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/device/traverse/Bvh.h"
#include "runtime/device/traverse/Traverse.h"
#include "runtime/embree/HostScene.h"

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
  setCameraAtOrigin(scene);
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

/// Every triangle and sphere, one after the other.
void bruteForce(RtslState &state) {
  const RtslLaunch &launch = *state.launch;
  auto ray = rtsl::device::makeTriangleRay(rtsl::device::load(state.RayOrigin),
                                           rtsl::device::load(state.RayDirection));
  rtsl::device::beginSearch(state);
  for (std::uint32_t i = launch.instanceCount; i-- > 0;) { // backwards: order must not show
    const RtslInstance &instance = launch.instances[i];
    if (instance.primitive) {
      rtsl::device::testPrimitive(state, ray, instance, {i, 0}, rtsl_rt_Primitive_intersect);
      continue;
    }
    for (std::uint32_t t = launch.meshes[instance.mesh].triangleCount; t-- > 0;)
      rtsl::device::testTriangle(state, ray, launch.meshes[instance.mesh], i, t);
  }
  rtsl::device::endSearch(state);
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
      EXPECT_GT(hits, 250);
    }
  }
}

namespace {

/// One scene behind Embree and behind our own tree. Both must find the same, to the bit.
struct Both {
  const Scene &scene;
  HostScene embree, own;
  RtslLaunch launch;
  int hits = 0;

  explicit Both(const Scene &scene)
      : scene(scene), embree(scene, true, 2), own(scene, false, 1), launch(scene.launch()) {
    launch.host = &embree;
  }

  void compare(const Ray &ray, int i, float distance = INFINITY) {
    RtslState a = makeState(launch, ray.o, ray.d, 0, distance),
              b = makeState(own.deviceLaunch(), ray.o, ray.d, 0, distance);
    RtslState anyA = a, anyB = b;
    std::uint32_t found = own.traverse(b, 0);
    ASSERT_EQ(embree.traverse(a, 0), found) << i;
    ASSERT_NO_FATAL_FAILURE(expectSame(a, b, i));
    ASSERT_EQ(embree.traverse(anyA, RTSL_FIRST_HIT), found) << i;
    ASSERT_EQ(own.traverse(anyB, RTSL_FIRST_HIT), found) << i;
    hits += found == RTSL_HIT;
  }
};

/// Surfaces that coincide, overlap, touch and have hardly any width: whatever makes two hits nearly
/// or exactly equal.
Scene tiedScene(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> wide(-8, 8), unit(-1, 1);
  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
  RtslRef material = scene.addObject("Normal", members({}));
  auto point = [&](float scale) {
    return Vec3{scale * unit(random), scale * unit(random), scale * unit(random)};
  };
  auto add = [](Mesh &mesh, Vec3 p) {
    mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
    return std::uint32_t(mesh.vertexCount() - 1);
  };
  auto addScene = [&](const Mesh &mesh) { scene.addMeshInstance(scene.addMesh(mesh), material); };
  auto mirrored = [](const Mesh &mesh, int axis) {
    Mesh other = mesh;
    for (std::size_t i = std::size_t(axis); i < other.positions.size(); i += 3)
      other.positions[i] = -other.positions[i];
    return other;
  };
  for (int part = 0; part < 12; ++part) {
    const Vec3 corner = point(8), u = point(5), v = point(5);
    Mesh quad[2]; // the same quad, cut along either diagonal
    for (int diagonal = 0; diagonal < 2; ++diagonal) {
      for (Vec3 p : {corner, corner + u, corner + u + v, corner + v})
        add(quad[diagonal], p);
      quad[diagonal].indices = diagonal ? std::vector<std::uint32_t>{1, 2, 3, 3, 0, 1}
                                        : std::vector<std::uint32_t>{0, 1, 2, 2, 3, 0};
      addScene(quad[diagonal]);
    }
    addScene(quad[0]); // once more, and on the other side of a plane through the origin
    addScene(mirrored(quad[1], part % 3));

    Mesh overlapping; // triangles in one plane
    for (int i = 0; i < 8; ++i)
      for (std::uint32_t k = 0; k < 3; ++k)
        overlapping.indices.push_back(
            add(overlapping, corner + u * (2 * unit(random)) + v * (2 * unit(random))));
    addScene(overlapping);

    Mesh fan; // of needles
    const Vec3 centre = point(8), across = point(1);
    add(fan, centre);
    for (std::uint32_t i = 0; i <= 200; ++i) {
      float angle = 6.2831853f * float(i) / 200;
      add(fan, centre + u * std::cos(angle) + across * std::sin(angle));
      if (i > 0)
        fan.indices.insert(fan.indices.end(), {0, i, i + 1});
    }
    addScene(fan);

    Mesh needles; // of all widths down to none
    for (int i = 0; i < 100; ++i) {
      const Vec3 a = point(8), along = point(6);
      const float width = std::ldexp(1.0f, -int(random() % 40));
      for (Vec3 p : {a, a + along, a + along * 0.5f + point(width)})
        needles.indices.push_back(add(needles, p));
    }
    addScene(needles);
    addScene(mirrored(needles, 0));
  }
  for (int i = 0; i < 12; ++i) { // spheres, some of them twice, in boxes that touch
    std::vector<Value> sphere = {vector(std::floor(wide(random)), std::floor(wide(random)), 0),
                                 0.5};
    for (int copy = 0; copy < 1 + i % 2; ++copy)
      scene.addPrimitive(scene.addObject("Sphere", sphere), material);
  }
  return scene;
}

/// Instances with transforms of two meshes, of which one is in world space, too.
Scene instancedScene(unsigned seed) {
  std::mt19937 random(seed);
  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
  const RtslRef material = scene.addObject("Normal", members({}));
  const std::uint32_t meshes[] = {scene.addMesh(clump(random, 40)),
                                  scene.addMesh(clump(random, 200))};
  scene.addMeshInstance(meshes[0], material);
  for (unsigned i = 0; i < 60; ++i) {
    Placement placement;
    placement.transform = randomTransform(random);
    scene.addMeshInstance(meshes[i % 2], material, placement);
  }
  return scene;
}

/// Instances of a mesh one in the other, of triangles one in the other: a ray that enters the
/// smallest has much left to visit, of both trees.
Scene nestedScene() {
  std::mt19937 random(3);
  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
  const RtslRef material = scene.addObject("Normal", members({}));
  Mesh mesh;
  for (unsigned i = 0; i < 150; ++i) {
    const float size = std::pow(1.1f, float(i));
    const float corners[3][3] = {{-size, -size, 0}, {3 * size, -size, 0}, {-size, 3 * size, size}};
    for (unsigned corner = 0; corner < 3; ++corner) {
      mesh.positions.insert(mesh.positions.end(), corners[corner], corners[corner] + 3);
      mesh.indices.push_back(3 * i + corner);
    }
  }
  const std::uint32_t number = scene.addMesh(std::move(mesh));
  for (int i = 0; i < 150; ++i) {
    const double size = std::pow(1.1, i);
    Placement placement;
    placement.transform =
        Transform::scale(size, size, size).then(Transform::translate(0, 0, -size));
    scene.addMeshInstance(number, material, placement);
  }
  return scene;
}

/// A ray towards a vertex, an edge or the middle of some triangle.
Ray rayAtTriangle(std::mt19937 &random, const RtslLaunch &launch, Vec3 from) {
  std::uniform_real_distribution<float> unit(0, 1);
  const RtslInstance *instance;
  do
    instance = &launch.instances[random() % launch.instanceCount];
  while (instance->primitive);
  const RtslMesh &mesh = launch.meshes[instance->mesh];
  const auto p = rtsl::device::triangleVertices(mesh, random() % mesh.triangleCount);
  float u = random() % 2 ? unit(random) : 0, v = random() % 2 ? (1 - u) * unit(random) : 0;
  Vec3 target = p.v0 * (1 - u - v) + p.v1 * u + p.v2 * v;
  if (instance->transform)
    target = rtsl::device::pointToWorld(launch.transforms[instance->transform], target);
  return {from, target - from};
}

} // namespace

TEST(EmbreeTraversal, AgreesWithDeviceTraversal) {
  // 32 spheres are listed (runtime/embree/ItemList.h), 33 are in Embree's tree.
  for (auto [scale, spheres] :
       {std::pair(1.0f, 33), std::pair(1.0f, 32), std::pair(1e-6f, 9), std::pair(1e6f, 60)}) {
    Scene scene = randomScene(9, 2000, spheres, scale);
    Both both(scene);
    std::mt19937 random(10);
    for (int i = 0; i < 30000; ++i)
      ASSERT_NO_FATAL_FAILURE(both.compare(randomRay(random, scale), i));
  }
}

TEST(EmbreeTraversal, AgreesWhereTreesInTreesAreDeep) {
  const Scene scene = nestedScene();
  Both both(scene);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int i = 0; i < 500; ++i) {
    const float size = std::pow(10.0f, 5 * unit(random));
    const Vec3 from = {size * unit(random), size * unit(random), 1e6f},
               to = {unit(random), unit(random), unit(random)};
    ASSERT_NO_FATAL_FAILURE(both.compare({from, to - from}, i));
  }
  EXPECT_GT(both.hits, 250);
}

TEST(EmbreeTraversal, AgreesWhereHitsTie) {
  for (unsigned seed : {1u, 2u, 3u}) {
    Scene scene = tiedScene(seed);
    Both both(scene);
    std::mt19937 random(seed + 100);
    for (int i = 0; i < 20000; ++i) {
      // Now and then from far away: there Embree needs another tree.
      Ray ray = randomRay(random, i % 64 == 0 ? 1e4f : 1);
      if (i % 2)
        ray = rayAtTriangle(random, both.launch, ray.o);
      ASSERT_NO_FATAL_FAILURE(both.compare(ray, i, i % 7 ? INFINITY : 1));
    }
    EXPECT_GT(both.hits, 10000);
    EXPECT_FALSE(both.embree.hasOwnTree()) << "for rays that Embree can follow";
  }
}

TEST(EmbreeTraversal, MaskedRaysNeedNoSecondTree) {
  Scene scene = tiedScene(5);
  HostScene embree(scene, true, 1), own(scene, false, 1);
  RtslLaunch launch = scene.launch();
  std::mt19937 random(6);
  for (int i = 0; i < 2000; ++i) {
    Ray ray = rayAtTriangle(random, launch, {9, 1, 2});
    RtslState a = makeState(launch, ray.o, ray.d), b = makeState(own.deviceLaunch(), ray.o, ray.d);
    a.rayMask = b.rayMask = 1;
    ASSERT_EQ(embree.traverse(a, 0), own.traverse(b, 0));
    ASSERT_NO_FATAL_FAILURE(expectSame(a, b, i));
  }
  EXPECT_FALSE(embree.hasOwnTree());
}

namespace {

/// A search towards a point at distance 1 ends at any hit that hides it. Otherwise it finds the
/// nearest hit.
void expectSameView(const HostScene &host, RtslState nearest, int i, int (&answers)[2]) {
  RtslState seen = nearest;
  const std::uint32_t found = host.traverse(nearest, 0);
  ASSERT_EQ(host.traverse(seen, rtsl::device::towardsPoint), found) << i;
  const bool isHidden = found == RTSL_HIT && rtsl::device::isPointHidden(nearest);
  ASSERT_EQ(found == RTSL_HIT && rtsl::device::isPointHidden(seen), isHidden) << i;
  if (!isHidden)
    expectSame(seen, nearest, i);
  ++answers[isHidden];
}

} // namespace

// Bundles of shadow rays, as lights get them, in several scenes in turns: what was in the way of a
// ray before is tested first (LastOccluders.h), and of one scene there are blocks that another one
// does not have.
TEST(EmbreeTraversal, OccludersOfOtherRaysChangeNoAnswer) {
  Scene large = tiedScene(7), small = randomScene(8, 200, 3), instances = instancedScene(9);
  HostScene embree[] = {{large, true, 1}, {small, true, 1}, {instances, true, 1}},
            own[] = {{large, false, 1}, {small, false, 1}, {instances, false, 1}};
  const RtslLaunch launches[] = {large.launch(), small.launch(), instances.launch()};
  std::mt19937 random(9);
  std::uniform_real_distribution<float> near(-0.05f, 0.05f), share(0.2f, 1.5f);
  int answers[3][2] = {}, views[2] = {};
  for (int bundle = 0; bundle < 2400; ++bundle) {
    const int which = bundle % 3;
    const Ray first = bundle % 4 ? rayAtTriangle(random, launches[which], randomRay(random, 1).o)
                                 : randomRay(random, 1);
    for (int i = 0; i < 20; ++i) {
      const Vec3 o = first.o + Vec3{near(random), near(random), near(random)};
      const Vec3 d = first.d + Vec3{near(random), near(random), near(random)};
      const float end = share(random);
      RtslState a = makeState(launches[which], o, d, 1e-4f, end),
                b = makeState(own[which].deviceLaunch(), o, d, 1e-4f, end);
      const std::uint32_t found = embree[which].traverse(a, RTSL_FIRST_HIT);
      ASSERT_EQ(found, own[which].traverse(b, RTSL_FIRST_HIT)) << bundle << ", " << i;
      ++answers[which][found == RTSL_HIT];
      a = makeState(launches[which], o, d, 1e-4f, 2 - rtsl::device::hiddenBefore);
      b = makeState(own[which].deviceLaunch(), o, d, 1e-4f, 2 - rtsl::device::hiddenBefore);
      ASSERT_NO_FATAL_FAILURE(expectSameView(embree[which], a, i, views));
      ASSERT_NO_FATAL_FAILURE(expectSameView(own[which], b, i, views));
    }
  }
  EXPECT_GT(views[0], 10000);
  EXPECT_GT(views[1], 10000);
  for (const int (&ofScene)[2] : answers) {
    EXPECT_GT(ofScene[0], 1000);
    EXPECT_GT(ofScene[1], 1000);
  }
}

TEST(HostTraversal, ExtremeDirections) {
  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
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
  for (const RtslTreeItem &item : bvh.items)
    seen[item.primitive] = true;
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), std::ptrdiff_t(items.size()));
}

TEST(BvhBuilder, ItemsInOnePlaceAndInfinitePrimitives) {
  std::vector<BvhItem> items(1000, BvhItem{{{1, 1, 1}, {1, 1, 1}}, {0, 0}});
  for (std::uint32_t i = 0; i < items.size(); ++i)
    items[i].item.primitive = i;
  EXPECT_LE(buildBvh(items).depth(), 12u);

  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
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
