//===- ZeroProducts.h - products with a constant zero ---------------------===//
//
// With --fp=fast the product of any number and a constant 0 is 0, though not of an infinity or a
// NaN: LLVM keeps it for these. The zeros are components of normals and edges along an axis, which
// the scene sets.
//
//   fmul <flags of FastMath.h> float %x, 0.0  =>  0.0
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

struct ZeroProductsPass : llvm::PassInfoMixin<ZeroProductsPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
