//===- SceneParts.h - what refers to what in a scene ----------------------===//
#pragma once

#include "scenefile/SceneFile.h"

#include <cstddef>
#include <string>
#include <vector>

namespace rtsl::scene {

/// An object that has a name or a place in a list, with the objects that are written in place
/// inside of it.
struct Part {
  enum class Role : std::uint8_t {
    Root,
    Light,
    Named
  }; // named textures and materials are there for others alone
  Role role = Role::Root;
  std::string name; // for people: "material clay", "lights.0"
  std::vector<std::string> classes;
  std::vector<std::size_t> refersTo; // indices of parts; names that nothing has are left out
  Place place;
};

/// All parts of a scene. Of what begins a sample only one takes part.
std::vector<Part> partsOf(const SceneDescription &description);

} // namespace rtsl::scene
