//===- References.h - the objects that an object refers to ----------------===//
#pragma once

#include "scenefile/SceneFile.h"

namespace rtsl::scene {

/// Calls `visit(object, isNamed)` for each object that a value refers to: one that has a name, or
/// one in place, which is gone after the call.
template <typename Visit>
void forEachReferred(const SceneDescription &description, const JsonValue &value, Visit visit) {
  using Kind = JsonValue::Kind;
  if (value.kind == Kind::String) {
    if (const ObjectDescription *object = findObject(description, value.string))
      visit(*object, true);
  } else if (const JsonValue *className = value.find("class");
             className && className->kind == Kind::String) {
    visit(objectInPlace(value, "an object"), false);
  } else if (value.kind == Kind::Array) {
    for (const JsonValue &element : value.elements)
      forEachReferred(description, element, visit);
  }
}

/// The same for the values of an object's members and of its constructor.
template <typename Visit>
void forEachReferred(const SceneDescription &description, const ObjectDescription &object,
                     Visit visit) {
  if (object.constructor)
    forEachValue(*object.constructor,
                 [&](const JsonValue &value) { forEachReferred(description, value, visit); });
  for (const auto &member : object.members)
    forEachReferred(description, *member.second, visit);
}

} // namespace rtsl::scene
