//===- BoxCases.cpp -------------------------------------------------------===//
#include "BoxCases.h"

#include "Exact.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// A direction with components of 0, -0 and of almost 0.
Vec3 thinDirection(Random &random) {
  const float tiny[] = {0.0f, -0.0f, 1e-30f, -1e-30f};
  float direction[3];
  for (float &component : direction)
    component = random.index(2) ? tiny[random.index(4)] : random.between(-1, 1);
  direction[random.index(3)] = random.index(2) ? 1.0f : -0.75f;
  return device::load(direction);
}

BoxCase originOnSlabs(Random &random, std::uint64_t) {
  const Box box = boxAround(random.inBox(2), random.inBox(2));
  float origin[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float choices[] = {box.lower[axis], box.upper[axis], random.between(-3, 3),
                             0.5f * (box.lower[axis] + box.upper[axis])};
    origin[axis] = choices[random.index(4)];
  }
  return {{device::load(origin), thinDirection(random)}, box};
}

BoxCase flat(Random &random, std::uint64_t number) {
  Box box = boxAround(random.inBox(2), random.inBox(2));
  const int axis = random.integer(0, 2);
  float upper[] = {box.upper.x, box.upper.y, box.upper.z};
  upper[axis] = box.lower[axis];
  if (number % 8 < 2) // a line
    upper[(axis + 1) % 3] = box.lower[(axis + 1) % 3];
  box.upper = device::load(upper);
  float target[3];
  for (int j = 0; j < 3; ++j)
    target[j] = random.between(box.lower[j], box.upper[j]);
  const Vec3 at = device::load(target), away = random.inBox(5);
  return {number % 2 ? Ray{at, thinDirection(random)} : Ray{away, at - away}, box};
}

BoxCase farAway(Random &random, std::uint64_t number) {
  const Vec3 place = random.inBox(number % 2 ? 1e8f : 1e-8f);
  const Box box = boxAround(place, place + random.inBox(number % 4 < 2 ? 1.0f : 1e-9f));
  const Vec3 origin = random.inBox(10);
  return {{origin, (box.lower - origin) * std::ldexp(1.0f, random.integer(-40, 40))}, box};
}

} // namespace

Box boxAround(Vec3 a, Vec3 b) {
  return {{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
          {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}};
}

bool BoxCase::meetsExactly() const {
  Rational near = 0;
  std::optional<Rational> far;
  for (int axis = 0; axis < 3; ++axis) {
    const Rational below = exact(box.lower[axis]) - exact(ray.origin[axis]),
                   above = exact(box.upper[axis]) - exact(ray.origin[axis]);
    if (ray.direction[axis] == 0) {
      if (below > 0 || above < 0)
        return false;
      continue;
    }
    const Rational d = exact(ray.direction[axis]);
    Rational enter = below / d, leave = above / d;
    if (leave < enter)
      std::swap(enter, leave);
    near = std::max(near, enter);
    far = far ? std::min(*far, leave) : leave;
  }
  return !far || near <= *far;
}

const std::vector<BoxKind> &boxKinds() {
  static const std::vector<BoxKind> kinds = {
      {"originsOnSlabs",
       "origins in the planes of sides, direction components of 0, -0 and 1e-30: boxes that the "
       "exact ray meets and that are not entered",
       originOnSlabs},
      {"flat", "boxes without thickness, aimed at or started from", flat},
      {"far", "boxes of size 1 and 1e-9 at 1e8 and 1e-8, directions of length 2^-40 to 2^40",
       farAway},
  };
  return kinds;
}

} // namespace rtsl::numerics
