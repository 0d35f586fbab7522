//===- Members.h - the members of an object of a scene --------------------===//
#pragma once

#include "runtime/scene/Elements.h"
#include "runtime/scene/Scene.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

namespace rtsl::scene {

using Vector = std::array<float, 3>;

/// The members of an object, in its record.
class Members {
public:
  Members(const runtime::Scene &scene, RtslRef object)
      : info(scene.classOf(object)), record(scene.record(object)) {}

  /// Whether its class is this one or derives from it.
  bool is(const char *className) const {
    return info.name == className || info.base == className ||
           std::find(info.ancestors.begin(), info.ancestors.end(), className) !=
               info.ancestors.end();
  }

  /// Whether it has a member of this type.
  bool has(const char *name, const char *type) const {
    const runtime::MemberInfo *const member = find(name);
    return member && member->type.name == type;
  }

  /// The elements of a member that it has.
  runtime::Elements elements(const char *name) const {
    const runtime::MemberInfo &member = *find(name);
    return runtime::elementsOf(member.type, record + member.offset);
  }

  /// One of them. `Value` is as large as the member's type.
  template <typename Value>
  Value value(const char *name, std::size_t element = 0) const {
    Value value;
    std::memcpy(&value, elements(name)[element], sizeof value);
    return value;
  }

private:
  const runtime::MemberInfo *find(const char *name) const {
    const auto found =
        std::find_if(info.members.begin(), info.members.end(),
                     [&](const runtime::MemberInfo &one) { return one.name == name; });
    return found == info.members.end() ? nullptr : &*found;
  }

  const runtime::ClassInfo &info;
  const std::uint8_t *const record;
};

/// Is the parallelogram with these sides a line or a point, but for the rounding of its sides?
bool isFlat(const Vector &a, const Vector &b);

/// Why it is one: "its sides are parallel".
std::optional<std::string> whyFlat(const Vector &a, const Vector &b);

} // namespace rtsl::scene
