//===- LibraryEngines.h - scenes for engines of the standard library ------===//
#pragma once

#include "scenefile/SceneFile.h"

#include <string>
#include <vector>

namespace rtsl::scene {

/// The names that `"engine"` may have for engines that are RTSL classes: "path", "normals", ...
const std::vector<std::string> &libraryEngines();

/// The engines among them that show one property of what is seen: "normals", ...
const std::vector<std::string> &libraryViews();

/// Makes a scene for one of these engines the same for the engine `programs`: imports its class,
/// whose object generates the rays unless the scene names an object of that class itself, to set
/// its members; sets a limit of rays to the scene's `depth`; and makes a background color an object
/// that rays with a payload can meet. `engine` is the value in the scene.
void useLibraryEngine(SceneDescription &scene, const JsonValue &engine);

/// Prepares a scene for the engine `programs`: a background color becomes such an object if the ray
/// generation is of a class of one of these engines.
void useRayGeneration(SceneDescription &scene);

} // namespace rtsl::scene
