//===- DoublePrecision.h - what --fp=double changes -----------------------===//
#pragma once

#include "codegen/emit/Jit.h"

#include <vector>

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Makes the arithmetic of what the module defines double: operations, choices, conversions,
/// elementary functions, and numbers and vectors that are passed and returned. Memory stays single:
/// a value is rounded when it is stored. Call it while shader code is alone in the module; device
/// code that is linked later stays single, traversal above all. Nothing may have been folded in
/// single before: what lowering has hidden (codegen/lower/HideConstants.h) is shown again.
void widenArithmetic(llvm::Module &module);

/// The elementary functions that it then calls: those of the C library, and `refract`.
std::vector<HostSymbol> doubleFunctions();

} // namespace rtsl::codegen
