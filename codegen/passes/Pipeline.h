//===- Pipeline.h - from level 1 to level 2, in order ---------------------===//
#pragma once

namespace mlir {
class DialectRegistry;
class OpPassManager;
} // namespace mlir

namespace rtsl::codegen {

/// Level 1 to level 2, optimised: SSA over `cf`. Runs on a module; private functions that nobody
/// calls are dropped.
void buildSsaPipeline(mlir::OpPassManager &module);

/// The same without constants of a scene, and with every call inlined that can be: for analyses of
/// functions that are to be the same with a scene and without.
void buildPlainPipeline(mlir::OpPassManager &module);

/// What a context needs for the passes beside the dialects themselves; call before the context is
/// made or `appendDialectRegistry` it.
void registerPassDependencies(mlir::DialectRegistry &registry);

/// Makes the passes of this folder and the pipeline (`--rtsl-ssa`) known to a command line.
void registerPasses();

} // namespace rtsl::codegen
