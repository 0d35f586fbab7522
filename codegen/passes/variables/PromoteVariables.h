//===- PromoteVariables.h - promotion of all variables of a function ------===//
//
// MLIR's mem2reg walks over the whole function for each variable, which takes quadratic time if
// there are many of both. This pass promotes all variables that are only loaded, stored and
// cleared, in one walk over the function and one step for each block that a value passes (Braun et
// al., "Simple and Efficient Construction of Static Single Assignment Form", 2013).
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-promote-vars`, on a function over `cf` whose variables are in its first block. Functions
/// with fewer variables are left to mem2reg, redundant block arguments to rtsl-simplify.
std::unique_ptr<mlir::Pass> createPromoteVariablesPass(unsigned fewest = 200);

} // namespace rtsl::codegen
