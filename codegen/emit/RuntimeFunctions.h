//===- RuntimeFunctions.h - runtime functions that compiled code calls ----===//
//
// Declarations, in MLIR's LLVM dialect, of the functions of runtime/device that ops are lowered to.
// Private to codegen/emit.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/Dialect/LLVMIR/LLVMDialect.h"
#include "mlir/IR/BuiltinOps.h"

namespace rtsl::codegen {

/// Name of the function that a component of `rtsl.elementary`, or another op, calls; empty if it
/// calls none.
std::string runtimeFunction(mlir::Operation *op);

/// Is it the LLVM name of a function of runtime/device, or of one that linking adds for it?
/// Functions of shaders have a dot in their names.
inline bool isRuntimeFunction(llvm::StringRef name) {
  return name.starts_with("rtsl_") && !name.contains('.');
}

/// Declares, once and in the order of first use, every runtime function that an op of the module
/// calls.
void declareRuntimeFunctions(mlir::ModuleOp module);

} // namespace rtsl::codegen
