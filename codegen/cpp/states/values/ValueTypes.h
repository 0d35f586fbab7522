//===- ValueTypes.h - the author's types of values of the IR --------------===//
#pragma once

#include "codegen/cpp/states/Machine.h"
#include "codegen/lower/SourceTable.h"

#include "llvm/ADT/DenseMap.h"

namespace rtsl::cpp {

/// Of the values in the states of one method.
class ValueTypes {
public:
  ValueTypes(Context &context, const SourceTable &source, const Machine &machine)
      : context(context), source(source), machine(machine) {}

  const Type *vec3();
  /// Null: the type is not known.
  const Type *of(mlir::Value value);
  const Type *ofVariable(ir::VarOp variable);
  /// Of a variable that stays whole, or of a part of one; null: it is not known.
  const Type *ofMemory(mlir::Value address);
  /// Of a value in the frame by its name there, where all that is saved are constants.
  const Type *ofSaved(const std::string &key, mlir::Type type);

private:
  Context &context;
  const SourceTable &source;
  const Machine &machine;
  llvm::DenseMap<mlir::Operation *, const Type *> variables;
};

/// Is it the name of a state variable?
bool isStateVariable(llvm::StringRef name);

} // namespace rtsl::cpp
