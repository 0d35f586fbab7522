//===- StatePrinter.h - the body of a state -------------------------------===//
//
// Walks the structured IR of a state. What is computed once and used once becomes part of the
// expression that uses it, unless something in between would change it; the rest gets a variable
// under the author's name. The parts have a class for each concern.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/states/MethodPrinter.h"
#include "codegen/cpp/states/StateExpressions.h"
#include "codegen/cpp/states/StateLvalues.h"
#include "codegen/cpp/states/statements/StateControl.h"
#include "codegen/cpp/states/statements/StateMemory.h"
#include "codegen/cpp/states/statements/StateTransitions.h"
#include "codegen/cpp/states/statements/StatementEmitter.h"
#include "codegen/cpp/states/values/PendingValues.h"
#include "codegen/cpp/states/values/ValueNames.h"
#include "codegen/cpp/states/values/ValueOperations.h"

namespace rtsl::cpp {

/// Makes the tree of one state.
struct StatePrinter {
  explicit StatePrinter(MethodPrinter &method);
  StatePrinter(const StatePrinter &) = delete;

  /// The statements of the state.
  Statements body(mlir::func::FuncOp function);
  /// Appends the statements of one operation.
  void print(mlir::Operation &op, Statements &out);
  void unsupported(mlir::Operation &op) { method.unsupported(op); }

  MethodPrinter &method;
  const SourceTable &source;
  const Machine &machine;
  FunctionPrinter &functions;
  ValueTypes &types;

  ValueNames names;
  StatementEmitter emitter;
  PendingValues values;
  StateLvalues lvalues;
  StateExpressions expressions;
  ValueOperations operations;
  StateMemory memory;
  StateTransitions transitions;
  StateControl control;
};

} // namespace rtsl::cpp
