//===- Pipeline.h - from level 1 to level 2, in order ---------------------===//
#pragma once

namespace mlir {
class DialectRegistry;
class OpPassManager;
} // namespace mlir

namespace rtsl::codegen {

/// Level 1 to level 2, optimised: SSA over `cf`. Runs on a module; private functions without
/// callers are erased.
void buildSsaPipeline(mlir::OpPassManager &module);

/// The same without constants of a scene, and inlining every call that can be: for analyses of
/// functions that must not depend on the scene.
void buildPlainPipeline(mlir::OpPassManager &module);

/// Registers the dialects and interfaces that the passes need in addition; call before the context
/// is made or `appendDialectRegistry` it.
void registerPassDependencies(mlir::DialectRegistry &registry);

/// Registers the passes of this folder and the pipeline (`--rtsl-ssa`) for a command line.
void registerPasses();

} // namespace rtsl::codegen
