//===- LiftCalls.h - calls that the callers make instead ------------------===//
//
// Methods that are called for one hit look up the same textures, each for itself. What a function
// computes from its arguments and the state wherever it is called, its callers compute and pass:
//
//   func.func private @Coated.value(%self) {      func.func private @Coated.value(%self, %base) {
//     %base = call @Coated.base(%self)
//     ...                                           ...
//   call @Coated.value(%coated)              ==>  %b = call @Coated.base(%coated)
//                                                 call @Coated.value(%coated, %b)
//   call @Coated.density(%coated)                 %c = call @Coated.base(%coated)
//                                                 call @Coated.density(%coated, %c)
//
// where equal calls are then shared (ShareCalls.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"

namespace rtsl::codegen {

class EffectsOfFunctions;

/// Lifts the calls of a function of level 2 to its callers, `callers` in all.
void liftCalls(mlir::func::FuncOp function, llvm::ArrayRef<mlir::func::CallOp> callers,
               EffectsOfFunctions &effects);

} // namespace rtsl::codegen
