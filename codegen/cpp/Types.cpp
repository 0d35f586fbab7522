#include "codegen/cpp/Types.h"

#include <fmt/format.h>

namespace rtsl::cpp {

std::string Types::spelled(const Type *type, bool inMemory) {
  switch (type->kind) {
  case TypeKind::Void:
    return "void";
  case TypeKind::Bool:
    return inMemory ? "rtsl::Bool" : "bool";
  case TypeKind::Int:
    return "int";
  case TypeKind::UInt:
    return "unsigned";
  case TypeKind::Float:
    return "float";
  case TypeKind::Vector:
    switch (type->element->kind) {
    case TypeKind::Float:
      return fmt::format("glm::vec{}", type->count);
    case TypeKind::Int:
      return fmt::format("glm::ivec{}", type->count);
    case TypeKind::UInt:
      return fmt::format("glm::uvec{}", type->count);
    default:
      return inMemory ? fmt::format("glm::vec<{}, rtsl::Bool>", type->count)
                      : fmt::format("glm::bvec{}", type->count);
    }
  case TypeKind::Matrix:
    return type->columns() == type->rows()
               ? fmt::format("glm::mat{}", type->columns())
               : fmt::format("glm::mat{}x{}", type->columns(), type->rows());
  case TypeKind::Color:
    return "Color";
  case TypeKind::Struct:
    return names.of(type->structure);
  case TypeKind::Class: {
    const std::string className = type->classType ? type->classType->name : type->builtinClass;
    required.references[className];
    return names.reference(className);
  }
  case TypeKind::Array:
    return fmt::format("rtsl::array<{}, {}>", this->inMemory(type->element), type->count);
  case TypeKind::Buffer: {
    const char *kind = type->mode == BufferMode::Read ? "rtsl::Buffer" : "rtsl::OutputBuffer";
    return type->count == 1
               ? fmt::format("{}<{}>", kind, this->inMemory(type->element))
               : fmt::format("{}<{}, {}>", kind, this->inMemory(type->element), type->count);
  }
  case TypeKind::Error:
  case TypeKind::String:
    break;
  }
  return "void";
}

Code Types::zero(const Type *type) const {
  switch (type->kind) {
  case TypeKind::Bool:
    return boolean(false);
  case TypeKind::Int:
    return literal("0", true);
  case TypeKind::UInt:
    return literal("0u", true);
  case TypeKind::Float:
    return literal("0.0f", true);
  default:
    return list("", {});
  }
}

Code Types::color(std::vector<Code> components) const {
  if (components.size() == 3 && colorComponents != 3)
    return call(withParameters("rtsl::rgb", {std::to_string(colorComponents)}),
                std::move(components));
  return construct("Color", std::move(components));
}

} // namespace rtsl::cpp
