//===- StateMemory.h - loads and stores of a state ------------------------===//
#pragma once

#include "codegen/cpp/states/StatePart.h"

namespace rtsl::cpp {

/// Variables, the frame, and evaluations of the author's expressions where their variables lie.
class StateMemory : StatePart {
public:
  using StatePart::StatePart;

  /// Prints the operation, if it is one of these.
  bool print(mlir::Operation &op, Statements &out);
  /// `target += y` for `target + y`, where `value` is the whole expression of the source that made
  /// it.
  Code assignment(const Code &target, const Code &code, mlir::Value value);

private:
  void write(ir::VarOp op, Statements &out);
  void write(ir::LoadOp op, Statements &out);
  void write(ir::CopyOp op, Statements &out);
  void write(ir::ClearOp op, Statements &out);
  void write(ir::StoreOp op, Statements &out);
  void write(ir::ElementOp op, Statements &out);
  void write(ir::FrameLoadOp op, Statements &out);
  void write(ir::FrameStoreOp op, Statements &out);
  void write(ir::EvaluateOp op, Statements &out);
  WrittenVariable writtenVariable(ir::VarOp variable);
  WrittenField writtenField(ir::StoreOp op);
};

} // namespace rtsl::cpp
