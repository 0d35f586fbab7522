//===- Vocabulary.cpp - types and built-in functions to choose from -------===//
#include "Vocabulary.h"

namespace rtsl::random {

/// These need a ray, a place or a statement of their own.
static bool standsAnywhere(typed::Builtin builtin) {
  return typed::isFoldable(builtin) || typed::has(builtin, typed::effect::Outputs);
}

Vocabulary &Vocabulary::get() {
  static Vocabulary vocabulary;
  return vocabulary;
}

Vocabulary::Vocabulary() : builtins(types) {
  scalars = {types.floatType, types.intType, types.uintType, types.boolType};
  for (const Type *scalar : scalars)
    for (std::uint32_t count = 2; count <= 4; ++count)
      vectors.push_back(types.vector(scalar, count));
  for (std::uint32_t columns = 2; columns <= 4; ++columns)
    for (std::uint32_t rows = 2; rows <= 4; ++rows)
      matrices.push_back(types.matrix(columns, rows));

  for (const std::string &name : builtinNames()) {
    const BuiltinOverloads *overloads = builtins.find(name);
    std::map<const Type *, std::vector<BuiltinChoice>> ofName;
    for (std::size_t i = 0; i != overloads->signatures.size(); ++i)
      if (standsAnywhere(overloads->builtins[i]))
        ofName[overloads->signatures[i].result].push_back(
            {name, &overloads->signatures[i], overloads, i});
    for (auto &[result, choices] : ofName)
      byResult[result].push_back(std::move(choices));
  }
}

const Type *Vocabulary::structure(std::string name, std::vector<typed::Field> fields) {
  auto definition = std::make_unique<typed::Struct>();
  definition->name = std::move(name);
  definition->fields = std::move(fields);
  structs.push_back(std::move(definition));
  return types.structure(structs.back().get());
}

std::string simplestValue(const Type *type) {
  switch (type->kind) {
  case TypeKind::Float:
    return "0.0";
  case TypeKind::Int:
    return "0";
  case TypeKind::UInt:
    return "0u";
  case TypeKind::Bool:
    return "false";
  case TypeKind::Vector:
    return toString(type) + "(" + simplestValue(type->element) + ")";
  case TypeKind::Matrix:
  case TypeKind::Color:
    return toString(type) + "(0.0)";
  case TypeKind::Struct: {
    std::string text;
    for (const typed::Field &field : type->structure->fields)
      text += (text.empty() ? "" : ", ") + simplestValue(field.type);
    return toString(type) + "(" + text + ")";
  }
  case TypeKind::Array: {
    std::string text;
    for (std::uint32_t i = 0; i != type->count; ++i)
      text += (i ? ", " : "") + simplestValue(type->element);
    return toString(type) + "(" + text + ")";
  }
  default:
    return "";
  }
}

} // namespace rtsl::random
