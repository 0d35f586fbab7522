//===- RunningError.h - rounding errors, computed at run time -------------===//
//
// Running error analysis (Wilkinson, "Error analysis revisited", 1986; Higham, "Accuracy and
// Stability of Numerical Algorithms", 2nd edition, 2002, 3.3) in double precision. Each operation
// that a value depends on is repeated in double: so the error of single precision is known, not
// bounded, and does not accumulate like sums of worst cases. Elementary functions have no double
// form on a GPU. The single result for the rounded argument is corrected along the tangent by the
// rounding of the argument, and the remaining error is bounded. These bounds are propagated: |a| eb
// + |b| ea + ea eb for a product, and so on. Members of objects and the ray are exact by
// definition; a literal such as 0.33333333 is not, and stands for any value that rounds to it. All
// of this holds for the branches that are taken (BoundHitError.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/dialect/RtslOps.h"
#include "codegen/passes/errors/ElementaryErrors.h"
#include "codegen/passes/errors/Wide.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/DenseSet.h"

#include <optional>
#include <string>

namespace rtsl {

/// Why the error of a value is not known.
struct ErrorUnknown {
  mlir::Location place;
  std::string reason; // "a loop computes it from its previous value"
};

/// A float, or a vector of floats, without the roundings of single precision.
struct Unrounded {
  mlir::Value value;    // in double
  mlir::Value error;    // bound of its error, in double; null: only roundings of double
  bool isExact = false; // the single value is the same: it was not computed
};

class RunningError {
public:
  /// For values in a function of level 2.
  RunningError(mlir::func::FuncOp function, ElementaryErrors elementary);

  /// Inserts code after the definition of the value. Nothing if the error is not known: then
  /// `whyUnknown` gives the reason.
  std::optional<Unrounded> of(mlir::Value value);
  const ErrorUnknown &whyUnknown() const { return *obstacle; }

private:
  Unrounded unrounded(mlir::Value value);
  Unrounded ofArgument(mlir::BlockArgument argument);
  Unrounded ofConstant(mlir::Operation &op);
  Unrounded ofResult(mlir::Operation &op);
  Unrounded ofArithmetic(mlir::Operation &op);
  Unrounded ofConversion(mlir::Operation &op);
  Unrounded ofParts(mlir::Operation &op);
  Unrounded ofChoice(mlir::Operation &op);
  struct FunctionCall;
  Unrounded ofFunction(mlir::Operation &op);
  Unrounded ofUnaryFunction(const FunctionCall &f);
  Unrounded ofPow(const FunctionCall &f);
  Unrounded ofAtan2(const FunctionCall &f);
  Unrounded alongTangent(const FunctionCall &f, Wide own, Wide slope, Wide room, Wide otherwise);
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
  // values depend on elementary functions or rounded literals: block arguments carry errors
  bool hasErrors = false;
  std::optional<ErrorUnknown> obstacle;
};

} // namespace rtsl
