//===- ObjDamage.h - what is wrong with a Wavefront OBJ file --------------===//
#pragma once

#include "support/ErrorMessages.h"

#include <optional>
#include <string>
#include <string_view>

namespace rtsl::runtime {

/// The first line of vertices or of a face that has something else than numbers, too few of them,
/// or a corner that is no vertex. assimp reads other numbers from such lines, or does not say which
/// line it is. Nothing for a file with continued lines, which is left to assimp.
std::optional<Message> findObjDamage(std::string_view text, const std::string &path);

} // namespace rtsl::runtime
