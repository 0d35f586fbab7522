//===- LightsAlone.h - nothing but a state's rays to lights ---------------===//
//
// The copies of `rtsl_wave_light` (WaveStates.h) run a state for its rays to lights; nothing else
// that it computes is stored (runtime/device/engines/KnownLights.h). LLVM keeps some of it, because
// it might never end: loops, and calls of functions with loops. If it does not, the state itself
// does not either, so it is removed here.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

/// Removes from the copies of `rtsl_wave_light` what has no effect if it ends.
struct LightsAlonePass : llvm::PassInfoMixin<LightsAlonePass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
