//===- MemberRanges.h - are the values of members in their ranges? --------===//
#pragma once

#include "runtime/program/Program.h"
#include "runtime/scene/Value.h"

#include <cstdint>
#include <optional>
#include <string>

namespace rtsl::runtime {

/// Throws OutOfRange if a component of a member or parameter, stored from `start` on, is not in its
/// range. `owner` is what has it, such as "class `Ball`", and `what` names it in messages ("member
/// `radius` of `ball`"). The error's place is that of `value`, from which it was stored, or else
/// `fallback`. No value: the class itself set it.
void checkRange(const MemberInfo &declared, const std::uint8_t *start,
                std::uint32_t colorComponents, const std::string &owner, const std::string &what,
                const Value *value, const std::optional<Place> &fallback);

} // namespace rtsl::runtime
