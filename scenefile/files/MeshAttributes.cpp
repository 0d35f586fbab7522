#include "scenefile/files/MeshAttributes.h"

#include "runtime/scene/ValueStore.h"
#include "scenefile/files/BufferFiles.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::scene {

using runtime::NamedAttribute;
using runtime::ValueType;
using Kind = JsonValue::Kind;

namespace {

constexpr NamedAttribute::Space spaces[] = {
    NamedAttribute::Space::Numbers, NamedAttribute::Space::Point, NamedAttribute::Space::Vector,
    NamedAttribute::Space::Normal, NamedAttribute::Space::Tangent};

NamedAttribute::Space readSpace(const JsonValue &value) {
  expect(value, Kind::String, "`space`");
  for (const NamedAttribute::Space space : spaces)
    if (value.string == nameOf(space))
      return space;
  throw Error(message::unknownSpace(value.string), value.place());
}

AttributeDescription readAttribute(const std::string &name, const Place &place,
                                   const JsonValue &value) {
  AttributeDescription attribute;
  attribute.name = name;
  attribute.place = place;
  attribute.json = &value;
  if (value.kind == Kind::Array || value.kind == Kind::String || isBuffer(value)) {
    attribute.values = &value;
    return attribute;
  }
  const std::string what = fmt::format("the attribute `{}`", name);
  expect(value, Kind::Object, what);
  checkKeys(value, {"values", "per", "space"}, what);
  attribute.values = value.find("values");
  if (const JsonValue *space = value.find("space"))
    attribute.space = readSpace(*space);
  else if (!attribute.values)
    throw Error(message::attributeWithoutValues(what), value.place());
  if (const JsonValue *per = value.find("per")) {
    expect(*per, Kind::String, "`per`");
    if (per->string != "vertex" && per->string != "face")
      throw Error(message::unknownPer(per->string), per->place());
    if (!attribute.values)
      throw Error(message::perWithoutValues(), per->place());
    attribute.ofFaces = per->string == "face";
  }
  return attribute;
}

NamedAttribute::Kind kindOf(const ValueType &type) {
  switch (type.kind) {
  case ValueType::Kind::Int:
    return NamedAttribute::Kind::Int;
  case ValueType::Kind::UInt:
    return NamedAttribute::Kind::UInt;
  case ValueType::Kind::Bool:
    return NamedAttribute::Kind::Bool;
  default:
    return NamedAttribute::Kind::Float;
  }
}

} // namespace

std::vector<AttributeDescription> readAttributes(const JsonValue &value) {
  expect(value, Kind::Object, "`attributes`");
  std::vector<AttributeDescription> attributes;
  for (const auto &[key, one] : value.members)
    attributes.push_back(readAttribute(key.text, value.place(key), one));
  return attributes;
}

ValueType bufferOfAttribute(const ValueType &type) {
  ValueType buffer = type;
  buffer.bufferRank = 1;
  buffer.elementSize = type.size;
  buffer.size = sizeof(RtslBuffer);
  buffer.name += "[]";
  return buffer;
}

NamedAttribute attributeFrom(const AttributeDescription &description, const ValueType &type,
                             const runtime::Value &values, std::uint32_t colorComponents) {
  NamedAttribute attribute;
  attribute.name = description.name;
  attribute.kind = kindOf(type);
  attribute.components = type.size / 4;
  attribute.ofTriangles = description.ofFaces;
  attribute.space = description.space;
  const std::string what = fmt::format("the attribute `{}`", description.name);
  if (attribute.kind != NamedAttribute::Kind::Float && !attribute.ofTriangles)
    throw Error(message::integersOfVertices(what, type.name), description.place);
  const std::uint32_t needed = componentsOf(description.space);
  if (needed != 0 && (attribute.components != needed || type.kind != ValueType::Kind::Float))
    throw Error(message::spaceNeedsVector(what, type.name, nameOf(description.space), needed),
                description.place);
  const runtime::Value block =
      blockOf(bufferOfAttribute(type), values, colorComponents, what, description.place);
  attribute.words.assign(block.words->data(), block.words->data() + block.words->size());
  return attribute;
}

} // namespace rtsl::scene
