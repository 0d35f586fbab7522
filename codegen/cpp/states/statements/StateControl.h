//===- StateControl.h - branches, loops and blocks of a state -------------===//
#pragma once

#include "codegen/cpp/states/StatePart.h"

namespace rtsl::cpp {

class StateControl : StatePart {
public:
  using StatePart::StatePart;

  /// Prints the operation, if it is one of these.
  bool print(mlir::Operation &op, Statements &out);
  void block(mlir::Block &block, Statements &out);

private:
  void choice(ir::IfOp op, Statements &out);
  void loop(ir::LoopOp op, Statements &out);
  void switchOver(ir::SwitchOp op, Statements &out);
  std::optional<Statement> lights(ir::LoopOp op, mlir::Block *&lit, std::string &name);
  void nameOpenDeclarations(Statements &out);
};

} // namespace rtsl::cpp
