//===- LowerTypes.cpp - types of the language to types of the IR ----------===//
#include "codegen/lower/Lowering.h"

namespace rtsl::lowering {

static std::string className(const Type *type) {
  return type->classType ? type->classType->name : type->builtinClass;
}

mlir::Type ModuleLowering::type(const Type *source) {
  auto known = types.find(source);
  if (known != types.end())
    return known->second;
  mlir::Type result;
  switch (source->kind) {
  case TypeKind::Bool:
    result = emitter.getI1Type();
    break;
  case TypeKind::Int:
  case TypeKind::UInt:
    result = emitter.getI32Type();
    break;
  case TypeKind::Float:
    result = emitter.getF32Type();
    break;
  case TypeKind::Vector:
    result = mlir::VectorType::get({source->count}, type(source->element));
    break;
  case TypeKind::Color:
    result = mlir::VectorType::get({options.colorComponents}, emitter.getF32Type());
    break;
  case TypeKind::Matrix:
  case TypeKind::Array:
    result = ir::ArrayType::get(source->count, type(source->element));
    break;
  case TypeKind::Buffer:
    result =
        ir::BufferType::get(type(source->element), source->count, source->mode != BufferMode::Read);
    break;
  case TypeKind::Class:
    result = ir::RefType::get(context(), className(source));
    break;
  case TypeKind::Struct: {
    llvm::SmallVector<mlir::StringAttr> names;
    llvm::SmallVector<mlir::Type> fields;
    for (const typed::Field &field : source->structure->fields) {
      names.push_back(emitter.getStringAttr(field.name));
      fields.push_back(type(field.type));
    }
    result = ir::StructType::get(context(), source->structure->name, names, fields);
    break;
  }
  case TypeKind::Error:
  case TypeKind::Void:
  case TypeKind::String:
    llvm::report_fatal_error("a type without values reached lowering");
  }
  types[source] = result;
  return result;
}

} // namespace rtsl::lowering
