//===- RayTarget.h - one thing alone in its scene -------------------------===//
#pragma once

#include "CompiledShaders.h"
#include "Generators.h"
#include "HighPrecision.h"
#include "Timing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace rtsl::numerics {

/// All coordinates are smaller: the bounds of the tree.
constexpr float targetRoom = 3e7f;

/// A primitive that a row places anew for each ray, or a mesh.
class RayTarget {
public:
  /// `file` has the primitive's class; `values` are of an object that fills targetRoom.
  RayTarget(const char *file, const char *className, std::vector<runtime::NamedValue> values,
            Path path)
      : shaders({file, "tests/numerics/robustness/shaders/Reader.rtsl",
                 "tests/numerics/robustness/shaders/Probe.rtsl"},
                {className, "Reader", "Probe"}, {{className, "Reader"}}, path) {
    object = shaders.scene().addObject(className, runtime::ObjectValues{{}, std::move(values), {}});
    addWatchers();
    shaders.scene().addPrimitive(object, reader);
    shaders.finish();
  }
  RayTarget(runtime::Mesh mesh, Path path) : RayTarget(path) { replaceBy(std::move(mesh)); }
  /// Nothing yet.
  explicit RayTarget(Path path)
      : shaders({"tests/numerics/robustness/shaders/Reader.rtsl",
                 "tests/numerics/robustness/shaders/Probe.rtsl"},
                {"Reader", "Probe"}, {{"", "Reader"}}, path) {}

  /// Puts another mesh in the place of the one that there was.
  void replaceBy(runtime::Mesh mesh) {
    shaders.restart();
    addWatchers();
    shaders.scene().addMeshInstance(shaders.scene().addMesh(std::move(mesh)), reader);
    shaders.finish();
  }

  void set(const char *name, std::initializer_list<float> values) const {
    shaders.set(object, name, values);
  }

  /// Where the ray meets it, in units of its direction; nothing if it does not. Not a number if the
  /// answer is none.
  std::optional<float> meet(device::Vec3 origin, device::Vec3 direction) const {
    shaders.set(reader, "asks", {0});
    const std::array<float, 3> color = look(origin, direction);
    return color[0] != 0 ? std::optional(color[1]) : std::nullopt;
  }
  /// The hit point of a ray that meets it.
  device::Vec3 hitPoint(device::Vec3 origin, device::Vec3 direction) const {
    shaders.set(reader, "asks", {2});
    return device::load(look(origin, direction).data());
  }
  /// The ray meets it; does one that is sent on from there meet it again? The triangle that it
  /// meets, or 0 of what is no mesh.
  std::optional<int> meetsNext(device::Vec3 origin, device::Vec3 direction,
                               device::Vec3 onwards) const {
    const float next = askOnwards(1, origin, direction, onwards);
    return next != 0 ? std::optional(int(std::lround(next)) - 1) : std::nullopt;
  }
  bool meetsAgain(device::Vec3 origin, device::Vec3 direction, device::Vec3 onwards) const {
    return meetsNext(origin, direction, onwards).has_value();
  }
  /// The same: does it meet anything within `distance`, in units of `onwards`?
  bool meetsWithin(float distance, device::Vec3 origin, device::Vec3 direction,
                   device::Vec3 onwards) const {
    const float t = askOnwards(4, origin, direction, onwards);
    return t > 0 && t <= distance;
  }
  /// The same: how far it sees nothing, in units of `onwards`; nothing if it meets nothing.
  std::optional<float> startOfNext(device::Vec3 origin, device::Vec3 direction,
                                   device::Vec3 onwards) const {
    const float epsilon = askOnwards(3, origin, direction, onwards);
    return epsilon != 0 ? std::optional(epsilon) : std::nullopt;
  }

private:
  /// What Reader.rtsl says of the ray that is sent on, if it is asked for this.
  float askOnwards(float what, device::Vec3 origin, device::Vec3 direction,
                   device::Vec3 onwards) const {
    shaders.set(reader, "asks", {what});
    shaders.set(reader, "onwards", {onwards.x, onwards.y, onwards.z});
    return look(origin, direction)[2];
  }

  std::array<float, 3> look(device::Vec3 origin, device::Vec3 direction) const {
    shaders.set(camera, "origin", {origin.x, origin.y, origin.z});
    shaders.set(camera, "direction", {direction.x, direction.y, direction.z});
    return shaders.look();
  }

  void addWatchers() {
    reader = shaders.scene().addObject("Reader");
    camera = shaders.scene().addObject("Probe");
    shaders.scene().setCamera(camera);
  }

  CompiledShaders shaders;
  RtslRef object = 0, reader = 0, camera = 0;
};

/// For all rows that make meshes of their own.
inline RayTarget &changingMesh(Path path) {
  static RayTarget only(path); // a program has one
  return only;
}

inline float powerOfTen(Random &random, float low, float high) {
  return std::pow(10.0f, random.between(low, high));
}

/// A ray along an axis that passes the centre of something of this size at about `impact`, from
/// `distance` away. Coordinates across are small in their own right, so that even a size of 1e-6
/// can be aimed at from 1e7.
inline Ray aimedAlongAnAxis(Random &random, device::Vec3 center, float size, float distance,
                            float impact) {
  const float angle = random.between(0, 6.2831853f), tilt = random.between(-4, 4) * size,
              slant = random.between(-4, 4) * size;
  const float across = impact * std::cos(angle), up = impact * std::sin(angle);
  const float towards[3] = {-1, (across - tilt) / distance, (up - slant) / distance},
              from[3] = {distance, tilt, slant};
  const int axis = random.integer(0, 2);
  const float sign = random.integer(0, 1) ? 1.0f : -1.0f,
              scale = random.between(1, 2) * std::ldexp(1.0f, random.integer(-10, 10));
  float origin[3], direction[3];
  for (int i = 0; i < 3; ++i) {
    origin[(axis + i) % 3] = from[i] * (i == 0 ? sign : 1);
    direction[(axis + i) % 3] = towards[i] * (i == 0 ? sign : 1) * scale;
  }
  return {center + device::load(origin), device::load(direction)};
}

/// The same along any direction, where the distance leaves digits for it.
inline Ray aimedFrom(Random &random, device::Vec3 center, float size, float distance,
                     float impact) {
  if (distance > 1e5f * size || random.integer(0, 1))
    return aimedAlongAnAxis(random, center, size, distance, impact);
  const device::Vec3 towards = random.direction(),
                     beside = device::normalized(device::cross(towards, random.direction()));
  const device::Vec3 origin = center - towards * distance, aim = center + beside * impact;
  return {origin,
          (aim - origin) * (random.between(1, 2) * std::ldexp(1.0f, random.integer(-10, 10)))};
}

/// A rounding unit of the largest coordinate of a ray up to t: what device::primitivePointError
/// bounds is so many of them.
inline Precise pointUnit(const Ray &ray, float t) {
  return Precise(0x1p-24) * (Precise(device::largest(ray.origin)) +
                             abs(Precise(t)) * Precise(device::largest(ray.direction)));
}

/// The point at t as the renderer computes it.
inline device::Vec3 pointAt(const Ray &ray, float t) {
  return ray.origin + ray.direction * t;
}

/// Of a ray from in front of a target that it meets, about the origin.
template <typename Target>
double nanosecondsToMeet(Target &target) {
  constexpr int count = 100'000;
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += *target.meet({0.001f * float(i & 255), 0.25f, 5}, {0, 0, -1});
    return sum;
  });
}

} // namespace rtsl::numerics
