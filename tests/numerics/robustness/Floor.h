//===- Floor.h - one material, evaluated through rays ---------------------===//
//
// The examples' materials scatter inside of `shade`, so each is asked by rays: a floor of the
// material under surroundings whose color says where light came from.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "CompiledShaders.h"
#include "Generators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace rtsl::numerics {

inline const std::string ownShaders = "tests/numerics/robustness/shaders/";

/// A floor at y = 0 of one material.
class Floor {
public:
  Floor(const std::string &materialFile, const char *materialClass, Path path,
        bool isSampled = false)
      : shaders({"examples/glass/Parallelogram.rtsl", materialFile, "examples/glass/BallLight.rtsl",
                 ownShaders + "White.rtsl", ownShaders + "Probe.rtsl",
                 ownShaders + "Surroundings.rtsl"},
                {"Parallelogram", materialClass, "BallLight", "White", "Probe", "Surroundings"},
                {{"Parallelogram", materialClass}}, path, isSampled) {
    runtime::Scene &scene = shaders.scene();
    camera = scene.addObject("Probe");
    surroundings = scene.addObject("Surroundings");
    light = scene.addObject("BallLight", runtime::ObjectValues{{}, {{"position", {0, 1, 0}}}, {}});
    if (std::string(materialClass) == "Glass")
      material = scene.addObject("Glass", std::vector<runtime::Value>{1.5, 1.0, {1, 1, 1}});
    else if (hasAlbedo(scene, materialClass))
      material = scene.addObject(
          materialClass,
          runtime::ObjectValues{
              {}, {{"albedo", runtime::Value::reference(scene.addObject("White"))}}, {}});
    else
      material = scene.addObject(materialClass);
    const RtslRef floor = scene.addObject(
        "Parallelogram", std::vector<runtime::Value>{{-1e4, 0, 1e4}, {2e4, 0, 0}, {0, 0, -2e4}});
    scene.addPrimitive(floor, material);
    scene.addLight(light);
    scene.setCamera(camera);
    scene.setBackground(surroundings);
    shaders.finish();
  }

  const runtime::Scene &scene() const { return shaders.scene(); }
  void set(RtslRef object, const char *name, std::initializer_list<float> values) const {
    shaders.set(object, name, values);
  }

  /// The color that comes from along the ray.
  std::array<float, 3> look(device::Vec3 origin, device::Vec3 direction,
                            std::uint32_t seed = 1) const {
    set(camera, "origin", {origin.x, origin.y, origin.z});
    set(camera, "direction", {direction.x, direction.y, direction.z});
    return shaders.look(seed);
  }

private:
  static bool hasAlbedo(const runtime::Scene &scene, const char *name) {
    const std::vector<runtime::MemberInfo> &members = scene.program().find(name)->members;
    return std::any_of(members.begin(), members.end(),
                       [](const runtime::MemberInfo &member) { return member.name == "albedo"; });
  }

  CompiledShaders shaders;

public:
  RtslRef camera, surroundings, light, material;
};

/// A cosine in (0, 1]: 1, nearly 1, nearly 0, or anything.
inline float randomCosine(Random &random) {
  switch (random.integer(0, 5)) {
  case 0:
    return 1;
  case 1:
    return 1 - std::ldexp(1.0f, -random.integer(2, 24));
  case 2:
    return std::ldexp(1.0f, -random.integer(1, 12));
  default:
    return random.between(0x1p-12f, 1);
  }
}
inline float sineOf(float cosine) {
  return std::sqrt((1 - cosine) * (1 + cosine));
}

/// A ray to the origin in the plane of x and y, from above or from below.
struct Incidence {
  device::Vec3 origin, direction;
};
inline Incidence incidence(float cosine, bool isAbove, float length) {
  const float sine = sineOf(cosine), side = isAbove ? 1.0f : -1.0f;
  const device::Vec3 direction = device::Vec3{sine, -side * cosine, 0} * length;
  return {device::Vec3{-sine, side * cosine, 0}, direction};
}

} // namespace rtsl::numerics
