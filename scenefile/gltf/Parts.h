//===- Parts.h - writing JSON of a scene file -----------------------------===//
//
// The parts of a glTF file become the JSON that an author would write for them in a scene file.
// Each value has the position of what it comes from in the glTF file.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/json/JsonValue.h"

#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::scene::gltf {

inline JsonValue valueAt(const JsonValue &source, JsonValue::Kind kind) {
  JsonValue value;
  value.kind = kind;
  value.file = source.file;
  value.line = source.line;
  value.column = source.column;
  value.length = source.length;
  return value;
}

inline JsonValue text(const JsonValue &source, std::string string) {
  JsonValue value = valueAt(source, JsonValue::Kind::String);
  value.string = std::move(string);
  return value;
}

inline JsonValue number(const JsonValue &source, double number) {
  JsonValue value = valueAt(source, JsonValue::Kind::Number);
  value.number = number;
  return value;
}

inline JsonValue truth(const JsonValue &source, bool boolean) {
  JsonValue value = valueAt(source, JsonValue::Kind::Boolean);
  value.boolean = boolean;
  return value;
}

inline JsonValue numbers(const JsonValue &source, const std::vector<double> &list) {
  JsonValue value = valueAt(source, JsonValue::Kind::Array);
  for (const double one : list)
    value.elements.push_back(number(source, one));
  return value;
}

inline JsonValue list(const JsonValue &source, std::vector<JsonValue> elements) {
  JsonValue value = valueAt(source, JsonValue::Kind::Array);
  value.elements = std::move(elements);
  return value;
}

/// Adds a member to an object, at the position of its value.
inline void set(JsonValue &object, const char *key, JsonValue member) {
  JsonKey named{key, member.line, member.column, member.length};
  object.members.emplace_back(std::move(named), std::move(member));
}

inline JsonValue object(const JsonValue &source,
                        std::initializer_list<std::pair<const char *, JsonValue>> members) {
  JsonValue value = valueAt(source, JsonValue::Kind::Object);
  for (const auto &[key, member] : members)
    set(value, key, member);
  return value;
}

/// An object of a class.
inline JsonValue objectOf(const JsonValue &source, const std::string &className) {
  return object(source, {{"class", text(source, className)}});
}

/// Modules of the standard library that the parts need.
using Modules = std::set<std::string>;

/// An object of a class of the standard library, such as "materials.Principled".
inline JsonValue libraryObject(const JsonValue &source, const std::string &name, Modules &modules) {
  modules.insert("std." + name);
  JsonValue made = objectOf(source, name.substr(name.find('.') + 1));
  made.find("class")->isOfLibrary = true;
  return made;
}

} // namespace rtsl::scene::gltf
