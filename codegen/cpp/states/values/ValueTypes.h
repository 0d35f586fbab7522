//===- ValueTypes.h - the author's types of values of the IR --------------===//
#pragma once

#include "codegen/cpp/states/Machine.h"
#include "codegen/lower/SourceTable.h"

#include "llvm/ADT/DenseMap.h"

namespace rtsl::cpp {

/// Finds the types of the values in the states of one method.
class ValueTypes {
public:
  ValueTypes(Context &context, const SourceTable &source, const Machine &machine)
      : context(context), source(source), machine(machine) {}

  const Type *vec3();
  /// The type of a value; null: it is not known.
  const Type *of(mlir::Value value);
  const Type *ofVariable(ir::VarOp variable);
  /// The type of a variable that stays whole, or of a part of one; null: it is not known.
  const Type *ofMemory(mlir::Value address);
  /// The type of a value in the frame by its name there, where only constants are saved to it.
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
