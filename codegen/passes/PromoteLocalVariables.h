//===- PromoteLocalVariables.h - variables of one block become values -----===//
//
// MLIR's mem2reg walks over the whole function for each variable, which takes the square of the time where both are many.
// Most variables of a large function are written and then read in one block; one walk makes values of all of these.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-promote-local-vars`, on a function over `cf`. Functions with fewer variables are left to mem2reg.
std::unique_ptr<mlir::Pass> createPromoteLocalVariablesPass(unsigned fewest = 200);

} // namespace rtsl::codegen
