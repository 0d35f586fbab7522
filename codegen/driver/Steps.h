//===- Steps.h - the steps that stages consist of -------------------------===//
//
// From a checked module to IR and states; Stages.cpp calls these steps in order, and those of
// machine/LlvmSteps.h. A step that fails is an internal error, because the program was checked
// before: it throws std::logic_error, for which `rtslc` has its own exit status.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/driver/Compiler.h"
#include "codegen/driver/MachineCode.h"
#include "codegen/lower/SourceTable.h"
#include "codegen/passes/continuation/Split.h"

#include "mlir/IR/BuiltinOps.h"
#include "mlir/IR/MLIRContext.h"
#include "mlir/IR/OwningOpRef.h"
#include "mlir/Pass/PassManager.h"
#include "llvm/ADT/STLFunctionalExtras.h"

#include <memory>
#include <string>

namespace rtsl::driver {

/// `machineCode` may be null.
std::unique_ptr<mlir::MLIRContext> makeContext(const MachineCode *machineCode);

/// Loads the dialects that a pipeline makes operations of.
void loadDialects(mlir::MLIRContext &context, void (*build)(mlir::OpPassManager &));

/// From now on, passes and other work on functions may use several threads, if the module is large.
void allowThreads(mlir::ModuleOp ir, const CompileOptions &options);

/// Null if something is not supported, which is reported. `source`: LowerOptions::source.
mlir::OwningOpRef<mlir::ModuleOp> lowerModule(const typed::Module &module,
                                              const CompileOptions &options,
                                              const LinkRequest &request, SourceTable *source,
                                              Diagnostics &diagnostics, mlir::MLIRContext &context);

/// Runs `work` on the module.
void expectSuccess(mlir::ModuleOp ir, llvm::function_ref<bool()> work);

void run(mlir::ModuleOp ir, void (*build)(mlir::OpPassManager &));

SplitOptions splitOptions(const CompileOptions &options);

/// Level 1 to level 2, to states.
SplitReport runToStates(mlir::ModuleOp ir, const SplitOptions &options);

std::string print(mlir::ModuleOp ir);

} // namespace rtsl::driver
