//===- PromoteVariables.h - all variables of a function become values -----===//
//
// MLIR's mem2reg walks over the whole function for each variable, which takes the square of the
// time where both are many. This makes values of all variables that are only loaded, stored and
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

/// `rtsl-promote-vars`, on a function over `cf` whose variables stand in its first block. Functions
/// with fewer variables are left to mem2reg. Arguments of blocks that turn out to be one value are
/// left to rtsl-simplify.
std::unique_ptr<mlir::Pass> createPromoteVariablesPass(unsigned fewest = 200);

} // namespace rtsl::codegen
