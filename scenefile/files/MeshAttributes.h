//===- MeshAttributes.h - `attributes` of the meshes of a scene -----------===//
//
//   "attributes": {"wear": {"buffer": "wear.npy"}, "grain": {"values": "grains", "per": "face"},
//                  "flow": {"space": "vector"}}
//
// Values are what a buffer member takes: a list, a file, or the name of a buffer. Without values
// the entry says how a transform changes an attribute that the mesh's file has.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/geometry/Mesh.h"
#include "runtime/scene/SceneData.h"
#include "scenefile/json/JsonValue.h"

#include <string>
#include <vector>

namespace rtsl::scene {

struct AttributeDescription {
  std::string name;
  Place place;                       // of the name
  const JsonValue *json = nullptr;   // all of it
  const JsonValue *values = nullptr; // null: those of the file
  bool ofFaces = false;
  runtime::NamedAttribute::Space space = runtime::NamedAttribute::Space::Numbers;
};

/// Throws UnknownKey, WrongType, OutOfRange, MissingKey.
std::vector<AttributeDescription> readAttributes(const JsonValue &value);

/// The type of a buffer with elements of the type of a scratch member.
runtime::ValueType bufferOfAttribute(const runtime::ValueType &type);

/// The attribute with these values, in the order of the file. `type` is that of the member that
/// reads it. Throws WrongType, OutOfRange.
runtime::NamedAttribute attributeFrom(const AttributeDescription &description,
                                      const runtime::ValueType &type, const runtime::Value &values,
                                      std::uint32_t colorComponents);

} // namespace rtsl::scene
