//===- LightAreas.h - lights of the library that have no area --------------===//
#pragma once

#include "runtime/scene/Scene.h"

#include <optional>
#include <string>

namespace rtsl::scene {

/// Why a light of the library whose light comes from an area has none, and so sends out nothing:
/// "its radius is 0". Nothing for a light that has one, and for classes of authors, which say
/// nothing about theirs.
std::optional<std::string> whyWithoutArea(const runtime::Scene &scene, RtslRef light);

} // namespace rtsl::scene
