//===- Model.h - a glTF file as parts of a scene file ---------------------===//
#pragma once

#include "scenefile/gltf/Animation.h"
#include "scenefile/gltf/Textures.h"

#include <string>
#include <utility>
#include <vector>

namespace rtsl::scene::gltf {

/// What an author would write into a scene file to have what a glTF file shows.
struct Model {
  using Members = std::vector<std::pair<JsonKey, JsonValue>>;
  Members materials, nodes; // by name
  std::string root;         // the name of the node above all others
  Modules modules;
  bool isAnimated = false;
  std::vector<Warning> warnings;
};

/// `name` is that of the root; other names begin with it. `source` is the mention of the file in a
/// scene. Throws all mistakes at once.
Model modelOf(const File &file, const Play &play, const std::string &name, const Mention &mention,
              const JsonValue &source);

} // namespace rtsl::scene::gltf
