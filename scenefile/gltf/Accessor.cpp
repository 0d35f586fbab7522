#include "scenefile/gltf/Accessor.h"

#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace rtsl::scene::gltf {

using Kind = JsonValue::Kind;

namespace {

// Types of numbers.
constexpr std::uint32_t signedByte = 5120, unsignedByte = 5121, signedShort = 5122,
                        unsignedShort = 5123, unsignedInt = 5125, singleFloat = 5126;

/// Elements of an accessor without a buffer, which are zeros but for the sparse ones.
constexpr std::uint32_t mostZeros = 1u << 24;
constexpr std::uint32_t mostWhole = 0xffffffff;

/// The size in bytes; 0: there is no such type.
std::uint32_t sizeOf(std::uint32_t componentType) {
  switch (componentType) {
  case signedByte:
  case unsignedByte:
    return 1;
  case signedShort:
  case unsignedShort:
    return 2;
  case unsignedInt:
  case singleFloat:
    return 4;
  default:
    return 0;
  }
}

/// The components of an element; 0: no such type.
std::uint32_t componentsOf(const std::string &type) {
  constexpr std::pair<const char *, std::uint32_t> types[] = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
  for (const auto &[name, count] : types)
    if (type == name)
      return count;
  return 0;
}

template <typename Number>
Number numberAt(const char *bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

float normalized(double number, double largest) {
  return float(std::max(number / largest, -1.0));
}

float floatAt(const char *bytes, std::uint32_t componentType, bool isNormalized) {
  const auto as = [&](auto number) {
    return isNormalized
               ? normalized(double(number), double(std::numeric_limits<decltype(number)>::max()))
               : float(number);
  };
  switch (componentType) {
  case signedByte:
    return as(numberAt<std::int8_t>(bytes));
  case unsignedByte:
    return as(numberAt<std::uint8_t>(bytes));
  case signedShort:
    return as(numberAt<std::int16_t>(bytes));
  case unsignedShort:
    return as(numberAt<std::uint16_t>(bytes));
  case unsignedInt:
    return as(numberAt<std::uint32_t>(bytes));
  default:
    return numberAt<float>(bytes);
  }
}

std::uint32_t integerAt(const char *bytes, std::uint32_t componentType) {
  switch (componentType) {
  case unsignedByte:
    return numberAt<std::uint8_t>(bytes);
  case unsignedShort:
    return numberAt<std::uint16_t>(bytes);
  default:
    return numberAt<std::uint32_t>(bytes);
  }
}

bool isUnsigned(std::uint32_t componentType) {
  return componentType == unsignedByte || componentType == unsignedShort ||
         componentType == unsignedInt;
}

std::uint32_t readComponentType(const JsonValue &object, const std::string &what) {
  const JsonValue &type = require(object, "componentType", what);
  const std::uint32_t number = readInteger(type, 0, mostWhole, "`componentType` of " + what);
  if (sizeOf(number) == 0)
    throw Error(message::badComponentType(what, number), type.place());
  return number;
}

/// A whole number that may be left out.
std::uint32_t readOffset(const JsonValue &object, const char *key, const std::string &what) {
  const JsonValue *found = object.find(key);
  return found ? readInteger(*found, 0, mostWhole, fmt::format("`{}` of {}", key, what)) : 0;
}

} // namespace

Accessor::Accessor(const File &file, const JsonValue &number, std::string user)
    : file(file), what(std::move(user)) {
  const std::size_t index = file.index("accessors", number, what);
  value = &file.list("accessors")[index];
  what += fmt::format(" (`accessors.{}`)", index);
  elementCount =
      readInteger(scene::require(*value, "count", what), 1, mostWhole, "`count` of " + what);
  componentType = readComponentType(*value, what);
  const JsonValue &type =
      expect(scene::require(*value, "type", what), Kind::String, "`type` of " + what);
  components = componentsOf(type.string);
  if (components == 0)
    throw Error(message::badElementType(what, type.string), type.place());
  if (const JsonValue *flag = value->find("normalized"))
    isNormalized = expect(*flag, Kind::Boolean, "`normalized` of " + what).boolean;
  if (value->find("bufferView"))
    span = spanOf(*value, elementCount, componentType, components);
  else if (elementCount > mostZeros)
    fail(message::accessorWithoutView(what, elementCount));
  if (const JsonValue *found = value->find("sparse"))
    readSparse(*found);
}

void Accessor::fail(const Message &why) const {
  throw Error(why, value->place());
}

void Accessor::require(const char *type) const {
  const std::string &own = value->find("type")->string;
  if (own != type)
    fail(message::accessorType(what, own, type));
}

Accessor::Span Accessor::spanOf(const JsonValue &object, std::uint64_t count,
                                std::uint32_t componentType, std::uint32_t components) const {
  const std::string ofView = "`bufferView` of " + what;
  const JsonValue &number = scene::require(object, "bufferView", what);
  const std::size_t index = file.index("bufferViews", number, ofView);
  const JsonValue &view = file.list("bufferViews")[index];
  const std::string viewName = fmt::format("`bufferViews.{}`", index);
  Span span;
  span.count = count;
  span.componentType = componentType;
  span.components = components;
  const JsonValue &bufferNumber = scene::require(view, "buffer", viewName);
  span.buffer = file.index("buffers", bufferNumber, "`buffer` of " + viewName);
  const JsonValue &buffer = file.list("buffers")[span.buffer];
  const std::string bufferName = fmt::format("`buffers.{}`", span.buffer);
  const std::uint64_t bufferLength = readInteger(scene::require(buffer, "byteLength", bufferName),
                                                 1, mostWhole, "`byteLength` of " + bufferName);
  const std::uint64_t viewLength = readInteger(scene::require(view, "byteLength", viewName), 1,
                                               mostWhole, "`byteLength` of " + viewName);
  const std::uint64_t viewOffset = readOffset(view, "byteOffset", viewName);
  if (viewOffset + viewLength > bufferLength)
    throw Error(message::viewTooLong(viewName, viewOffset + viewLength, bufferName, bufferLength),
                view.place());
  const std::uint64_t elementSize = std::uint64_t(sizeOf(componentType)) * components;
  const std::uint64_t offset = readOffset(object, "byteOffset", what);
  const std::uint32_t stride = readOffset(view, "byteStride", viewName);
  if (stride != 0 && stride < elementSize)
    fail(message::elementsOverlap(what, elementSize, stride, viewName));
  span.offset = viewOffset + offset;
  span.stride = stride ? stride : elementSize;
  if (offset + span.stride * (count - 1) + elementSize > viewLength)
    fail(message::viewTooShort(what, offset + span.stride * (count - 1) + elementSize, viewName,
                               viewLength));
  return span;
}

void Accessor::readSparse(const JsonValue &json) {
  const std::string own = "`sparse` of " + what;
  expect(json, Kind::Object, own);
  const JsonValue &count = scene::require(json, "count", own);
  const std::uint32_t number =
      readInteger(count, 1, std::uint32_t(elementCount), "`count` of " + own);
  const JsonValue &indices =
      expect(scene::require(json, "indices", own), Kind::Object, "`indices` of " + own);
  const JsonValue &values =
      expect(scene::require(json, "values", own), Kind::Object, "`values` of " + own);
  const std::uint32_t type = readComponentType(indices, "`indices` of " + own);
  if (!isUnsigned(type))
    fail(message::sparseNotUnsigned(what));
  sparse =
      Sparse{spanOf(indices, number, type, 1), spanOf(values, number, componentType, components)};
}

/// The bytes from the first element on. Its buffer may have fewer than it says.
std::string_view Accessor::bytesOf(const Span &span) const {
  const std::string_view bytes = file.buffer(span.buffer);
  const std::uint64_t end = span.offset + span.stride * (span.count - 1) +
                            std::uint64_t(sizeOf(span.componentType)) * span.components;
  if (end > bytes.size())
    throw Error(message::bufferCutShort(span.buffer, bytes.size(), what, end),
                file.list("buffers")[span.buffer].place());
  return bytes.substr(span.offset);
}

template <typename Number, typename Read>
std::vector<Number> Accessor::numbers(Read read) const {
  std::vector<Number> result(elementCount * components);
  const auto copy = [&](const char *bytes, const Span &from, std::uint64_t element,
                        std::uint64_t target) {
    for (std::uint32_t i = 0; i < components; ++i)
      result[target * components + i] =
          read(bytes + element * from.stride + i * sizeOf(from.componentType));
  };
  if (span) {
    const char *bytes = bytesOf(*span).data();
    for (std::uint64_t i = 0; i < elementCount; ++i)
      copy(bytes, *span, i, i);
  }
  if (sparse) {
    const char *indices = bytesOf(sparse->indices).data();
    const char *values = bytesOf(sparse->values).data();
    for (std::uint64_t i = 0; i < sparse->indices.count; ++i) {
      const std::uint32_t target =
          integerAt(indices + i * sparse->indices.stride, sparse->indices.componentType);
      if (target >= elementCount)
        fail(message::sparseOutOfRange(what, elementCount, i, target));
      copy(values, sparse->values, i, target);
    }
  }
  return result;
}

std::vector<float> Accessor::floats() const {
  return numbers<float>(
      [&](const char *bytes) { return floatAt(bytes, componentType, isNormalized); });
}

std::vector<std::uint32_t> Accessor::integers() const {
  if (!isUnsigned(componentType))
    fail(message::accessorNotUnsigned(what));
  return numbers<std::uint32_t>([&](const char *bytes) { return integerAt(bytes, componentType); });
}

std::array<std::vector<double>, 2> Accessor::box() const {
  std::array<std::vector<double>, 2> corners;
  int at = 0;
  for (const char *key : {"min", "max"}) {
    const JsonValue &corner = scene::require(*value, key, what);
    corners[at++] = readNumbers(corner, 3, fmt::format("`{}` of {}", key, what));
  }
  return corners;
}

} // namespace rtsl::scene::gltf
