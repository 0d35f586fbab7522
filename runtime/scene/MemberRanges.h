//===- MemberRanges.h - are the values of members in their ranges? --------===//
#pragma once

#include "runtime/program/Program.h"
#include "runtime/scene/Value.h"

#include <cstdint>
#include <optional>
#include <string>

namespace rtsl::runtime {

/// Throws OutOfRange if a component of a member, in the object's record, is not in the member's
/// range. `name` is the object's; `value`, from which the member was stored, has the error's place,
/// otherwise `fallback`. Null: the value is the class's own.
void checkRange(const ClassInfo &classInfo, const MemberInfo &member, const std::uint8_t *record,
                std::uint32_t colorComponents, const std::string &name, const Value *value,
                const std::optional<Place> &fallback);

} // namespace rtsl::runtime
