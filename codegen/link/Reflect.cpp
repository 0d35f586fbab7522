//===- Reflect.cpp - describe classes to the runtime ----------------------===//
#include "codegen/link/Reflect.h"

#include "codegen/ir/Layout.h"

#include <algorithm>
#include <set>

namespace rtsl {

namespace {

using ValueKind = runtime::ValueType::Kind;

ValueKind scalarKind(const Type *scalar) {
  switch (scalar->kind) {
  case TypeKind::Bool:
    return ValueKind::Bool;
  case TypeKind::Int:
    return ValueKind::Int;
  case TypeKind::UInt:
    return ValueKind::UInt;
  default:
    return ValueKind::Float;
  }
}

runtime::MemberInfo reflectMember(const std::string &name, const Type *type, std::uint32_t offset,
                                  mlir::Type irType) {
  runtime::MemberInfo info;
  info.name = name;
  info.type = reflect(type, irType);
  info.offset = offset;
  return info;
}

} // namespace

runtime::ValueType reflect(const Type *type, mlir::Type irType) {
  runtime::ValueType value;
  value.name = toString(type);
  value.size = ir::sizeInBytes(irType);
  if (type->is(TypeKind::Buffer)) {
    value.bufferRank = static_cast<std::uint8_t>(type->count);
    value.isOutput = type->mode != BufferMode::Read;
    type = type->element;
    irType = mlir::cast<ir::BufferType>(irType).getElement();
    value.elementSize = ir::sizeInBytes(irType);
  }
  while (type->is(TypeKind::Array)) {
    value.arraySizes.push_back(type->count);
    type = type->element;
    irType = mlir::cast<ir::ArrayType>(irType).getElement();
  }
  switch (type->kind) {
  case TypeKind::Vector:
    value.kind = scalarKind(type->element);
    value.rows = static_cast<std::uint8_t>(type->count);
    break;
  case TypeKind::Matrix:
    value.rows = static_cast<std::uint8_t>(type->rows());
    value.columns = static_cast<std::uint8_t>(type->columns());
    break;
  case TypeKind::Color:
    value.kind = ValueKind::Color;
    break;
  case TypeKind::Struct:
    value.kind = ValueKind::Struct;
    for (unsigned i = 0; i < type->structure->fields.size(); ++i) {
      const auto layout = mlir::cast<ir::StructType>(irType);
      const typed::Field &field = type->structure->fields[i];
      value.fields.push_back(reflectMember(field.name, field.type, ir::fieldOffset(layout, i),
                                           layout.getFieldTypes()[i]));
    }
    break;
  case TypeKind::Class:
    value.kind = ValueKind::Reference;
    value.className = type->classType ? type->classType->name : type->builtinClass;
    break;
  default:
    value.kind = scalarKind(type);
    break;
  }
  return value;
}

runtime::ClassInfo reflect(const typed::Class &info, ir::ClassOp record, ir::StructType parameters,
                           RequiredMembers &required) {
  runtime::ClassInfo result;
  result.name = info.name;
  result.root = info.root;
  result.base = info.base ? info.base->name : info.root;
  if (info.base)
    for (const typed::Class *above = info.base->base; above; above = above->base)
      result.ancestors.push_back(above->name);
  result.recordSize = ir::recordSize(record);

  for (const typed::Member *member : allMembers(info)) {
    const std::optional<std::uint32_t> offset = ir::memberOffset(record, member->name);
    if (!offset) // scratch and const members are not in the record
      continue;
    runtime::MemberInfo described = reflectMember(member->name, member->type, *offset,
                                                  record.findMember(member->name).getType());
    described.isPublic = member->access == ast::Access::Public;
    described.hasDefault = member->init != nullptr || member->isOptional; // no object
    described.isRequired = required.has(info, *member);
    described.values = member->values;
    result.members.push_back(std::move(described));
  }

  if (const typed::Function *constructor = findConstructor(info); constructor && parameters) {
    result.hasConstructor = true;
    result.parameterSize = ir::sizeInBytes(parameters);
    for (unsigned i = 0; i < constructor->parameters.size(); ++i) {
      result.parameters.push_back(
          reflectMember(parameters.getFieldNames()[i].str(), constructor->parameters[i]->type,
                        ir::fieldOffset(parameters, i), parameters.getFieldTypes()[i]));
      result.parameters.back().values = constructor->parameters[i]->values;
    }
  }

  std::set<std::string> methods;
  for (const typed::Class *at = &info; at; at = at->base)
    for (const auto &function : at->functions)
      methods.insert(function->isStateMethod && !function->parameters.empty()
                         ? function->name + "(" + toString(function->parameters[0]->type) + ")"
                         : function->name);
  result.methods.assign(methods.begin(), methods.end());
  return result;
}

} // namespace rtsl
