//===- Geometry.h - the meshes and instances of a scene -------------------===//
//
// Rays hit instances. An instance is an object of the program, which is one primitive or several,
// or a mesh, with a material and a transform.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "runtime/scene/InstanceTransform.h"
#include "runtime/scene/MeshValues.h"
#include "runtime/scene/Objects.h"
#include "runtime/scene/SceneData.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::runtime {

class Geometry {
public:
  /// Scene::setShutter.
  void setShutter(float open, float close);
  /// Scene::addPrimitive. `launch` returns the scene's current launch, for `computeBounds`.
  std::uint32_t addPrimitive(const Objects &objects, RtslRef primitive, RtslRef material,
                             const Placement &placement, std::uint32_t count,
                             const std::function<RtslLaunch()> &launch,
                             std::vector<Warning> &warnings);
  /// To be called after a member of a primitive has changed: runs `computeBounds` again, for all of
  /// its instances. Throws DegenerateGeometry, and leaves bounds as they were.
  void updatePrimitive(const Objects &objects, RtslRef primitive,
                       const std::function<RtslLaunch()> &launch, std::vector<Warning> &warnings);
  /// Scene::addSelector.
  std::uint32_t addSelector(const Objects &objects, RtslRef selector, std::uint32_t children,
                            const MovingTransform &transform, std::uint32_t above);
  /// Scene::addMesh.
  std::uint32_t addMesh(Mesh mesh, const std::string &name, const Transform &applied);
  /// Scene::addMeshInstance.
  std::uint32_t addMeshInstance(const Objects &objects, std::uint32_t mesh, RtslRef material,
                                const Placement &placement);

  /// Scene::moveInstance and moveMesh.
  void moveInstance(std::uint32_t instance, const MovingTransform &transform);
  void moveMesh(std::uint32_t mesh, std::vector<float> positions, std::vector<float> normals);
  /// Scene::positions. Throws UnknownName.
  const std::vector<float> &positions(std::uint32_t mesh) const;
  /// Scene::moves, movesOfMesh and structure.
  std::uint64_t allMoves() const { return moves; }
  std::uint64_t movesOfMesh(std::uint32_t mesh) const { return meshes.at(mesh)->moves; }
  std::uint64_t structure() const {
    return instances.size() + ((transformsGained + primitivesChanged) << 32);
  }

  /// Updates RtslInstance::needs, which depends on the program and on members of materials.
  void updateNeeds(const Objects &objects);
  /// Called after Objects::useProgram: updates RtslInstance::needs, and drops data of meshes that
  /// no material on them reads, unless the program keeps it.
  void useProgram(const Objects &objects);
  /// Set by useProgram.
  const std::vector<MeshAttribute> &meshAttributes() const { return attributes; }

  const std::vector<RtslInstance> &all() const { return instances; }
  const std::vector<RtslSelection> &allSelections() const { return selections; }
  /// RTSL_HAS_* of RtslLaunch::needs.
  std::uint32_t sceneNeeds() const { return needs; }
  /// Scene::instanceBounds, primitiveCount and instanceName.
  Bounds bounds(std::uint32_t instance) const;
  std::uint32_t primitiveCount(std::uint32_t instance) const;
  const std::string &name(std::uint32_t instance) const { return instanceNames.at(instance); }

  /// How much there is.
  struct Extent {
    std::size_t meshes, transforms, motions, motionFactors, motionKeys, boxes, selections, sets,
        instances;
    std::uint64_t treeItems;
    std::uint32_t needs;
  };
  Extent extent() const;
  /// Removes what has been added since; nothing else may have changed.
  void cutBack(const Extent &to);

  /// Sets the launch's fields about instances and meshes.
  void fill(RtslLaunch &launch) const;

private:
  struct NamedMesh {
    Mesh mesh;
    std::string name;
    std::optional<Bounds> bounds; // computed on first use
    MeshValues values = {};
    std::uint64_t moves = 0;
    std::uint32_t applied = 0; // of `transforms`: that of its vertices
  };

  /// `items`: of the tree in world space.
  std::uint32_t addInstance(const Objects &objects, const RtslInstance &instance, std::string name,
                            std::uint32_t items);
  RtslInstance place(const Placement &placement, const std::string &name,
                     const std::optional<rtsl::Place> &where);
  std::uint32_t addTransform(const MovingTransform &transform, const std::string &name,
                             const std::optional<rtsl::Place> &where);
  std::uint32_t addMotion(const MovingTransform &transform);
  const Bounds &meshBounds(std::uint32_t mesh);
  /// Sets the bounds of an instance that has a transform, which moves or is as it is stored.
  void setBounds(RtslInstance &instance, const MovingTransform &transform);
  /// Sets the bounds of an instance of primitives. `given`: the bounds in their own space.
  void setPrimitiveBounds(RtslInstance &instance, const Bounds &given,
                          const MovingTransform &transform) const;
  MovingTransform transformOf(const RtslInstance &instance) const;
  /// Sets RtslMesh::attributes for those in `wanted`.
  void setValues(std::uint32_t mesh, const Program &program, std::uint32_t wanted);

  /// An object with several primitives.
  struct PrimitiveSet {
    std::uint32_t firstBox, count;
    std::uint32_t number; // in the order of their addition
    Bounds bounds;        // of all
  };
  /// The boxes of an object's primitives, checked.
  static std::vector<RtslBox> boxesOf(const Objects &objects, RtslRef primitive,
                                      std::uint32_t count,
                                      const std::function<RtslLaunch()> &launch,
                                      std::vector<Warning> &warnings);
  const PrimitiveSet &primitiveSet(const Objects &objects, RtslRef primitive, std::uint32_t count,
                                   const std::function<RtslLaunch()> &launch,
                                   std::vector<Warning> &warnings);
  void dropUnusedAttributes(const Program &program);

  std::vector<std::unique_ptr<NamedMesh>> meshes;
  std::vector<RtslMesh> meshTable; // as long
  std::vector<RtslMeshAttribute> attributeTable;
  std::vector<RtslTransform> transforms{identityTransform()};
  std::vector<RtslMotion> motions{RtslMotion{}}; // the first is unused
  std::vector<RtslMotionFactor> motionFactors;
  std::vector<RtslMotionKey> motionKeys;
  std::vector<RtslBox> boxes;
  std::vector<RtslSelection> selections{RtslSelection{}}; // the first is unused
  std::map<RtslRef, PrimitiveSet> sets;                   // by primitive
  std::vector<RtslInstance> instances;
  std::vector<std::string> instanceNames;          // as long
  std::map<std::uint32_t, MovingTransform> moving; // by index in `transforms`
  float shutterOpen = 0, shutterClose = 1;
  std::uint64_t moves = 0, transformsGained = 0, primitivesChanged = 0;
  std::uint64_t treeItems = 0;
  std::uint32_t needs = 0;
  std::vector<MeshAttribute> attributes; // for reports
};

} // namespace rtsl::runtime
