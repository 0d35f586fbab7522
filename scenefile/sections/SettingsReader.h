//===- SettingsReader.h - what `render` and a pass may both say -----------===//
#pragma once

#include "scenefile/SceneFile.h"
#include "support/ErrorCollector.h"

namespace rtsl::scene {

/// Reads size, samples, depth and seed, where `value` has them. The size may be the name of a
/// buffer of the scene, or of a member of the ray generation, null without one. Mistakes
/// (OutOfRange, WrongType, UnknownName) are added to `errors`, at most one for each setting.
void readSettings(const JsonValue &value, RenderSettings &render, const SceneDescription &scene,
                  const JsonValue *rayGeneration, ErrorCollector &errors);

/// The size of a launch with an index for each element of a buffer. Throws OutOfRange.
std::uint32_t launchSize(const std::string &buffer, std::size_t length);

} // namespace rtsl::scene
