#include "runtime/buffers/NumpyTypes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace rtsl::runtime {

std::vector<std::uint32_t> elementShape(const ValueType &type, std::uint32_t bytes) {
  std::vector<std::uint32_t> shape = type.arraySizes;
  if (type.kind == ValueType::Kind::Color) {
    std::uint32_t numbers = bytes / 4;
    for (const std::uint32_t size : type.arraySizes)
      numbers /= size;
    shape.push_back(numbers);
    return shape;
  }
  if (type.columns > 1)
    shape.push_back(type.columns);
  if (type.rows > 1)
    shape.push_back(type.rows);
  return shape;
}

std::string tupleOf(const std::vector<std::uint32_t> &sizes) {
  return fmt::format("({}{})", fmt::join(sizes, ", "), sizes.size() == 1 ? "," : "");
}

std::string numpyType(const ValueType &type, bool isInStruct) {
  switch (type.kind) {
  case ValueType::Kind::Bool:
    return isInStruct ? "'<u4'" : "'|b1'";
  case ValueType::Kind::Int:
    return "'<i4'";
  case ValueType::Kind::UInt:
    return "'<u4'";
  case ValueType::Kind::Struct: {
    std::vector<std::string> fields;
    for (const MemberInfo &field : type.fields) {
      const std::vector<std::uint32_t> shape = elementShape(field.type, field.type.size);
      fields.push_back(fmt::format("('{}', {}{})", field.name, numpyType(field.type, true),
                                   shape.empty() ? "" : ", " + tupleOf(shape)));
    }
    return fmt::format("[{}]", fmt::join(fields, ", "));
  }
  default:
    return "'<f4'";
  }
}

} // namespace rtsl::runtime
