//===- PathEngine.h - scenes for the path tracer --------------------------===//
#pragma once

#include "scenefile/SceneFile.h"

namespace rtsl::scene {

/// Makes `"engine": "path"` of the same scene for the engine `programs`: imports the path tracer of
/// the standard library, which generates the rays unless the scene names an object of that class
/// itself, to set its members; sets their limit to the scene's `depth`; and makes a background color
/// an object that paths can meet.
void usePathTracer(SceneDescription &scene);

} // namespace rtsl::scene
