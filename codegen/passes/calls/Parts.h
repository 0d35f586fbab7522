//===- Parts.h - what is read of aggregates -------------------------------===//
//
// Aggregates are passed to functions, and returned by them, in memory. What is read of one, as
// values, is a list of its parts:
//
//     %y = rtsl.field %layers["y"]          y          %0, %4
//     %0 = rtsl.load %y                     axes[2]    %1
//     %1 = rtsl.load (... "axes" ... 2)
//     %4 = rtsl.load %y
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"

#include <optional>
#include <vector>

namespace rtsl::codegen {

struct Part {
  llvm::SmallVector<mlir::Attribute, 2> path; // names and numbers, from the whole
  mlir::Type type;
  llvm::SmallVector<ir::LoadOp, 2> loads;
};

/// The parts that are loaded, in the order of their first loads. None if something else is done
/// with the aggregate, or if it is not known which part is loaded.
std::optional<std::vector<Part>> partsRead(mlir::Value aggregate);

/// The same of a variable that is cleared and that the call writes.
std::optional<std::vector<Part>> partsOfResult(mlir::Value variable, mlir::func::CallOp call);

/// Loads the part of an aggregate.
mlir::Value loadPart(mlir::OpBuilder &builder, mlir::Location location, mlir::Value aggregate,
                     const Part &part);

/// Puts a value in place of all loads of the part.
void replaceLoads(const Part &part, mlir::Value value);

/// Erases the addresses of parts, which nothing reads any more, and clears.
void eraseParts(mlir::Value aggregate);

/// Adds an argument to a function.
mlir::Value addArgument(mlir::func::FuncOp function, mlir::Type type);

} // namespace rtsl::codegen
