//===- MeshPaths.h - which files a mesh of a scene is made of -------------===//
#pragma once

#include "scenefile/SceneFile.h"

#include <string>
#include <vector>

namespace rtsl::scene {

/// The file of `mesh`, or of {"keys": [paths], "times": [...]} one for each key, whose `times` it
/// sets. Throws WrongType, UnknownKey, and the errors of readKeyTimes.
std::vector<MeshPath> readMeshPaths(const JsonValue &mesh, const std::string &sceneFile,
                                    std::vector<float> &times);

} // namespace rtsl::scene
