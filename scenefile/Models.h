//===- Models.h - glTF and OBJ files that a scene mentions ----------------===//
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
#include <vector>

namespace rtsl::scene {

/// The glTF and OBJ files of a scene, each opened once.
class ModelFiles {
public:
  /// The file at a path, opened on first use. The mistakes in it are thrown each time; those of
  /// opening it are at `place`, if it is given.
  const gltf::File &open(const std::string &path, const std::optional<Place> &place = {});

  /// All files that were opened, with those that they refer to.
  std::vector<std::string> files() const;

private:
  mutable std::mutex mutex;
  std::map<std::string, std::unique_ptr<gltf::File>> opened;
};

/// Those of a scene.
ModelFiles &modelsOf(SceneDescription &scene);

/// Replaces the mentions of models in a scene: in `nodes`, `objects`, `root`, `roots` and `camera`.
/// Sets `scene.models`, and adds to `scene.imports`, `scene.warnings` and `errors`.
void expandModels(JsonValue &root, SceneDescription &scene, ErrorCollector &errors);

} // namespace rtsl::scene
