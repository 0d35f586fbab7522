//===- TracedFunctions.h - the functions of a module that trace -----------===//
#pragma once

#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/BuiltinOps.h"

namespace rtsl::continuation {

using mlir::func::FuncOp;

/// The suspends of a function, in the order in which their blocks stand.
llvm::SmallVector<ir::SuspendOp> suspendsOf(FuncOp function);

/// The object of a method: it comes with the ray and is never saved. Null if the first argument is
/// no reference.
mlir::Value objectOf(FuncOp function);

/// The functions of the module that trace, or that call one that does.
llvm::SmallVector<FuncOp> tracingFunctions(mlir::ModuleOp module);

/// Those of them that calls lead back to.
llvm::SmallVector<FuncOp> functionsThatMayCallThemselves(mlir::ModuleOp module);

/// The entries that the machine starts (runtime/device/engines/Machine.h): their states are made
/// even if they do not trace.
llvm::ArrayRef<llvm::StringLiteral> machineEntries();

/// Has the function, or the call, a frame of its own (calls/Steps.h)?
bool isFramed(mlir::Operation *op);

} // namespace rtsl::continuation
