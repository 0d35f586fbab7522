// Trees that follow what moves, against new ones.
#include "tests/unit/runtime/FakeProgram.h"
#include "tests/unit/runtime/InstanceScenes.h"
#include "tests/unit/runtime/TraversalRays.h"

#include "runtime/accel/BvhBuilder.h"
#include "runtime/accel/DeviceTrees.h"
#include "runtime/accel/trees/HostBuildDevice.h"
#include "runtime/device/traverse/Surface.h"
#include "runtime/device/traverse/Traverse.h"
#include "runtime/embree/HostScene.h"
#include "runtime/scene/Scene.h"
#include "support/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

using namespace rtsl;
using namespace rtsl::runtime;
using namespace rtsl::runtime::test;

namespace {

/// The positions of a mesh of the scene at all its keys, each moved by up to `by`.
std::vector<float> shaken(const Scene &scene, std::uint32_t mesh, float by, std::mt19937 &random) {
  const RtslMesh table = scene.launch().meshes[mesh];
  std::uniform_real_distribution<float> unit(-by, by);
  std::vector<float> positions(
      table.positions, table.positions + 3 * std::size_t(table.vertexCount) * table.keyCount);
  for (float &x : positions)
    x += unit(random);
  return positions;
}

/// Adds a camera, and returns a material.
RtslRef begin(Scene &scene) {
  setCameraAtOrigin(scene);
  return scene.addObject("Normal", members({}));
}

/// Moves some of the instances and one of the meshes of randomScene(seed, instances).
void moveSome(Scene &scene, float by, std::mt19937 &random, std::uint32_t instances = 60) {
  for (std::uint32_t i = 3; i < 3 + instances; i += 1 + random() % 8)
    scene.moveInstance(i, random() % 3 ? MovingTransform(randomTransform(random))
                                       : randomMotion(random));
  const std::uint32_t mesh = random() % 3;
  scene.moveMesh(mesh, shaken(scene, mesh, by, random));
}

/// Trees of both traversals find what new ones find, with any ray.
void expectSameAsNew(const Scene &scene, const HostScene &embree, const HostScene &own,
                     std::mt19937 &random, int &hits) {
  const HostScene newEmbree(scene, true, 1), newOwn(scene, false, 1);
  RtslLaunch ofEmbree = scene.launch(), ofNewEmbree = ofEmbree;
  ofEmbree.host = &embree;
  ofNewEmbree.host = &newEmbree;
  for (int i = 0; i < 1500; ++i) {
    const Ray ray = randomRay(random, i % 50 ? 1 : 1000);
    RtslState expected = makeState(newOwn.deviceLaunch(), ray.o, ray.d);
    expected.Time = float(random()) * 0x1p-32f;
    RtslState a = expected, b = expected, c = expected, any = expected;
    a.launch = &own.deviceLaunch();
    b.launch = any.launch = &ofEmbree;
    c.launch = &ofNewEmbree;
    const std::uint32_t answer = newOwn.traverse(expected, 0);
    EXPECT_EQ(own.traverse(a, 0), answer);
    EXPECT_EQ(embree.traverse(b, 0), answer);
    EXPECT_EQ(newEmbree.traverse(c, 0), answer);
    EXPECT_EQ(embree.traverse(any, RTSL_FIRST_HIT), answer);
    ASSERT_NO_FATAL_FAILURE(expectSame(a, expected, i));
    ASSERT_NO_FATAL_FAILURE(expectSame(b, expected, i));
    ASSERT_NO_FATAL_FAILURE(expectSame(c, expected, i));
    hits += answer == RTSL_HIT;
  }
}

/// The trees of this process.
TreesThere treesIn(Bvh &bvh) {
  TreesThere trees = {BuildDevice::Address(bvh.nodes.data()),
                      BuildDevice::Address(bvh.items.data()),
                      std::uint32_t(bvh.nodes.size()),
                      std::uint32_t(bvh.items.size()),
                      {0}};
  for (const std::uint32_t root : bvh.meshTrees)
    if (root != 0)
      trees.roots.push_back(root);
  return trees;
}

template <typename Element>
std::string bytesOf(const std::vector<Element> &elements) {
  return {reinterpret_cast<const char *>(elements.data()), elements.size() * sizeof(Element)};
}

std::vector<double> follow(Refit &refit, const Scene &scene) {
  const RtslLaunch launch = scene.launch();
  return refit.follow(reinterpret_cast<BuildDevice::Address>(&launch));
}

std::vector<RtslBox> row(int count, float step) {
  std::vector<RtslBox> boxes;
  for (int i = 0; i < count; ++i) {
    const float x = step * float(i);
    boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
  }
  return boxes;
}

} // namespace

TEST(Refit, FindsTheHitsOfNewTrees) {
  int hits = 0;
  for (auto [seed, instances] : {std::pair(21u, 60), std::pair(22u, 60), std::pair(23u, few)}) {
    std::mt19937 random(seed);
    Scene scene = randomScene(seed, instances);
    HostScene embree(scene, true, 1), own(scene, false, 1);
    for (int step = 0; step < 6; ++step) {
      moveSome(scene, step == 4 ? 50.0f : 0.2f, random, std::uint32_t(instances));
      if (step == 3) // has no transform yet: that needs other trees
        scene.moveInstance(seed % 3, Transform::translate(1, 2, 3));
      embree.update();
      own.update();
      ASSERT_NO_FATAL_FAILURE(expectSameAsNew(scene, embree, own, random, hits));
    }
  }
  EXPECT_GT(hits, 10000);
}

// Scenes one after the other, as frames of a sequence.
TEST(Refit, TreesOfOneSceneFollowToAnother) {
  int hits = 0;
  std::mt19937 random(24);
  KeptTrees ofEmbree, ofOwn;
  for (int frame = 0; frame < 8; ++frame) {
    const bool isOther = frame == 6; // of other contents
    Scene scene = randomScene(24, isOther ? 61 : 60);
    if (frame > 1 && !isOther) // the first two are the same
      moveSome(scene, frame == 4 ? 50.0f : 0.2f, random);
    HostScene embree(scene, true, 1, {}, std::move(ofEmbree)),
        own(scene, false, 1, {}, std::move(ofOwn));
    const bool follows = frame != 0 && frame != 6 && frame != 7;
    EXPECT_EQ(embree.isRefitted(), follows) << frame;
    EXPECT_TRUE(follows || !own.isRefitted()) << frame;
    EXPECT_TRUE(own.isRefitted() || frame != 1) << frame; // others may become too bad
    ASSERT_NO_FATAL_FAILURE(expectSameAsNew(scene, embree, own, random, hits));
    ofEmbree = embree.takeTrees();
    ofOwn = own.takeTrees();
  }
  EXPECT_GT(hits, 3000);
}

TEST(Refit, NothingHasToMove) {
  int hits = 0;
  std::mt19937 random(5);
  Scene scene = randomScene(5, 20);
  HostScene embree(scene, true, 1), own(scene, false, 1);
  expectSameAsNew(scene, embree, own, random, hits);
  scene.moveInstance(0, MovingTransform()); // it has none
  EXPECT_EQ(scene.moves(), 0u);
  scene.moveInstance(5, Transform::scale(2, 2, 2));
  EXPECT_EQ(scene.moves(), 1u);
  embree.update();
  own.update();
  expectSameAsNew(scene, embree, own, random, hits);
}

TEST(Refit, KeepsTheShapeOfATreeUntilItHasBecomeBad) {
  std::mt19937 random(7);
  Scene scene(fakeProgram());
  const RtslRef material = begin(scene);
  const std::uint32_t mesh = scene.addMesh(clump(random, 500));
  scene.addMeshInstance(mesh, material);
  Bvh tree = buildBvh(scene, 1), oldTree = tree;
  HostBuildDevice device(1);
  const SceneTrees contents = treesOf(scene.launch());
  Refit refit(device, treesIn(tree), contents);
  const std::vector<double> cost = refit.costs();
  EXPECT_GT(cost.at(0), 2);
  scene.moveMesh(mesh, shaken(scene, mesh, 0.01f, random));
  const std::vector<double> nearly = follow(refit, scene);
  EXPECT_NEAR(nearly.at(0), cost.at(0), 0.1 * cost.at(0));
  EXPECT_FALSE(areTooBad(nearly, cost));
  scene.moveMesh(mesh, shaken(scene, mesh, 2.0f, random)); // anywhere
  const std::vector<double> bad = follow(refit, scene);
  EXPECT_TRUE(areTooBad(bad, cost));
  Bvh newTree = buildBvh(scene, 1);
  EXPECT_LT(Refit(device, treesIn(newTree), contents).costs().at(0), bad.at(0));
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    EXPECT_EQ(tree.nodes[i].firstNode, oldTree.nodes[i].firstNode);
    EXPECT_EQ(tree.nodes[i].firstItem, oldTree.nodes[i].firstItem);
  }
}

// Whatever built the tree: level by level, or subtree by subtree.
TEST(Refit, ToTheSamePlaceChangesNothing) {
  Scene scene = randomScene(3, 60);
  std::mt19937 random(3);
  for (const TreeKind kind : {TreeKind::Good, TreeKind::Fast}) {
    Bvh tree = buildBvh(scene, 1, kind);
    const Bvh old = tree;
    HostBuildDevice device(3);
    Refit refit(device, treesIn(tree), treesOf(scene.launch()));
    const std::vector<double> costs = refit.costs();
    EXPECT_EQ(costs.size(), treesIn(tree).roots.size());
    EXPECT_EQ(follow(refit, scene), costs);
    ASSERT_GT(tree.nodes.size(), 3u);
    EXPECT_EQ(bytesOf(tree.nodes), bytesOf(old.nodes));
    EXPECT_EQ(bytesOf(tree.items), bytesOf(old.items));
  }
}

// The trees of a device follow from scene to scene, and are those that its traversal searches.
TEST(Refit, TreesOfADeviceFollow) {
  int hits = 0;
  std::mt19937 random(26);
  DeviceTrees trees(std::make_unique<HostBuildDevice>(2));
  int refitted = 0;
  for (int frame = 0; frame < 8; ++frame) {
    const bool isOther = frame == 6; // of other contents
    Scene scene = randomScene(26, isOther ? 61 : 60);
    if (frame > 1 && !isOther)
      moveSome(scene, frame == 4 ? 50.0f : 0.2f, random);
    RtslLaunch launch = scene.launch();
    trees.follow(launch, reinterpret_cast<BuildDevice::Address>(&launch), 2, std::nullopt);
    const bool follows = trees.treeFigures().isRefitted;
    EXPECT_TRUE(follows || frame != 1);
    EXPECT_FALSE(follows && (frame == 0 || frame >= 6)) << frame;
    refitted += follows;
    trees.install(launch);
    const FilledSlots slots{scene.program().slots};
    const HostScene newTrees(scene, false, 1);
    for (int i = 0; i < 1500; ++i) {
      const Ray ray = randomRay(random, i % 50 ? 1 : 1000);
      RtslState expected = makeState(newTrees.deviceLaunch(), ray.o, ray.d);
      expected.Time = float(random()) * 0x1p-32f;
      RtslState found = expected;
      found.launch = &launch;
      const std::uint32_t answer = newTrees.traverse(expected, 0);
      EXPECT_EQ(device::findHit(found, 0, slots, device::LaunchTree{true}), answer);
      ASSERT_NO_FATAL_FAILURE(expectSame(found, expected, i));
      hits += answer == RTSL_HIT;
    }
  }
  EXPECT_GT(refitted, 2);
  EXPECT_GT(hits, 3000);
}

TEST(Refit, MeasuresBoxesInTheOrderThatTheyHad) {
  const BoxOrder order(row(64, 2));
  EXPECT_EQ(order.degradation(row(64, 2)), 1);
  EXPECT_NEAR(order.degradation(row(64, 4)), 1, 0.2); // the same, stretched
  std::vector<RtslBox> mixed = row(64, 2);
  std::mt19937 random(1);
  std::shuffle(mixed.begin(), mixed.end(), random);
  EXPECT_GT(order.degradation(mixed), 2 * largestDegradation);
  EXPECT_EQ(BoxOrder().degradation({}), 1);
}

TEST(Refit, RefusesWhatCannotMove) {
  std::mt19937 random(9);
  Scene scene(fakeProgram());
  const RtslRef material = begin(scene);
  const std::uint32_t mesh = scene.addMesh(clump(random, 3), "clump");
  scene.addMeshInstance(mesh, material);
  const auto said = [](auto work) {
    try {
      work();
    } catch (const Error &error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const std::vector<float> before = shaken(scene, mesh, 0, random);
  EXPECT_EQ(said([&] { scene.moveInstance(1, Transform()); }),
            "the scene has no instance number 1");
  EXPECT_EQ(said([&] { scene.moveMesh(1, {}); }), "the scene has no mesh number 1");
  EXPECT_EQ(said([&] { scene.moveInstance(0, Transform::scale(0, 1, 1)); }),
            "the transform of `clump` flattens it");
  EXPECT_EQ(said([&] { scene.moveInstance(0, randomMotion(random)); }),
            "`clump` cannot be given keys: the scene was created without anything that moves");
  EXPECT_EQ(said([&] { scene.moveMesh(mesh, {1, 2, 3}); }),
            "clump: 1 positions are given, but there are 9");
  std::vector<float> wrong = before;
  wrong[4] = NAN;
  EXPECT_NE(said([&] { scene.moveMesh(mesh, wrong); }), "nothing");
  EXPECT_EQ(shaken(scene, mesh, 0, random), before);
  EXPECT_EQ(scene.moves(), 0u);
}

namespace {

/// A form of the transforms of a scene, cheaper than that of all matrices.
struct CheapForm {
  bool scales;          // along the axes, or with `turns` alike; otherwise all are translations
  bool turns;           // and rotations, some of which move
  std::uint32_t absent; // RTSL_HAS_*
};

class CheapForms : public testing::TestWithParam<CheapForm> {};

} // namespace

// What the transforms of a scene do not have is not read, and the bits are those of the general
// form.
TEST_P(CheapForms, HaveTheBitsOfTheGeneralForm) {
  std::mt19937 random(31);
  std::uniform_real_distribution<double> unit(-1, 1);
  Scene scene(fakeProgram());
  const RtslRef material = begin(scene);
  const std::uint32_t mesh = scene.addMesh(clump(random, 12));
  const RtslRef ball = scene.addObject("Sphere", {vector(0.25, 0, 0), 0.75});
  for (int i = 0; i < 80; ++i) {
    const auto place = [&] {
      const double size = i % 7 == 0 ? 1e6 : i % 5 == 0 ? 0 : 8;
      const Transform moved = Transform::translate(
          size * unit(random), i % 3 ? 8 * unit(random) : 0, size * unit(random));
      if (GetParam().turns) {
        const double size = GetParam().scales ? std::exp(3 * unit(random)) : 1;
        const Transform scaled = Transform::scale(size, size, size);
        if (i % 6 == 5) // not turned
          return scaled.then(moved);
        return scaled
            .then(Transform(
                rotationOf(axisRotation({unit(random), unit(random), 1}, 360 * unit(random)))))
            .then(moved);
      }
      if (!GetParam().scales)
        return moved;
      const double uniform = std::exp(unit(random)); // and mirrored, and not uniform
      return Transform::scale(i % 2 ? uniform : -uniform, i % 4 ? uniform : 0.3, uniform)
          .then(moved);
    };
    Placement placement;
    placement.transform = place();
    if (i % 4 == 1 && GetParam().turns)
      placement.transform =
          MovingTransform(MotionFactor{{0, 1}, {}, {turnAbout({unit(random), 1, 0}, 20, 300)}})
              .then(placement.transform);
    else if (i % 4 == 1)
      placement.transform = MovingTransform(MotionFactor{{0.25f, 0.75f}, {place(), place()}, {}});
    if (i % 2)
      scene.addPrimitive(ball, material, placement);
    else
      scene.addMeshInstance(mesh, material, placement);
  }
  const HostScene own(scene, false, 1);
  const RtslLaunch &cheap = own.deviceLaunch();
  constexpr std::uint32_t all = RTSL_HAS_LINEAR;
  EXPECT_EQ(cheap.needs & all, all & ~GetParam().absent);
  EXPECT_NE(cheap.needs & RTSL_HAS_TRANSFORMS, 0u);
  RtslLaunch general = cheap;
  general.needs |= all;
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Ray ray = randomRay(random, 1);
    RtslState a = makeState(cheap, ray.o, ray.d);
    a.Time = float(random()) * 0x1p-32f;
    RtslState b = a;
    b.launch = &general;
    ASSERT_EQ(own.traverse(a, 0), own.traverse(b, 0));
    ASSERT_NO_FATAL_FAILURE(expectSame(a, b, i));
    if (a.instance == RTSL_NO_HIT || cheap.instances[a.instance].transform == 0)
      continue;
    ++hits;
    for (RtslState *state : {&a, &b})
      describeHit(*state, RTSL_NEEDS_ALL & ~RTSL_NEEDS_HIT_ERRORS, device::LinkedSlots());
    EXPECT_EQ(std::memcmp(a.HitPoint, b.HitPoint, sizeof a.HitPoint), 0);
    EXPECT_EQ(std::memcmp(a.GeometricNormal, b.GeometricNormal, sizeof a.GeometricNormal), 0);
    EXPECT_EQ(std::memcmp(a.ShadingNormal, b.ShadingNormal, sizeof a.ShadingNormal), 0);
    EXPECT_EQ(std::memcmp(a.dPdu, b.dPdu, sizeof a.dPdu), 0);
    EXPECT_EQ(a.hitPointError, b.hitPointError);
    EXPECT_EQ(std::memcmp(a.WorldToObject, b.WorldToObject, sizeof a.WorldToObject), 0);
    const device::TransformAt ofA(cheap, cheap.instances[a.instance], a.Time),
        ofB(general, cheap.instances[a.instance], a.Time);
    const device::Vec3 o = device::pointToObject(cheap, ofA, ray.o),
                       p = device::pointToObject(general, ofB, ray.o),
                       d = device::vectorToObject(cheap, ofA, ray.d),
                       e = device::vectorToObject(general, ofB, ray.d);
    EXPECT_EQ(std::memcmp(&o, &p, sizeof o), 0) << i;
    EXPECT_EQ(std::memcmp(&d, &e, sizeof d), 0) << i;
  }
  EXPECT_GT(hits, 500);
}
INSTANTIATE_TEST_SUITE_P(Transforms, CheapForms,
                         testing::Values(CheapForm{false, false, RTSL_HAS_LINEAR},
                                         CheapForm{true, false, RTSL_HAS_TURNS},
                                         CheapForm{false, true, RTSL_HAS_SCALE | RTSL_HAS_STRETCH},
                                         CheapForm{true, true, RTSL_HAS_STRETCH}),
                         [](const auto &info) {
                           return std::string(info.param.turns
                                                  ? info.param.scales ? "TurnsAndScales" : "Turns"
                                              : info.param.scales ? "Scales"
                                                                  : "Translations");
                         });
