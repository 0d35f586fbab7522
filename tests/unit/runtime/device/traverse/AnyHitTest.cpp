// Materials that may refuse hits: our traversal against trying everything and sorting.
#include "tests/unit/runtime/FakeProgram.h"

#include "runtime/device/ray/Random.h"
#include "runtime/device/traverse/AnyHit.h"
#include "runtime/embree/HostScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <set>
#include <tuple>

using namespace rtsl::runtime;
using namespace rtsl::runtime::test;
using rtsl::device::Vec3;

namespace {

constexpr std::uint32_t rayType = 3;

/// The queries of `anyHit`, as (t, instance, primitive, u).
using Asked = std::vector<std::tuple<float, std::uint32_t, std::uint32_t, float>>;
Asked asked;
unsigned refusedOf16 = 0;
bool hitsAreDescribed = true;

std::uint32_t answerFor(std::uint32_t instance, std::uint32_t primitive) {
  std::uint32_t hash = rtsl::device::hash3(instance, primitive, 5).x % 16;
  return hash < refusedOf16 ? RTSL_IGNORE : hash % 2 ? RTSL_ACCEPT : RTSL_TERMINATE;
}

void anyHit(RtslState *state, RtslRef) {
  bool isTriangle = state->launch->instances[state->instance].primitive == 0;
  asked.emplace_back(state->HitDistance, state->instance, state->primitive,
                     isTriangle ? state->u : 0.0f);
  hitsAreDescribed &= state->PrimitiveIndex == int(state->primitive) &&
                      state->InstanceIndex == int(state->instance);
  state->hitAnswer = answerFor(state->instance, state->primitive);
}

/// Layers of triangles that overlap, some of them twice, and spheres among them; every third
/// instance has no `anyHit`.
std::shared_ptr<Program> askingProgram() {
  std::shared_ptr<Program> program = fakeProgram();
  for (ClassInfo &info : program->classes)
    if (info.name == "Normal")
      info.anyHit = rtslRayTypeBit(rayType);
  program->slots.rt_Material_anyHit_payload = anyHit;
  return program;
}

Scene layers(unsigned seed, bool allInvoke) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> wide(-4, 4), deep(0, 20);
  Scene scene(askingProgram());
  setCameraAtOrigin(scene);
  RtslRef asks = scene.addObject("Normal", members({})),
          accepts = scene.addObject("Mirror", members({}));
  for (int part = 0; part < 4; ++part) {
    Mesh mesh;
    for (unsigned i = 0; i < 40; ++i) {
      float z = std::floor(deep(random)); // several in one plane
      for (int corner = 0; corner < 3; ++corner)
        for (float x : {wide(random), wide(random), z})
          mesh.positions.push_back(x);
      for (unsigned copy = 0; copy < (i % 10 == 0 ? 2u : 1u); ++copy)
        for (unsigned k = 0; k < 3; ++k)
          mesh.indices.push_back(3 * i + k);
    }
    scene.addMeshInstance(scene.addMesh(std::move(mesh)), allInvoke || part != 2 ? asks : accepts);
  }
  for (int i = 0; i < 10; ++i)
    scene.addPrimitive(
        scene.addObject("Sphere", {vector(wide(random), wide(random), deep(random)), 1.5}),
        allInvoke || i % 3 ? asks : accepts);
  return scene;
}

RtslState ray(const RtslLaunch &launch, Vec3 o, Vec3 d, float distance) {
  RtslState state;
  std::memset(&state, 0x7f, sizeof state);
  state.launch = &launch;
  state.rayType = rayType;
  state.rayMask = ~0u;
  state.rayRoot = 0;
  state.dimension = 0;
  rtsl::device::store(state.RayOrigin, o);
  rtsl::device::store(state.RayDirection, d);
  state.Epsilon = 0;
  state.HitDistance = distance;
  state.isEasy = 0;
  state.instance = state.primitive = RTSL_NO_HIT;
  return state;
}

/// All hits of a ray, by brute force, in order; then those queried until one is accepted.
std::uint32_t expected(RtslState state, float distance, Asked &inOrder, RtslState &accepted) {
  const RtslLaunch &launch = *state.launch;
  auto triangleRay = rtsl::device::makeTriangleRay(rtsl::device::load(state.RayOrigin),
                                                   rtsl::device::load(state.RayDirection));
  std::vector<RtslState> hits;
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const RtslInstance &instance = launch.instances[i];
    std::uint32_t count = instance.primitive ? 1 : launch.meshes[instance.mesh].triangleCount;
    for (std::uint32_t p = 0; p < count; ++p) {
      RtslState one = state;
      one.HitDistance = distance;
      rtsl::device::beginSearch(one);
      if (instance.primitive) {
        rtsl::device::testPrimitive(one, triangleRay, instance, {i, 0},
                                    rtsl_rt_Primitive_intersect);
      } else {
        rtsl::device::testTriangle(one, triangleRay, launch.meshes[instance.mesh], i, p);
      }
      if (rtsl::device::endSearch(one) == RTSL_HIT)
        hits.push_back(one);
    }
  }
  std::sort(hits.begin(), hits.end(), [](const RtslState &a, const RtslState &b) {
    return std::tie(a.HitDistance, a.instance, a.primitive) <
           std::tie(b.HitDistance, b.instance, b.primitive);
  });
  for (const RtslState &hit : hits) {
    accepted = hit;
    if (!(launch.instances[hit.instance].anyHit & rtslRayTypeBit(rayType)))
      return RTSL_HIT;
    bool isTriangle = launch.instances[hit.instance].primitive == 0;
    inOrder.emplace_back(hit.HitDistance, hit.instance, hit.primitive, isTriangle ? hit.u : 0.0f);
    if (answerFor(hit.instance, hit.primitive) != RTSL_IGNORE)
      return RTSL_HIT;
  }
  return RTSL_MISS;
}

} // namespace

TEST(AnyHit, IsQueriedOnceInOrderUntilAHitIsAccepted) {
  std::size_t longest = 0;
  unsigned hits = 0, misses = 0;
  for (bool allInvoke : {false, true}) {
    Scene scene = layers(3, allInvoke);
    HostScene own(scene, false, 1), embree(scene, true, 1);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> wide(-3, 3), small(-0.3f, 0.3f);
    for (unsigned refused : {0u, 8u, 14u, 16u}) {
      refusedOf16 = refused;
      for (int i = 0; i < 500; ++i) {
        float distance = i % 4 ? INFINITY : 12;
        RtslState start = ray(own.deviceLaunch(), {wide(random), wide(random), -1},
                              {small(random), small(random), 1}, distance);
        Asked inOrder;
        RtslState accepted = start;
        std::uint32_t answer = expected(start, distance, inOrder, accepted);
        for (const HostScene *host : {&own, &embree}) {
          RtslState state = start;
          asked.clear();
          ASSERT_EQ(host->traverse(state, RTSL_INVOKE_ANY_HIT | RTSL_IN_ORDER), answer) << i;
          ASSERT_EQ(asked, inOrder) << i;
          if (answer == RTSL_HIT) {
            ASSERT_EQ(state.HitDistance, accepted.HitDistance);
            ASSERT_EQ(state.instance, accepted.instance);
            ASSERT_EQ(state.primitive, accepted.primitive);
          } else {
            ASSERT_EQ(state.instance, RTSL_NO_HIT);
            ASSERT_EQ(state.HitDistance, distance);
          }
        }
        longest = std::max(longest, inOrder.size());
        ++(answer == RTSL_HIT ? hits : misses);
      }
    }
  }
  EXPECT_TRUE(hitsAreDescribed);
  EXPECT_GT(longest,
            2 * rtsl::device::NearestCandidates::room); // so that several descents were needed
  EXPECT_GT(hits, 1000u);
  EXPECT_GT(misses, 500u);
}

// As with --fp=fast, where code that is there twice may round in two ways.
TEST(AnyHit, AHitThatIsNotFoundAgainDoesNotCount) {
  std::shared_ptr<Program> program = askingProgram();
  static std::set<RtslRef> lost, found; // spheres; those of the first that were found once
  lost.clear();
  program->slots.rt_Primitive_intersect = [](RtslState *state, RtslRef object) {
    if (lost.count(object) == 0 || found.insert(object).second)
      rtsl_rt_Primitive_intersect(state, object);
    else
      found.erase(object);
  };
  constexpr unsigned count = 2 * rtsl::device::NearestCandidates::room + 3;
  Scene scene(program);
  setCameraAtOrigin(scene);
  const RtslRef asks = scene.addObject("Normal", members({})),
                accepts = scene.addObject("Mirror", members({}));
  std::vector<RtslRef> spheres;
  for (unsigned i = 0; i < count; ++i) {
    spheres.push_back(scene.addObject("Sphere", {vector(0, 0, 5.0 + 3 * i), 1.0}));
    scene.addPrimitive(spheres.back(), i % 3 == 1 ? accepts : asks);
  }
  HostScene own(scene, false, 1), embree(scene, true, 1);
  refusedOf16 = 16;
  for (unsigned first = 0; first <= count; ++first) { // that is not lost
    lost = {spheres.begin(), spheres.begin() + first};
    const unsigned expected = first + (4 - first % 3) % 3; // the next one that accepts
    for (const HostScene *host : {&own, &embree}) {
      RtslState state = ray(own.deviceLaunch(), {0, 0, 0}, {0, 0, 1}, INFINITY);
      asked.clear();
      found.clear();
      const std::uint32_t answer = host->traverse(state, RTSL_INVOKE_ANY_HIT | RTSL_IN_ORDER);
      ASSERT_EQ(answer, expected < count ? RTSL_HIT : RTSL_MISS) << first;
      ASSERT_EQ(state.instance, expected < count ? expected : RTSL_NO_HIT) << first;
      ASSERT_EQ(asked.size(), std::min(expected, count) - first);
    }
  }
}

TEST(AnyHit, InAnyOrderTheNearestAcceptedHitCounts) {
  Scene scene = layers(5, false);
  HostScene host(scene, true, 1);
  std::mt19937 random(6);
  std::uniform_real_distribution<float> wide(-3, 3), small(-0.3f, 0.3f);
  unsigned hits = 0;
  for (unsigned refused : {0u, 8u, 14u, 16u}) {
    refusedOf16 = refused;
    for (int i = 0; i < 500; ++i) {
      RtslState start = ray(host.deviceLaunch(), {wide(random), wide(random), -1},
                            {small(random), small(random), 1}, INFINITY);
      Asked inOrder;
      RtslState accepted = start;
      std::uint32_t answer = expected(start, INFINITY, inOrder, accepted);

      asked.clear();
      RtslState first = start;
      ASSERT_EQ(host.traverse(first, RTSL_INVOKE_ANY_HIT | RTSL_FIRST_HIT), answer) << i;
      std::set<std::tuple<std::uint32_t, std::uint32_t>> once;
      for (const auto &one : asked)
        EXPECT_TRUE(once.insert({std::get<1>(one), std::get<2>(one)}).second) << "asked twice";

      // If no hit terminates the ray, the result is the nearest accepted hit.
      bool terminates = false;
      RtslState nearest = start;
      asked.clear();
      ASSERT_EQ(host.traverse(nearest, RTSL_INVOKE_ANY_HIT), answer) << i;
      for (const auto &one : asked)
        terminates |= answerFor(std::get<1>(one), std::get<2>(one)) == RTSL_TERMINATE;
      if (terminates)
        continue;
      ASSERT_EQ(nearest.instance, answer == RTSL_HIT ? accepted.instance : RTSL_NO_HIT) << i;
      if (answer == RTSL_HIT) {
        ASSERT_EQ(nearest.primitive, accepted.primitive);
        ASSERT_EQ(nearest.HitDistance, accepted.HitDistance);
        ++hits;
      }
    }
  }
  EXPECT_GT(hits, 100u);
}

TEST(AnyHit, MasksHideInstancesFromEveryTraversal) {
  std::shared_ptr<Program> program = askingProgram();
  Scene scene(program);
  setCameraAtOrigin(scene);
  RtslRef material = scene.addObject("Mirror", members({}));
  scene.addPrimitive(scene.addObject("Sphere", {vector(0, 0, 5), 1.0}), material, {{}, 1});
  scene.addPrimitive(scene.addObject("Sphere", {vector(0, 0, 9), 1.0}), material, {{}, 6});
  for (bool useEmbree : {false, true}) {
    HostScene host(scene, useEmbree, 1);
    auto seen = [&](std::uint32_t mask, std::int32_t root = 0) {
      RtslState state = ray(host.deviceLaunch(), {0, 0, 0}, {0, 0, 1}, INFINITY);
      state.rayMask = mask;
      state.rayRoot = root;
      std::uint32_t answer = host.traverse(state, 0);
      return answer == RTSL_HIT ? state.instance : RTSL_NO_HIT;
    };
    EXPECT_EQ(seen(~0u), 0u);
    EXPECT_EQ(seen(1), 0u);
    EXPECT_EQ(seen(2), 1u);
    EXPECT_EQ(seen(4), 1u);
    EXPECT_EQ(seen(5), 0u);
    EXPECT_EQ(seen(8), RTSL_NO_HIT);
    EXPECT_EQ(seen(0), RTSL_NO_HIT);
    EXPECT_EQ(seen(~0u, 1), RTSL_NO_HIT);
  }
}
