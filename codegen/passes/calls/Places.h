//===- Places.h - where a call may stand ----------------------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"

namespace rtsl::codegen {

class EffectsOfFunctions;

/// Does the callee only compute something, from state that does not change within `function`?
bool isSameWhereverCalled(mlir::func::CallOp call, mlir::func::FuncOp function,
                          EffectsOfFunctions &effects);

/// Does each path from the end of the block come to one of the calls?
bool isAlwaysReached(llvm::ArrayRef<mlir::func::CallOp> calls, mlir::Block *from);

/// Whether rays may be sent after `place`, which dominates the call, and then the call comes,
/// without `place` between. Rays to lights do not count if the callee is costly.
bool sendsRaysBetween(mlir::Operation *place, mlir::func::CallOp call, EffectsOfFunctions &effects);

} // namespace rtsl::codegen
