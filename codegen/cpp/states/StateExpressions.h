//===- StateExpressions.h - expressions of a state: the author's, and constants ===//
//
// An expression is the author's tree (codegen/lower/SourceTable.h), whose leaves are what the IR
// has computed.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/states/StatePart.h"
#include "codegen/lower/SourceTable.h"

namespace rtsl::cpp {

class StateExpressions : StatePart {
public:
  using StatePart::StatePart;

  /// Prints the operation, if it is an expression.
  bool print(mlir::Operation &op, Statements &out);
  Code of(const SourceTable::Entry &entry, mlir::ValueRange operands);
  /// Sets what the leaves of the author's expression are here.
  void replaceLeaves(const SourceTable::Entry &entry, mlir::ValueRange operands);
  Code constant(mlir::Value value, const Type *type);
  /// `i >= 3` for `i < 3`, which is the code of `condition`.
  Code opposite(mlir::Value condition, const Code &code);

  std::vector<const typed::Variable *> constants; // of the author's functions, that the state names

private:
  void nameConstants(const typed::Expr &expr);
};

} // namespace rtsl::cpp
