//===- Models.h - glTF, OBJ and PLY files that a scene mentions -----------===//
//
// {"model": "chair.glb"} in the place of a node is short for the nodes, materials, images and
// lights that an author would write for the file: they are added to the scene's JSON before it is
// read, and the mention becomes a child.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/SceneFile.h"
#include "scenefile/gltf/File.h"
#include "support/ErrorCollector.h"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::scene {

class KeptFiles;

/// Opens a glTF file, an OBJ file with its materials, or a PLY file. Throws the mistakes in it.
std::unique_ptr<gltf::File> openModel(const std::string &path);

/// The glTF, OBJ and PLY files of a scene, each opened once.
class ModelFiles {
public:
  /// `kept`: those of scenes before this one; null: none.
  explicit ModelFiles(std::shared_ptr<KeptFiles> kept = nullptr) : kept(std::move(kept)) {}

  /// The file at a path, opened on first use. The mistakes in it are thrown each time; those of
  /// opening it are at `place`, if it is given.
  const gltf::File &open(const std::string &path, const std::optional<Place> &place = {});

  /// All files that were opened, with those that they refer to.
  std::vector<std::string> files() const;

private:
  std::shared_ptr<KeptFiles> kept;
  mutable std::mutex mutex;
  std::map<std::string, std::shared_ptr<const gltf::File>> opened;
};

/// The model files of a scene.
ModelFiles &modelsOf(SceneDescription &scene);

/// Replaces the mentions of models in a scene: in `nodes`, `objects`, `root`, `roots` and `camera`.
/// Sets `scene.models`, and adds to `scene.imports`, `scene.warnings` and `errors`.
void expandModels(JsonValue &root, SceneDescription &scene, ErrorCollector &errors);

} // namespace rtsl::scene
