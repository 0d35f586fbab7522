//===- Parts.h - large programs in parts that are compiled side by side ---===//
//
//   @shade ─── switch ──┬─> @M0.shade           @shade ─── switch ──┬─> (@M0.shade)     @M0.shade   @M500.shade
//                       ├─> @M1.shade    ==>                        ├─> (@M1.shade)     @M1.shade   @M501.shade
//                       ┆                                           ┆                   ┆           ┆
//
// Functions that stay separate anyway (codegen/ir/Separate.h) lose nothing if they are compiled
// apart from one another. What is shared out depends on the program alone, not on the machine, so
// the code is the same everywhere.
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

/// Moves separate functions of level 2 from `program` into modules of their own, which declare what
/// they call and do not have. None for a program that is compiled as fast in one piece.
std::vector<mlir::OwningOpRef<mlir::ModuleOp>> takeParts(mlir::ModuleOp program);

/// The functions that a module defines and shows to others.
std::vector<std::string> visibleFunctions(const llvm::Module &module);

/// After device code was linked with a part: what is too large to be inlined is left to the rest of
/// the program. Gives the names of all functions that the part has not itself.
std::vector<std::string> shareLargeFunctions(llvm::Module &part);

} // namespace rtsl::codegen
