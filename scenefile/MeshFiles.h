//===- MeshFiles.h - the meshes that a scene takes from files -------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "scenefile/SceneFile.h"

#include <cstddef>
#include <exception>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::scene {

/// Reads each file of a scene once and moves its mesh to where objects have it, on all cores.
/// Objects that have a file in the same place share a mesh.
class MeshFiles {
public:
  explicit MeshFiles(const SceneDescription &description);

  /// The number of an object's mesh.
  std::size_t numberOf(const GeometryDescription &geometry) const;

  /// A mesh that nobody has taken yet. Throws what runtime::loadMesh throws.
  runtime::Mesh take(std::size_t number);

private:
  /// A mesh, or why there is none.
  struct Result {
    runtime::Mesh mesh;
    std::exception_ptr failure;
  };

  std::map<std::pair<std::string, decltype(runtime::Transform::columns)>, std::size_t> numbers;
  std::vector<Result> results; // by number
};

} // namespace rtsl::scene
