//===- NarrowLoads.h - functions that load fields one by one --------------===//
//
// LLVM's SLP pass combines scalars, and then loads several fields of a ray's state at once. Such a
// load waits for the narrow stores that wrote them. That costs more than it gains where they have
// just been written: in the test of a primitive, and in all of a program whose rays carry payloads
// (docs/benchmarks.md, "Paths beside a program by hand"). The results are the same either way.
//
//===----------------------------------------------------------------------===//
#pragma once

namespace llvm {
class Function;
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Marks these functions, which have their names of the source only before optimisation: traversal
/// and tests of primitives in runtime/device, and what implements the slot `intersect`.
void markNarrowLoads(llvm::Module &module);
bool hasNarrowLoads(const llvm::Function &function);
/// Afterwards, so that marks are not printed.
void unmarkNarrowLoads(llvm::Module &module);

} // namespace rtsl::codegen
