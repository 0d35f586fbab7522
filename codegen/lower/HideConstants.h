//===- HideConstants.h - nothing of single precision folds ----------------===//
//
// With --fp=double arithmetic is widened on LLVM IR (codegen/emit/DoublePrecision.h). What has been
// folded by then was computed in single precision: 1 - exp(-1e-6) has lost its digits. So lowering
// leaves arithmetic of constants as it is, and where numbers come from is hidden from the passes:
// constants, what is loaded, integers that become floats, bits.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/BuiltinOps.h"

namespace rtsl::lowering {

void hideConstants(mlir::ModuleOp module);

} // namespace rtsl::lowering
