//===- JoinCalls.h - a program as one function ----------------------------===//
//
// A megakernel has the state of its current ray in a local variable, and passes its address to
// every function that a state calls. LLVM promotes such a variable to values, which can be in
// registers, only if no call that takes the address remains. So these calls are inlined, regardless
// of cost.
//
//===----------------------------------------------------------------------===//
#pragma once

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// In programs whose rays lie in records between their steps, first passes the launch to functions
/// that read nothing of the ray (PassLaunches.h); these remain.
///
/// Marks the functions that take addresses so that LLVM inlines all calls of them, before any other
/// pass. Does nothing in programs with separate functions (codegen/ir/Separate.h), and in those
/// that would become larger than LLVM handles in reasonable time. Returns whether any function is
/// to be inlined.
bool joinCalls(llvm::Module &module);

} // namespace rtsl::codegen
