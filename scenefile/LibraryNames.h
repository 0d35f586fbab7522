//===- LibraryNames.h - classes of the library that a scene does not name -===//
//
// Engines, background colors and models stand for objects of classes of the library. The author of
// a scene need not know these, and may have classes of the same names: then those of the library
// have others.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/SceneFile.h"

#include <map>
#include <string>

namespace rtsl::scene {

/// Replaces the names of the library's classes, where the scene itself does not name them.
void renameLibraryClasses(SceneDescription &scene, const std::map<std::string, std::string> &names);

} // namespace rtsl::scene
