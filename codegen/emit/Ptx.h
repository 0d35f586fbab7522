//===- Ptx.h - LLVM IR as PTX ---------------------------------------------===//
#pragma once

#include "llvm/Support/Error.h"

#include <string>

namespace llvm {
class Module;
class TargetMachine;
} // namespace llvm

namespace rtsl::codegen {

/// Adapts names to PTX, whose identifiers have no dots: `Glass.shade` becomes `Glass_shade`. The
/// first block of a function is named after it, so that a comment marks the beginning of its code
/// even if it was inlined. Call before optimising.
void nameForPtx(llvm::Module &module);

/// The PTX of an optimised module, which is modified. `machine` is one for a GPU.
llvm::Expected<std::string> printPtx(llvm::Module &module, llvm::TargetMachine &machine);

} // namespace rtsl::codegen
