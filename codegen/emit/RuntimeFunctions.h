//===- RuntimeFunctions.h - what compiled code calls ----------------------===//
//
// Declarations, in MLIR's LLVM dialect, of the functions of runtime/device that ops become. Private
// to codegen/emit.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/LLVMIR/LLVMDialect.h"
#include "mlir/IR/BuiltinOps.h"

namespace rtsl::codegen {

/// Name of the function that a component of `rtsl.elementary`, or another op, is a call of; empty
/// if it is none.
std::string runtimeFunction(mlir::Operation *op);

/// Declares, once and in the order of first use, every runtime function that an op of the module
/// becomes a call of.
void declareRuntimeFunctions(mlir::ModuleOp module);

} // namespace rtsl::codegen
