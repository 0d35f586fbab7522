//===- ValueOperations.h - values that the passes have made ---------------===//
//
// Expressions are the author's where they stay whole (StateExpressions.h). What is left are
// components of vectors that are written one by one, and conditions and choices that control flow
// has become.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/states/StatePart.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"

namespace rtsl::cpp {

class ValueOperations : StatePart {
public:
  using StatePart::StatePart;

  /// Prints the operation, if it is one of these.
  bool print(mlir::Operation &op, Statements &out);

private:
  void infix(mlir::Operation &op, Operator sign, Statements &out);
  void write(mlir::vector::ExtractOp op, Statements &out);
  void write(mlir::vector::InsertOp op, Statements &out);
  void write(mlir::vector::FromElementsOp op, Statements &out);
  void write(mlir::vector::BroadcastOp op, Statements &out);
  void write(mlir::vector::ShuffleOp op, Statements &out);
  void write(mlir::arith::XOrIOp op, Statements &out);
  void write(mlir::arith::AndIOp op, Statements &out);
  void write(mlir::arith::OrIOp op, Statements &out);
  void write(mlir::arith::AddIOp op, Statements &out);
  void write(mlir::arith::CmpIOp op, Statements &out);
  void write(mlir::arith::SelectOp op, Statements &out);
};

} // namespace rtsl::cpp
