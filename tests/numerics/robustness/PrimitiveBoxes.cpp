//===- PrimitiveBoxes.cpp - boxes of primitives, by the whole renderer ----===//
//
// A tree of eight boxes. One of them records that it was entered.
//
//===----------------------------------------------------------------------===//
#include "BoxCases.h"
#include "CompiledShaders.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include <algorithm>
#include <string>
#include <vector>

namespace rtsl::numerics {

namespace {

using device::Vec3;

class BoxTarget {
public:
  explicit BoxTarget(Path path)
      : shaders({"tests/numerics/robustness/shaders/Entered.rtsl",
                 "tests/numerics/robustness/shaders/Reader.rtsl",
                 "tests/numerics/robustness/shaders/Probe.rtsl"},
                {"Entered", "Reader", "Probe"}, {{"Entered", "Reader"}}, path) {}

  /// Among boxes that lie round about it, some of them without thickness too. Gives the tree's box
  /// for it, which is some ulps larger.
  Box place(Random &random, const Box &box) {
    shaders.restart();
    reader = shaders.scene().addObject("Reader");
    camera = shaders.scene().addObject("Probe");
    shaders.scene().setCamera(camera);
    const float around = 2 * std::max(device::largest(box.lower), device::largest(box.upper));
    const int number = random.integer(0, 7);
    std::uint32_t instance = 0;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner = random.inBox(around), other = random.inBox(around);
      const Box another =
          boxAround(corner, {random.integer(0, 1) ? corner.x : other.x, other.y, other.z});
      const std::uint32_t added = add(i == number ? box : another, i == number);
      instance = i == number ? added : instance;
    }
    shaders.finish();
    const runtime::Bounds bounds = shaders.scene().instanceBounds(instance);
    return {device::load(bounds.lower), device::load(bounds.upper)};
  }

  bool isEntered(const Ray &ray) const {
    shaders.set(camera, "origin", {ray.origin.x, ray.origin.y, ray.origin.z});
    shaders.set(camera, "direction", {ray.direction.x, ray.direction.y, ray.direction.z});
    return shaders.look()[0] != 0;
  }

private:
  std::uint32_t add(const Box &box, bool isThere) {
    const auto value = [](Vec3 v) { return runtime::Value{v.x, v.y, v.z}; };
    const RtslRef object = shaders.scene().addObject(
        "Entered", runtime::ObjectValues{{},
                                         {{"lower", value(box.lower)},
                                          {"upper", value(box.upper)},
                                          {"isThere", isThere ? 1.0 : 0.0}},
                                         {}});
    return shaders.scene().addPrimitive(object, reader);
  }

  CompiledShaders shaders;
  RtslRef reader = 0, camera = 0;
};

BoxTarget &target(Path path) {
  static BoxTarget only(path); // a program has one
  return only;
}

/// The origin stays in the planes of sides where it was in them.
Vec3 movedWithSides(Vec3 origin, const Box &from, const Box &to) {
  float moved[3];
  for (int i = 0; i < 3; ++i)
    moved[i] = origin[i] == from.lower[i]   ? to.lower[i]
               : origin[i] == from.upper[i] ? to.upper[i]
                                            : origin[i];
  return device::load(moved);
}

Outcome runKind(Path path, const BoxKind &kind, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed), others(seed + 1);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    BoxCase given = kind.make(random, i);
    const Box inTree = target(path).place(others, given.box);
    given = {{movedWithSides(given.ray.origin, given.box, inTree), given.ray.direction}, inTree};
    worst.count(!target(path).isEntered(given.ray) && given.meetsExactly(),
                [&] { return given.text(); });
  }
  return worst.outcome();
}

double nanosecondsABox(Path path) {
  Random random(1);
  target(path).place(random, {{-1, -1, -1}, {1, 1, 1}});
  constexpr int count = 100'000;
  return timeOf(count, [&] {
    int found = 0;
    for (int i = 0; i < count; ++i)
      found += target(path).isEntered({{0.001f * float(i & 255), 0.25f, 5}, {0, 0, -1}});
    return found;
  });
}

} // namespace

std::vector<Row> primitiveBoxRows(Path path) {
  std::vector<Row> rows;
  for (const BoxKind &kind : boxKinds())
    rows.push_back({std::string("bounds.") + kind.name,
                    std::string("bounds of primitives in a scene: ") + kind.description, "misses",
                    200'000,
                    [path, &kind](std::uint64_t cases, std::uint32_t seed) {
                      return runKind(path, kind, cases, seed);
                    },
                    [path] { return nanosecondsABox(path); }});
  return rows;
}

} // namespace rtsl::numerics
