//===- Conversions.h - floats to integers on a GPU ---------------------===//
//
// A conversion to an integer saturates, and 0 is the result for a NaN. Where an instruction need
// not do so, LLVM adds six others around it. That of PTX does ("cvt" in its manual).
//
//   %i = call i32 @llvm.fptosi.sat.i32.f32(float %x)
//   =>
//   %i = call i32 @llvm.nvvm.f2i.rz(float %x)
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

struct ConversionsPass : llvm::PassInfoMixin<ConversionsPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
