//===- ConvertToLlvm.h - level 2 to MLIR's LLVM dialect -------------------===//
//
// The state of the ray becomes an explicit parameter, the first of every function, and every
// address an offset: in RtslState and RtslLaunch by offsetof (runtime/device/ray), in records
// and aggregates by codegen/ir/Layout.h.
//
//   - a reference is an i32, an address an !llvm.ptr, a bool in memory an i32;
//   - memory is accessed with alignment 4, vectors too;
//   - a load of a member is invariant, except in constructors and functions that they call;
//   - elementary functions, trace, hit and the like are calls with scalars and pointers only;
//   - arithmetic is strict: no fast-math flags, no contraction.
//
// A function with `rtsl.export` keeps its name. Any other free function is renamed (`f` to
// `function.f`), because LLVM treats names such as `free` or `expf` specially.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <memory>

namespace mlir {
class DialectRegistry;
class ModuleOp;
class OpPassManager;
class Pass;
} // namespace mlir

namespace rtsl::codegen {

/// `rtsl-to-llvm`, on a module of level 2. Fails with a message if linking has not resolved a
/// dispatch slot or set the offset of an attribute.
std::unique_ptr<mlir::Pass> createConvertToLlvmPass();

/// Records on operations the facts that the pass derives from the whole program and cannot derive
/// from a part of it (Parts.h). For a module that is a whole program, the pass calls this itself.
void noteWholeProgram(mlir::ModuleOp module);

/// The dialects whose operations the pass makes.
void registerLlvmDialects(mlir::DialectRegistry &registry);

/// From level 2 to the LLVM dialect, cleaned up.
void buildLlvmPipeline(mlir::OpPassManager &module);

/// Registers the pass and the pipeline (`--rtsl-llvm`) for a command line.
void registerLlvmPasses();

} // namespace rtsl::codegen
