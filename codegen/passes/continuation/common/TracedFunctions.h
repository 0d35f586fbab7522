//===- TracedFunctions.h - the functions of a module that trace -----------===//
#pragma once

#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

namespace rtsl::continuation {

using mlir::func::FuncOp;

/// The suspends of a function, in the order of their blocks.
llvm::SmallVector<ir::SuspendOp> suspendsOf(FuncOp function);

/// The object of a method: it is passed with the ray and never saved. Null if the first argument is
/// not a reference.
mlir::Value objectOf(FuncOp function);

/// The functions of the module that trace, or that call one that does.
llvm::SmallVector<FuncOp> tracingFunctions(mlir::ModuleOp module);

/// The recursive ones among the tracing functions.
llvm::SmallVector<FuncOp> functionsThatMayCallThemselves(mlir::ModuleOp module);

/// The slots whose entry points the machine starts (runtime/device/engines/Machine.h): these become
/// states even if they do not trace.
llvm::ArrayRef<llvm::StringLiteral> machineSlots();

/// Has the function, or the call, a frame of its own (calls/Steps.h)?
bool isFramed(mlir::Operation *op);

} // namespace rtsl::continuation
