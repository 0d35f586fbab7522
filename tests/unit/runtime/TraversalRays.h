//===- TraversalRays.h - rays for tests of traversal ----------------------===//
#pragma once

#include "runtime/device/ray/Vector.h"
#include "runtime/scene/Scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace rtsl::runtime::test {

inline RtslState makeState(const RtslLaunch &launch, device::Vec3 o, device::Vec3 d,
                           float epsilon = 0, float distance = INFINITY) {
  RtslState state;
  std::memset(&state, 0x7f, sizeof state); // nothing may rely on cleared memory
  state.launch = &launch;
  state.Time = 0;
  state.rayMask = ~0u;
  state.rayRoot = 0;
  device::store(state.RayOrigin, o);
  device::store(state.RayDirection, d);
  state.Epsilon = epsilon;
  state.HitDistance = distance;
  state.isEasy = 0;
  state.instance = state.primitive = RTSL_NO_HIT;
  return state;
}

struct Ray {
  device::Vec3 o, d;
};

/// All kinds: inside, outside, along axes, from grid planes, long and short directions.
inline Ray randomRay(std::mt19937 &random, float scale) {
  std::uniform_real_distribution<float> wide(-15, 15), unit(-1, 1);
  float numbers[6];
  for (int i = 0; i < 3; ++i)
    numbers[i] = scale * wide(random);
  for (int i = 3; i < 6; ++i)
    numbers[i] = unit(random);
  Ray ray{device::load(numbers), device::load(numbers + 3)};
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

inline void expectSame(const RtslState &a, const RtslState &b, int i) {
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

} // namespace rtsl::runtime::test
