//===- Geometry.h - the meshes and instances of a scene -------------------===//
//
// Rays hit instances. An instance is a primitive, an object of the program, or a mesh, with a
// material.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "runtime/scene/Objects.h"
#include "runtime/scene/SceneData.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace rtsl::runtime {

class Geometry {
public:
  /// Scene::addPrimitive. `launch` returns the scene's current launch, for `computeBounds`.
  std::uint32_t addPrimitive(const Objects &objects, RtslRef primitive, RtslRef material,
                             std::uint32_t mask, const std::function<RtslLaunch()> &launch,
                             std::vector<Warning> &warnings);
  /// Scene::addMesh.
  std::uint32_t addMesh(Mesh mesh, const std::string &name);
  /// Scene::addMeshInstance.
  std::uint32_t addMeshInstance(const Objects &objects, std::uint32_t mesh, RtslRef material,
                                std::uint32_t mask);

  /// Called after Objects::useProgram: updates RtslInstance::needs, and drops mesh attributes that no
  /// material reads, unless the program keeps them.
  void useProgram(const Objects &objects);
  /// Set by useProgram.
  const std::vector<MeshAttribute> &meshAttributes() const { return attributes; }

  const std::vector<RtslInstance> &all() const { return instances; }
  /// Scene::primitiveBounds, primitiveCount and instanceName.
  Bounds bounds(std::uint32_t instance) const;
  std::uint32_t primitiveCount(std::uint32_t instance) const;
  const std::string &name(std::uint32_t instance) const { return instanceNames.at(instance); }

  /// Sets the launch's fields about instances and meshes.
  void fill(RtslLaunch &launch) const;

private:
  struct NamedMesh {
    Mesh mesh;
    std::string name;
  };

  std::uint32_t addInstance(const Objects &objects, RtslRef primitive, std::uint32_t mesh,
                            RtslRef material, std::string name, std::uint32_t primitives,
                            std::uint32_t mask);
  void dropUnusedAttributes(const Program &program);

  std::vector<std::unique_ptr<NamedMesh>> meshes;
  std::vector<RtslMesh> meshTable; // as long
  std::vector<RtslInstance> instances;
  std::vector<std::string> instanceNames; // as long
  std::uint64_t primitiveTotal = 0;
  std::vector<MeshAttribute> attributes;
};

} // namespace rtsl::runtime
