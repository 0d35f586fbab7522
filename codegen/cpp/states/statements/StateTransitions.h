//===- StateTransitions.h - rays, calls, and the end of a state -----------===//
#pragma once

#include "codegen/cpp/states/StatePart.h"

namespace rtsl::cpp {

class StateTransitions : StatePart {
public:
  using StatePart::StatePart;

  /// Prints the operation, if it is one of these.
  bool print(mlir::Operation &op, Statements &out);

private:
  void write(ir::SpawnOp op, Statements &out);
  void write(ir::SpawnPayloadOp op, Statements &out);
  void write(ir::RandOp op, Statements &out);
  void write(ir::IlluminateOp op, Statements &out);
  void write(ir::CallArgumentOp op, Statements &out);
  void write(ir::CallResultOp op, Statements &out);
  void write(ir::CallReturnedOp op, Statements &out);
  void write(ir::ReturnOp op, Statements &out);
  Code call(ir::ReturnOp op);

  std::vector<Code> spawned; // the arguments of the ray that is traced when the state ends
};

} // namespace rtsl::cpp
