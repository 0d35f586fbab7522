//===- FakeProgram.h - a program whose shaders are C++ --------------------===//
//
// A pinhole camera, spheres, and a handful of materials, lights and backgrounds, written against
// the same Abi.h as compiled ones. Records are the structs below.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/program/Program.h"
#include "runtime/scene/Scene.h"

#include <memory>

namespace rtsl::runtime::test {

enum ClassId : std::uint32_t {
  cameraId = 1,
  sphereId,
  lambertId,
  mirrorId,
  noiseId,
  normalId,
  lightId,
  skyId,
  boxedId,
  chooserId,
};

struct CameraRecord {
  std::uint32_t id;
  float eye[3], gaze[3], up[3]; // rays: gaze + (2s-1) aspect right + (2t-1) up
};
struct SphereRecord {
  std::uint32_t id;
  float center[3], radius;
};
struct LambertRecord {
  std::uint32_t id;
  float albedo[3];
};
struct LightRecord {
  std::uint32_t id;
  float position[3], intensity[3];
};
struct SkyRecord {
  std::uint32_t id;
  float low[3], high[3];
};
/// A primitive that only has bounds, for tests of those.
struct BoxedRecord {
  std::uint32_t id;
  float lower[3], upper[3];
};

/// Classes Camera, Sphere, Lambert, Mirror, Noise, Normal, Light, Sky, Boxed, Chooser, and
/// Everything, a material with one member of each type. A Sphere that holds several primitives is a
/// row of spheres. A Chooser visits child 0, 1 or both, by the ray.
std::shared_ptr<Program> fakeProgram();

Value vector(double x, double y, double z);

/// Members by name in one line.
ObjectValues members(std::vector<NamedValue> values);

/// A Camera at the origin that looks along z, for a program that has the class.
void setCameraAtOrigin(Scene &scene);

} // namespace rtsl::runtime::test
