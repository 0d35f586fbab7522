//===- DoublePrecision.h - arithmetic for --fp=double ---------------------===//
#pragma once

#include "codegen/emit/Jit.h"

#include <vector>

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Makes the arithmetic of the functions that the module defines double: operations, selections,
/// conversions, elementary functions, and numbers and vectors that are passed and returned. Memory
/// stays single: a value is rounded when it is stored. Must run while the module contains only
/// shader code: device code that is linked later, above all traversal, stays single. Nothing may
/// have been folded in single precision before: values that lowering has hidden
/// (codegen/lower/HideConstants.h) become visible again.
void widenArithmetic(llvm::Module &module);

/// The elementary functions that the code then calls: those of the C library, and `refract`.
std::vector<HostSymbol> doubleFunctions();

} // namespace rtsl::codegen
