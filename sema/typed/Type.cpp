//===- Type.cpp - the types of RTSL ---------------------------------------===//
#include "sema/typed/Type.h"

#include "sema/typed/TypedAst.h"

namespace rtsl {

const Type *Type::scalar() const {
  if (isScalar())
    return this;
  if (kind == TypeKind::Vector)
    return element;
  if (kind == TypeKind::Matrix)
    return element->element;
  return nullptr;
}

std::uint32_t Type::componentCount() const {
  if (isScalar())
    return 1;
  if (kind == TypeKind::Vector)
    return count;
  if (kind == TypeKind::Matrix)
    return columns() * rows();
  return 0;
}

TypeContext::TypeContext() {
  error = make(TypeKind::Error);
  voidType = make(TypeKind::Void);
  boolType = make(TypeKind::Bool);
  intType = make(TypeKind::Int);
  uintType = make(TypeKind::UInt);
  floatType = make(TypeKind::Float);
  color = make(TypeKind::Color);
  string = make(TypeKind::String);
}

TypeContext::~TypeContext() = default;

const Type *TypeContext::make(TypeKind kind, const Type *element, std::uint32_t count,
                              BufferMode mode) {
  static const char *const words[] = {"", "out", "inout"};
  std::unique_ptr<Type> &slot =
      types[{kind, element, count, words[static_cast<std::size_t>(mode)]}];
  if (!slot) {
    slot.reset(new Type(kind));
    slot->element = element;
    slot->count = count;
    slot->mode = mode;
  }
  return slot.get();
}

const Type *TypeContext::vector(const Type *scalar, std::uint32_t count) {
  return make(TypeKind::Vector, scalar, count);
}

const Type *TypeContext::matrix(std::uint32_t columns, std::uint32_t rows) {
  return make(TypeKind::Matrix, vector(floatType, rows), columns);
}

const Type *TypeContext::array(const Type *element, std::uint32_t length) {
  return make(TypeKind::Array, element, length);
}

const Type *TypeContext::buffer(const Type *element, std::uint32_t rank, BufferMode mode) {
  return make(TypeKind::Buffer, element, rank, mode);
}

const Type *TypeContext::structure(const typed::Struct *definition) {
  std::unique_ptr<Type> &slot = types[{TypeKind::Struct, definition, 0, std::string()}];
  if (!slot) {
    slot.reset(new Type(TypeKind::Struct));
    slot->structure = definition;
  }
  return slot.get();
}

const Type *TypeContext::reference(const typed::Class *definition) {
  std::unique_ptr<Type> &slot = types[{TypeKind::Class, definition, 0, std::string()}];
  if (!slot) {
    slot.reset(new Type(TypeKind::Class));
    slot->classType = definition;
  }
  return slot.get();
}

const Type *TypeContext::reference(const std::string &builtinClass) {
  std::unique_ptr<Type> &slot = types[{TypeKind::Class, nullptr, 0, builtinClass}];
  if (!slot) {
    slot.reset(new Type(TypeKind::Class));
    slot->builtinClass = builtinClass;
  }
  return slot.get();
}

const Type *TypeContext::named(const std::string &keyword) {
  static const std::map<std::string, TypeKind> simple = {
      {"void", TypeKind::Void}, {"bool", TypeKind::Bool},   {"int", TypeKind::Int},
      {"uint", TypeKind::UInt}, {"float", TypeKind::Float}, {"color", TypeKind::Color}};
  if (auto found = simple.find(keyword); found != simple.end())
    return make(found->second);

  auto digit = [](char c) {
    return c >= '2' && c <= '4' ? static_cast<std::uint32_t>(c - '0') : 0u;
  };
  static const std::map<std::string, TypeKind> vectors = {{"vec", TypeKind::Float},
                                                          {"ivec", TypeKind::Int},
                                                          {"uvec", TypeKind::UInt},
                                                          {"bvec", TypeKind::Bool}};
  if (keyword.size() < 4)
    return nullptr;
  const std::uint32_t last = digit(keyword.back());
  if (!last)
    return nullptr;
  const std::string stem = keyword.substr(0, keyword.size() - 1);
  if (auto found = vectors.find(stem); found != vectors.end())
    return vector(make(found->second), last);
  if (stem == "mat")
    return matrix(last, last);
  // mat2x3: two columns of three rows.
  if (stem.size() == 5 && stem.compare(0, 3, "mat") == 0 && stem[4] == 'x' && digit(stem[3]))
    return matrix(digit(stem[3]), last);
  return nullptr;
}

static std::string scalarName(TypeKind kind) {
  switch (kind) {
  case TypeKind::Bool:
    return "bool";
  case TypeKind::Int:
    return "int";
  case TypeKind::UInt:
    return "uint";
  default:
    return "float";
  }
}

std::string toString(const Type *type) {
  // Dimensions are written outermost first, after the element.
  std::string dimensions;
  while (type->is(TypeKind::Array) || type->is(TypeKind::Buffer)) {
    if (type->is(TypeKind::Array)) {
      dimensions += "[" + std::to_string(type->count) + "]";
    } else {
      for (std::uint32_t i = 0; i != type->count; ++i)
        dimensions += "[]";
    }
    type = type->element;
  }
  switch (type->kind) {
  case TypeKind::Error:
    return "<error>" + dimensions;
  case TypeKind::Void:
    return "void" + dimensions;
  case TypeKind::Vector: {
    const char *prefix = type->element->is(TypeKind::Int)    ? "i"
                         : type->element->is(TypeKind::UInt) ? "u"
                         : type->element->is(TypeKind::Bool) ? "b"
                                                             : "";
    return prefix + ("vec" + std::to_string(type->count)) + dimensions;
  }
  case TypeKind::Matrix: {
    std::string text = "mat" + std::to_string(type->columns());
    if (type->columns() != type->rows())
      text += "x" + std::to_string(type->rows());
    return text + dimensions;
  }
  case TypeKind::Color:
    return "color" + dimensions;
  case TypeKind::Struct:
    return type->structure->name + dimensions;
  case TypeKind::Class:
    return (type->classType ? type->classType->name : type->builtinClass) + dimensions;
  case TypeKind::String:
    return "string" + dimensions;
  default:
    return scalarName(type->kind) + dimensions;
  }
}

} // namespace rtsl
