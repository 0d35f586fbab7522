//===- DarkLights.h - lights of the library that send out nothing ---------===//
#pragma once

#include "runtime/scene/Scene.h"

#include <optional>
#include <string>

namespace rtsl::scene {

/// Why a light of the library sends out nothing, wherever it is: "its `direction` is 0". Nothing
/// for other lights, and for classes of authors, which say nothing about theirs.
std::optional<std::string> whyDark(const runtime::Scene &scene, RtslRef light);

} // namespace rtsl::scene
