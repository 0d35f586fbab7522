#include "runtime/scene/MeshValues.h"

#include "runtime/scene/ValueStore.h"
#include "support/ClosestName.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

namespace rtsl::runtime {

namespace {

using Kind = ValueType::Kind;

std::uint32_t wordsOf(const ValueType &type, const Program &program) {
  return type.kind == Kind::Color ? program.colorComponents : type.rows;
}

const NamedAttribute *find(const Mesh &mesh, const std::string &name) {
  for (const NamedAttribute &attribute : mesh.attributes)
    if (attribute.name == name)
      return &attribute;
  return nullptr;
}

/// Is the value a float, or made of floats?
bool isOfFloats(const ValueType &type) {
  return type.kind == Kind::Float || type.kind == Kind::Color;
}

bool isSameKind(const NamedAttribute &attribute, const ValueType &type) {
  switch (attribute.kind) {
  case NamedAttribute::Kind::Float:
    return isOfFloats(type);
  case NamedAttribute::Kind::Int:
    return type.kind == Kind::Int;
  case NamedAttribute::Kind::UInt:
    return type.kind == Kind::UInt;
  case NamedAttribute::Kind::Bool:
    return type.kind == Kind::Bool;
  }
  return false;
}

/// Can a member of the type be given the attribute?
bool fits(const NamedAttribute &attribute, const ValueType &type, const Program &program) {
  const bool isWhole = type.kind == Kind::Int || type.kind == Kind::UInt;
  const bool wasWhole =
      attribute.kind == NamedAttribute::Kind::Int || attribute.kind == NamedAttribute::Kind::UInt;
  if (!isSameKind(attribute, type) && !(wasWhole && (isWhole || isOfFloats(type))))
    return false;
  if (type.kind == Kind::Color)
    return attribute.isRgb || attribute.components == 1 || attribute.components == 3 ||
           attribute.components == program.colorComponents;
  return attribute.components == type.rows ||
         (attribute.isRgb && attribute.components == 4 && type.rows == 3);
}

std::string describe(const NamedAttribute &attribute) {
  static constexpr const char *names[] = {"float", "int", "uint", "bool"};
  const char *kind = names[std::size_t(attribute.kind)];
  const char *of = attribute.ofTriangles ? "face" : "vertex";
  return attribute.components == 1
             ? fmt::format("one {} for each {}", kind, of)
             : fmt::format("{} {}s for each {}", attribute.components, kind, of);
}

float asFloat(const NamedAttribute &attribute, std::size_t index) {
  const std::uint32_t word = attribute.words[index];
  if (attribute.kind == NamedAttribute::Kind::Int)
    return float(std::int32_t(word));
  if (attribute.kind == NamedAttribute::Kind::UInt)
    return float(word);
  float number;
  std::memcpy(&number, &word, sizeof number);
  return number;
}

/// The values as those of a member of the type.
std::vector<std::uint32_t> convert(const NamedAttribute &attribute, const ValueType &type,
                                   std::uint32_t words, std::uint32_t colorComponents) {
  std::vector<std::uint32_t> result;
  const std::size_t count = attribute.words.size() / attribute.components;
  result.reserve(count * words);
  const bool isColor = type.kind == Kind::Color;
  const std::size_t taken =
      attribute.isRgb ? std::min(attribute.components, isColor ? 3u : words) : attribute.components;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * attribute.components;
    if (!isOfFloats(type)) { // from signed to unsigned, or the other way round
      result.insert(result.end(), &attribute.words[first], &attribute.words[first] + words);
      continue;
    }
    std::vector<float> numbers;
    for (std::size_t j = 0; j < taken; ++j)
      numbers.push_back(asFloat(attribute, first + j));
    if (isColor)
      numbers = colorFromNumbers(numbers, colorComponents);
    for (const float number : numbers) {
      std::uint32_t word;
      std::memcpy(&word, &number, sizeof word);
      result.push_back(word);
    }
  }
  return result;
}

[[noreturn]] void throwMissing(const Mesh &mesh, const std::string &name,
                               const AttributeInfo &wanted, const Objects::Object &material) {
  std::vector<std::string> names = mesh.otherAttributes;
  for (const NamedAttribute &attribute : mesh.attributes)
    names.push_back(attribute.name);
  std::sort(names.begin(), names.end());
  Error error(message::meshAttributeMissing(name, wanted.name, material.name, wanted.type.name));
  if (names.empty())
    error.note("it has no attributes; a scene can give them: `attributes`");
  else
    error.note(fmt::format("it has `{}`", fmt::join(names, "`, `")));
  if (const std::string near = closestName(wanted.name, names); !near.empty())
    error.note(fmt::format("did you mean `{}`?", near));
  throw error;
}

} // namespace

std::vector<RtslMeshAttribute> attributesOf(const Program &program) {
  std::vector<RtslMeshAttribute> table;
  for (const AttributeInfo &attribute : program.meshAttributes)
    table.push_back({attribute.offset,
                     wordsOf(attribute.type, program),
                     {attribute.changes[0], attribute.changes[1]}});
  return table;
}

const AttributeInfo *findAttribute(const Program &program, const std::string &name) {
  const auto found = std::find_if(program.meshAttributes.begin(), program.meshAttributes.end(),
                                  [&](const AttributeInfo &one) { return one.name == name; });
  return found == program.meshAttributes.end() ? nullptr : &*found;
}

MeshRequest requestOf(const Program &program) {
  MeshRequest request;
  for (const AttributeInfo &attribute : program.meshAttributes)
    if (!request.wants(attribute.name))
      request.attributes.push_back(attribute.name);
  return request;
}

void requireAttributes(const Mesh &mesh, const std::string &name, const Program &program,
                       std::uint32_t wanted, const Objects::Object &material) {
  for (std::size_t i = 0; i < program.meshAttributes.size(); ++i) {
    if (!(wanted >> i & 1))
      continue;
    const AttributeInfo &read = program.meshAttributes[i];
    const NamedAttribute *attribute = find(mesh, read.name);
    if (!attribute)
      throwMissing(mesh, name, read, material);
    if (!fits(*attribute, read.type, program))
      throw Error(message::meshAttributeMismatch(read.name, name, describe(*attribute),
                                                 material.name, read.type.name));
  }
}

MeshValues::MeshValues(const Mesh &mesh, const Program &program, std::uint32_t wanted)
    : bits(wanted) {
  if (wanted == 0)
    return;
  values.resize(program.meshAttributes.size());
  converted.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const AttributeInfo &read = program.meshAttributes[i];
    const NamedAttribute *attribute = find(mesh, read.name);
    if (!(wanted >> i & 1) || !attribute)
      continue;
    const std::uint32_t words = wordsOf(read.type, program);
    const bool isColor = read.type.kind == Kind::Color && program.colorComponents != 3;
    if (!isSameKind(*attribute, read.type) || words != attribute->components ||
        (isColor && attribute->isRgb))
      converted[i] = convert(*attribute, read.type, words, program.colorComponents);
    values[i].values = converted[i].empty() ? attribute->words.data() : converted[i].data();
    values[i].ofTriangles = attribute->ofTriangles;
    values[i].space = std::uint32_t(attribute->space);
  }
}

bool MeshValues::isRead(const NamedAttribute &attribute, const Program &program) const {
  for (std::size_t i = 0; i < program.meshAttributes.size(); ++i)
    if (bits >> i & 1 && program.meshAttributes[i].name == attribute.name)
      return true;
  return false;
}

} // namespace rtsl::runtime
