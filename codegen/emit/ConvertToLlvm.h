//===- ConvertToLlvm.h - level 2 to MLIR's LLVM dialect -------------------===//
//
// Here the state of the ray becomes a parameter, the first of every function, and every address an
// offset: of RtslState and RtslLaunch by offsetof (runtime/device/ray/Abi.h), of records and
// aggregates by codegen/ir/Layout.h.
//
//   - a reference is an i32, an address an !llvm.ptr, a bool in memory an i32;
//   - memory is accessed with alignment 4, vectors too;
//   - a load of a member is invariant, but in constructors and in what they call;
//   - elementary functions, trace, hit and the like are calls with scalars and pointers only;
//   - arithmetic is strict: no fast-math flags, no contraction.
//
// A function with `rtsl.export` keeps its name. Any other free function is renamed (`f` to
// `function.f`), for LLVM knows what `free` or `expf` mean.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class ModuleOp;
class OpPassManager;
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-to-llvm`, on a module of level 2. Fails with a message where something is missing that
/// linking supplies: a dispatch slot, or the offset of an attribute.
std::unique_ptr<mlir::Pass> createConvertToLlvmPass();

/// Notes on operations what the pass finds in the whole program and in no part of it (Parts.h). The
/// pass does so itself for a module that is a whole program.
void noteWholeProgram(mlir::ModuleOp module);

/// From level 2 to the LLVM dialect, cleaned up.
void buildLlvmPipeline(mlir::OpPassManager &module);

/// Makes the pass and the pipeline (`--rtsl-llvm`) known to a command line.
void registerLlvmPasses();

} // namespace rtsl::codegen
