//===- HitErrorWriter.h - the bound of a hit's t, as statements -----------===//
//
// Walks the structured IR of `Class.rt_boundHitError` and makes a statement of each operation. Its
// member functions are in a file for each kind of operation.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/Names.h"
#include "codegen/cpp/tree/Statement.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/passes/continuation/common/Names.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "llvm/ADT/DenseMap.h"

#include <functional>
#include <set>

namespace rtsl::cpp {

class HitErrorWriter {
public:
  HitErrorWriter(const Names &names, const typed::Class &definition)
      : names(names), definition(definition) {}

  /// The statements of the function; nothing if it has an operation that cannot be printed.
  std::optional<Statements> body(mlir::func::FuncOp function);

private:
  // HitErrorValues.cpp
  /// Components of a vector; 0: it is none.
  static unsigned widthOf(mlir::Type type);
  /// The type of a component, or the type.
  static mlir::Type scalarOf(mlir::Type type);
  /// The type of a value in C++; empty: there is none.
  static std::string typeText(mlir::Type type);
  static bool isDouble(mlir::Operation &op);
  const std::string &nameOf(mlir::Value value);
  /// One component of a vector, or the scalar.
  Code part(mlir::Value value, unsigned index);
  Code whole(mlir::Value value);
  void define(mlir::Value result, Code value, Statements &out);
  /// Defines the result of an operation by its components; a scalar is component 0.
  void defineEach(mlir::Operation &op, Statements &out,
                  const std::function<Code(unsigned)> &component);

  // HitErrorMemory.cpp
  /// A word of a constant table: the table's name, and an index.
  struct Word {
    std::string table;
    Code index;
  };
  std::optional<Word> inTable(mlir::Value address);
  const typed::Member *memberOf(ir::MemberOp op);
  const Type *declaredType(mlir::Value address);
  const typed::Field *fieldOf(ir::FieldOp op);
  Code lvalue(mlir::Value address);
  void load(ir::LoadOp op, Statements &out);
  bool writeMemory(mlir::Operation &op, Statements &out);

  // HitErrorArithmetic.cpp
  void infix(mlir::Operation &op, Operator sign, Statements &out);
  void wrapping(mlir::Operation &op, Operator sign, Statements &out);
  void logical(mlir::Operation &op, Operator ofBools, Operator ofBits, Statements &out);
  void call(mlir::Operation &op, const std::string &function, Statements &out);
  void castTo(mlir::Operation &op, const std::string &type, Statements &out);
  bool writeOperator(mlir::Operation &op, Statements &out);
  bool writeConversion(mlir::Operation &op, Statements &out);
  bool writeFunction(mlir::Operation &op, Statements &out);
  bool writeVector(mlir::Operation &op, Statements &out);

  // HitErrorControl.cpp
  Statements write(mlir::Region &region);
  void write(mlir::Operation &op, Statements &out);
  bool writeControl(mlir::Operation &op, Statements &out);
  Statement loop(ir::LoopOp op);
  Statement switchOver(ir::SwitchOp op);

  const Names &names;
  const typed::Class &definition;
  continuation::UniqueNames uniqueNames;
  std::set<std::string> taken;
  llvm::DenseMap<mlir::Value, std::string> known; // names of values
  bool hasFailed = false;
};

} // namespace rtsl::cpp
