//===- SceneFile.h - what all that is read as a scene file has in common ---===//
#pragma once

#include "scenefile/SceneFile.h"

namespace rtsl::c {

/// The errors of a file as one, each with its place, one a line.
Error inLines(const Error &error);

/// Throws LibraryClassesMissing for classes of the library that the scene has objects of, such as
/// those that the materials of its models become, and that the shaders do not have.
void requireLibraryClasses(const scene::SceneDescription &description,
                           const runtime::Program &program);

} // namespace rtsl::c
