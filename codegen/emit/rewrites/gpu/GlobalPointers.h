//===- GlobalPointers.h - where pointers of a scene lead on a GPU ---------===//
//
// What the launch refers to, and what that refers to, is in the global memory of a GPU. LLVM does
// not know this of pointers that are loaded, and loads from there by instructions that could also
// find local or shared memory. Those of global memory wait for no store to these.
//
//   %meshes = load ptr, (the launch)
//   =>
//   %meshes = load ptr, (the launch)
//   %there = addrspacecast ptr %meshes to ptr addrspace(1)
//   %known = addrspacecast ptr addrspace(1) %there to ptr     ; for all uses
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

struct GlobalPointersPass : llvm::PassInfoMixin<GlobalPointersPass> {
  llvm::PreservedAnalyses run(llvm::Function &function, llvm::FunctionAnalysisManager &analyses);
};

} // namespace rtsl::codegen
