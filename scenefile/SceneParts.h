//===- SceneParts.h - the references between objects of a scene -----------===//
#pragma once

#include "scenefile/SceneFile.h"

#include <cstddef>
#include <string>
#include <vector>

namespace rtsl::scene {

/// A named object or an element of a list, with the objects that are written in place inside it.
struct Part {
  enum class Role : std::uint8_t {
    Root,
    Light,
    Named
  }; // named textures and materials are used only through references
  Role role = Role::Root;
  std::string name; // for people: "material clay", "lights.0"
  std::vector<std::string> classes;
  std::vector<std::size_t> refersTo; // indices of parts; unknown names are left out
  Place place;
};

/// All parts of a scene. Only one of camera and ray generation is included.
std::vector<Part> partsOf(const SceneDescription &description);

} // namespace rtsl::scene
