//===- Scene.h - examples/glass as numbers and an Embree scene ------------===//
//
// scene.json, written by hand in C++. Nothing here is general: geometry, materials and
// lights are those of this scene.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "Picture.h"

#include "runtime/geometry/Mesh.h"

#include <embree3/rtcore.h>

#include <array>

namespace handwritten {

struct Sphere {
  vec3 center;
  float radius;
};

struct Floor {
  vec3 anchor{-8, 0, 6}, side1{16, 0, 0}, side2{0, 0, -16};
  vec3 normal = glm::normalize(glm::cross(side1, side2));
  // dot(inverse1, p - anchor) is the coordinate of p along side1, in [0, 1].
  vec3 inverse1 = side1 / glm::dot(side1, side1);
  vec3 inverse2 = side2 / glm::dot(side2, side2);
};

/// Embree's ids of the geometries, in the order in which they are attached.
enum Geometry : unsigned { floorGeometry, sphereGeometry, knotGeometry };

/// The spheres, by Embree's primitive id.
enum SphereId : unsigned { glassSphere, plasterSphere };

class Scene {
public:
  /// Takes the knot, already where it stands. Throws std::runtime_error with Embree's message.
  explicit Scene(rtsl::runtime::Mesh knot);
  ~Scene();
  Scene(const Scene &) = delete;
  Scene &operator=(const Scene &) = delete;

  RTCScene embree() const { return scene; }
  /// The normal of the knot's vertices, interpolated; not unit.
  vec3 knotNormal(unsigned triangle, float u, float v) const;

  Camera camera;
  Floor floor;
  std::array<Sphere, 2> spheres{{{{-1.1f, 1, 0.6f}, 1}, {{0.55f, 0.45f, 2}, 0.45f}}};
  std::array<BallLight, 2> lights{{{{4, 6, 4}, 0.4f, {38, 36, 33}}, {{-5, 4, 2}, 0.4f, {6, 7, 9}}}};
  vec3 ambient{0.12f, 0.13f, 0.16f};

private:
  void attachFloor();
  void attachSpheres();
  void attachKnot();

  rtsl::runtime::Mesh knot;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
};

} // namespace handwritten
