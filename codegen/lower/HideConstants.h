//===- HideConstants.h - no folding before LLVM IR ------------------------===//
//
// With --fp=double arithmetic is widened on LLVM IR
// (codegen/emit/rewrites/arithmetic/DoublePrecision.h). Anything folded before that was computed in
// single precision: 1 - exp(-1e-6) has lost its digits. So lowering does not fold arithmetic, and
// the sources of numbers are hidden from the passes: constants, loads, integers that become floats,
// bit casts. The same is done to find where a number becomes infinite
// (codegen/emit/rewrites/arithmetic/CheckNumbers.h): the operation must still be there.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/BuiltinOps.h"

namespace rtsl::lowering {

void hideConstants(mlir::ModuleOp module);

} // namespace rtsl::lowering
