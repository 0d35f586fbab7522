//===- FoldConstantFunctions.h - what a program states about itself -------===//
//
// A compiled program defines what its scene needs as functions that return constants, such as
// rtsl_needs and rtsl_color_components (runtime/device/ray/Abi.h). Device code branches on them,
// and most of it is for what the scene does not have.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "llvm/IR/PassManager.h"

namespace rtsl::codegen {

/// Replaces calls of functions that only return a constant, and removes the code that then cannot
/// run: before functions are inlined, so that it is not copied, nor counted in their sizes.
void foldConstantFunctions(llvm::Module &module, llvm::FunctionAnalysisManager &analyses);

} // namespace rtsl::codegen
