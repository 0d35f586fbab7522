//===- DoublePrecision.h - what --fp=double changes -----------------------===//
#pragma once

#include "codegen/emit/Jit.h"

#include <vector>

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Makes the arithmetic of what the module defines double: operations, choices, conversions and
/// elementary functions. Memory stays single, and what crosses a call: a value is rounded when it
/// is stored, passed or returned. Call it while shader code is alone in the module; device code that
/// is linked later stays single, traversal above all.
void widenArithmetic(llvm::Module &module);

/// The elementary functions that it then calls: those of the C library.
std::vector<HostSymbol> doubleFunctions();

} // namespace rtsl::codegen
