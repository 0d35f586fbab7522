//===- RenderReader.h - `render` of a scene file --------------------------===//
#pragma once

#include "scenefile/SceneFile.h"
#include "support/ErrorCollector.h"

namespace rtsl::scene {

/// Reads `render`. `rayGeneration`: the value of this key of the scene, or null. Gives the value of
/// `engine`, if it is an engine of the library, otherwise null. Adds mistakes to `errors`; throws
/// WrongType.
const JsonValue *readRender(const JsonValue &value, const JsonValue *rayGeneration,
                            SceneDescription &scene, ErrorCollector &errors);

} // namespace rtsl::scene
