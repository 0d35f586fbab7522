//===- PathScene.h - diffuse parallelograms and meshes, for paths ---------===//
//
// Written as one writes a small renderer on Embree: parallelograms are Embree's quads, meshes its
// triangles, and some parallelograms are lamps.
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

/// Metal or plastic under a clear coat, as glTF's; with its own normals.
struct GlossyMesh {
  vec3 base;
  float metallic, roughness, coat, coatRoughness;
  rtsl::runtime::Mesh mesh;
};

/// Looks from a point at another one; `slope` is that of the upper edge, and up is y.
struct View {
  vec3 eye, target;
  float slope;
};

/// What blurs the picture out of focus: a polygon.
struct Lens {
  float distance = 1, radius = 0; // of what is in focus; of the corners
  int corners = 3;
};

/// The light of paths that leave the scene.
struct Sky {
  vec3 zenith{0}, horizon{0}, ground{0};
  float blur = 1;
};

struct PathWorld {
  View view;
  Lens lens;
  Sky sky;
  std::vector<Parallelogram> parallelograms;
  std::vector<DiffuseMesh> meshes;
  std::vector<GlossyMesh> glossy;
};

/// Reads a file with one thing a line:
///   camera EYE TARGET DEGREES                            from the lower to the upper edge
///   parallelogram ANCHOR SIDE SIDE REFLECTANCE RADIANCE
///   mesh REFLECTANCE FILE
///   lens DISTANCE RADIUS CORNERS
///   sky ZENITH HORIZON GROUND BLUR
///   glossy BASE METALLIC ROUGHNESS COAT COAT-ROUGHNESS FILE
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
  const GlossyMesh &glossy(const RTCHit &hit) const {
    return world.glossy[hit.geomID - 1 - world.meshes.size()];
  }

  RTCScene embree = nullptr;
  PathWorld world;
  std::vector<const Parallelogram *> lamps;
  float epsilon = 0;           // where rays begin and shadow rays end, by the size of the scene
  vec3 forward, right, upward; // of the camera, as long as half of the picture at distance 1

private:
  void attachParallelograms();
  void attach(rtsl::runtime::Mesh &mesh, unsigned number);

  RTCDevice device = nullptr;
};

} // namespace handwritten
