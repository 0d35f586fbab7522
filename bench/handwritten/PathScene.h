//===- PathScene.h - diffuse parallelograms and meshes, for paths ---------===//
//
// Written as one writes a small renderer on Embree: parallelograms are Embree's quads, meshes its
// triangles, and one parallelogram is the lamp.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "Picture.h"

#include "runtime/geometry/Mesh.h"

#include <embree3/rtcore.h>

#include <string>
#include <vector>

namespace handwritten {

struct Parallelogram {
  vec3 anchor, side1, side2, reflectance, radiance;
  vec3 normal;
  float area;

  bool isLamp() const { return radiance != vec3(0); }
};

struct DiffuseMesh {
  vec3 reflectance;
  rtsl::runtime::Mesh mesh;
};

/// Looks from a point at another one; `slope` is that of the upper edge, and up is y.
struct View {
  vec3 eye, target;
  float slope;
};

struct PathWorld {
  View view;
  std::vector<Parallelogram> parallelograms;
  std::vector<DiffuseMesh> meshes;
};

/// Reads a file with one thing a line:
///   camera EYE TARGET DEGREES                            from the lower to the upper edge
///   parallelogram ANCHOR SIDE SIDE REFLECTANCE RADIANCE
///   mesh REFLECTANCE FILE
PathWorld readPathWorld(const std::string &file);

class PathScene {
public:
  explicit PathScene(PathWorld given);
  ~PathScene();
  PathScene(const PathScene &) = delete;
  PathScene &operator=(const PathScene &) = delete;

  /// The parallelogram that was hit; null: a triangle.
  const Parallelogram *parallelogram(const RTCHit &hit) const {
    return hit.geomID == 0 ? &world.parallelograms[hit.primID] : nullptr;
  }
  const DiffuseMesh &mesh(const RTCHit &hit) const { return world.meshes[hit.geomID - 1]; }

  RTCScene embree = nullptr;
  PathWorld world;
  const Parallelogram *lamp = nullptr;
  float epsilon = 0;           // where rays begin and shadow rays end, by the size of the scene
  vec3 forward, right, upward; // of the camera, as long as half of the picture at distance 1

private:
  void attachParallelograms();
  void attach(DiffuseMesh &mesh);

  RTCDevice device = nullptr;
};

} // namespace handwritten
