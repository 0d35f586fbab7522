//===- JoinCalls.h - a program as one function ----------------------------===//
//
// A megakernel has the state of its current ray in a local variable, and hands its address to every
// function that a state calls. LLVM makes values of such a variable, which registers can hold, only
// where no call is left that takes the address. So these calls are inlined, whatever they cost.
//
//===----------------------------------------------------------------------===//
#pragma once

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Functions read the launch from their ray's state as what never changes. Of one ray that is so;
/// in the variable of a machine, which one ray after the other uses, the load must not move in
/// front of the store.
void readLaunchAsVariable(llvm::Module &module);

/// Marks the functions that take addresses so that LLVM inlines all calls of them, before anything
/// else. Not in programs with functions that stay functions (codegen/ir/Separate.h), and not in
/// those that would become larger than LLVM handles in reasonable time. Returns whether anything is
/// to be inlined.
bool joinCalls(llvm::Module &module);

} // namespace rtsl::codegen
