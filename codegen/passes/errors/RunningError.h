//===- RunningError.h - what rounding has made of a value, at run time ----===//
//
// Running error analysis (Wilkinson, "Error analysis revisited", 1986; Higham, "Accuracy and
// Stability of Numerical Algorithms", 2nd edition, 2002, 3.3) in double precision. Beside each
// operation that a value depends on stands the same in double: what single precision has lost is
// then known, not bounded, and does not grow along the way as sums of worst cases do. Elementary
// functions have no double form on a GPU. Theirs is the single result for the rounded argument,
// moved along the tangent by what that rounding took, and a bound of what that leaves out travels
// on: |a| eb + |b| ea
// + ea eb for a product, and so on. Members of objects and the ray are exact, for they are what they
// are; a literal such as 0.33333333 is not, and stands for what an author may have meant within
// half a unit. All of this holds for the branches that are taken (BoundHitError.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/RtslOps.h"
#include "codegen/passes/errors/ElementaryErrors.h"
#include "codegen/passes/errors/Wide.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/DenseSet.h"

#include <optional>
#include <string>

namespace rtsl {

/// Why the error of a value is not known: it depends on something for which no error can be given.
struct ErrorUnknown {
  mlir::Location place;
  std::string reason; // "a loop computes it from what it was before"
};

/// A float, or a vector of floats, as it is without the roundings of single precision.
struct Unrounded {
  mlir::Value value;    // in double
  mlir::Value error;    // that this may be off by at most, in double; null: none but that of double
  bool isExact = false; // the single value is the same: nothing was computed
};

class RunningError {
public:
  /// Of values in a function of level 2.
  RunningError(mlir::func::FuncOp function, ElementaryErrors elementary);

  /// Where the value is defined. Nothing if it is not known: then `whyUnknown` says why.
  std::optional<Unrounded> of(mlir::Value value);
  const ErrorUnknown &whyUnknown() const { return *obstacle; }

private:
  Unrounded unrounded(mlir::Value value);
  Unrounded ofArgument(mlir::BlockArgument argument);
  Unrounded ofConstant(mlir::Operation &op);
  Unrounded ofResult(mlir::Operation &op);
  Unrounded ofParts(mlir::Operation &op);
  Unrounded ofChoice(mlir::Operation &op);
  Unrounded ofFunction(mlir::Operation &op);
  Wide ownError(ir::Elementary function, Wide result);
  Wide single(ir::Elementary function, llvm::ArrayRef<Wide> arguments);
  Unrounded ofLoad(mlir::Operation &op);
  Unrounded exact(mlir::Value value);
  Unrounded fail(mlir::Location place, std::string reason);

  bool isIterated(mlir::Value value);
  bool isExactWhole(mlir::Value value, llvm::DenseMap<mlir::Value, bool> &seen);

  mlir::func::FuncOp function;
  ElementaryErrors elementary;
  lowering::Emitter emitter;
  llvm::DenseMap<mlir::Value, Unrounded> known;
  // the value depends on an elementary function or a rounded literal: block arguments carry errors
  bool hasErrors = false;
  std::optional<ErrorUnknown> obstacle;
};

} // namespace rtsl
