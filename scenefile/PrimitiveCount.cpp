#include "scenefile/PrimitiveCount.h"

#include "support/ClosestName.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace rtsl::scene {

using runtime::ClassInfo;
using runtime::MemberInfo;
using Kind = JsonValue::Kind;

static const MemberInfo *find(const ClassInfo &classInfo, const std::string &name) {
  const auto found = std::find_if(classInfo.members.begin(), classInfo.members.end(),
                                  [&](const MemberInfo &member) { return member.name == name; });
  return found == classInfo.members.end() ? nullptr : &*found;
}

std::uint32_t primitivesOf(const GeometryDescription &geometry, const runtime::Scene &scene,
                           RtslRef primitive) {
  if (!geometry.count)
    return 1;
  if (geometry.count->kind == Kind::Number)
    return std::uint32_t(geometry.count->number);
  const ClassInfo &classInfo = scene.classOf(primitive);
  const MemberInfo *member = find(classInfo, geometry.count->string);
  if (member && member->type.bufferRank == 1) {
    RtslBuffer buffer;
    std::memcpy(&buffer, scene.record(primitive) + member->offset, sizeof buffer);
    if (buffer.size[0] != 0)
      return buffer.size[0];
    throw Error(message::countBufferEmpty(member->name), geometry.count->place());
  }
  Error error(message::noSuchCountBuffer(classInfo.name, geometry.count->string),
              geometry.count->place());
  std::vector<std::string> names;
  for (const MemberInfo &one : classInfo.members)
    if (one.type.bufferRank == 1)
      names.push_back(one.name);
  if (const std::string near = closestName(geometry.count->string, names); !near.empty())
    error.fix(near);
  throw error;
}

} // namespace rtsl::scene
