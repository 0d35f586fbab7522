//===- SceneFile.h - what all that is read as a scene file has in common ---===//
#pragma once

#include "scenefile/SceneFile.h"

namespace rtsl::c {

/// The errors of a file as one, each with its place, one a line.
Error inLines(const Error &error);

/// Throws UnknownClass if the scene has objects of classes of the library that the shaders do not
/// have, such as those that the materials of its models become.
void requireLibraryClasses(const scene::SceneDescription &description,
                           const runtime::Program &program);

} // namespace rtsl::c
