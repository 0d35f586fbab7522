//===- Parts.h - large programs in parts that are compiled in parallel ----===//
//
//   @shade ── switch ─┬> @M0.shade         @shade ── switch ─┬> (@M0.shade)  @M0.shade  @M500.shade
//                     ├> @M1.shade   ==>                     ├> (@M1.shade)  @M1.shade  @M501.shade
//                     ┆                                      ┆               ┆          ┆
//
// Functions that stay separate anyway (codegen/ir/Separate.h) can be compiled in different parts at
// no loss. The distribution depends only on the program, not on the host, so the code is the same
// everywhere.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/OwningOpRef.h"

#include <string>
#include <vector>

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Moves separate functions of level 2 from `program` into modules of their own, which declare
/// functions that they call and do not contain. None for a program that compiles as fast in one
/// piece.
std::vector<mlir::OwningOpRef<mlir::ModuleOp>> takeParts(mlir::ModuleOp program);

/// The functions that a module defines and exports, except those that each part defines alike.
std::vector<std::string> visibleFunctions(const llvm::Module &module);

/// Runs after device code was linked with a part: functions too large to be inlined are left to the
/// rest of the program. Returns the names of all functions that the part does not contain.
std::vector<std::string> shareLargeFunctions(llvm::Module &part);

} // namespace rtsl::codegen
