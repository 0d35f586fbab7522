//===- MeshFiles.h - the meshes that a scene takes from files -------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "scenefile/SceneFile.h"

#include <cstddef>
#include <exception>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace rtsl::scene {

/// Reads each mesh file of a scene, and each part of a glTF file, once and applies the transforms
/// of its objects, on all cores. Objects with the same files and transform share a mesh.
class MeshFiles {
public:
  /// `request`: what to read of the files.
  MeshFiles(const SceneDescription &description, const runtime::MeshRequest &request);

  /// The number of an object's mesh.
  std::size_t numberOf(const GeometryDescription &geometry) const;

  /// A mesh, which can be taken once. Throws the errors of runtime::loadMesh and gltf::readMesh.
  runtime::Mesh take(std::size_t number);

  /// The transform that was applied to its vertices.
  const runtime::Transform &applied(std::size_t number) const;
  /// Is it that of its only instance, which therefore has none (PlacedMesh.h)?
  bool isPlaced(std::size_t number) const;

private:
  /// A mesh, or the error of loading it.
  struct Result {
    runtime::Mesh mesh;
    std::exception_ptr failure;
    runtime::Transform applied = {};
    bool isPlaced = false;
  };

  using Key = std::tuple<std::vector<std::string>, std::string, std::vector<std::vector<double>>,
                         std::vector<float>, decltype(runtime::Transform::columns), bool,
                         std::vector<const JsonValue *>>;
  static Key keyOf(const GeometryDescription &geometry);

  std::map<Key, std::size_t> numbers;
  std::vector<Result> results; // by number
};

} // namespace rtsl::scene
