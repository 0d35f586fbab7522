//===- Steps.h - splitting into states and what follows -------------------===//
//
// Steps with options or results, and their files; common/Steps.def has the others. Split.cpp calls
// them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/Steps.h"

namespace rtsl::continuation {

/// SplitStates.cpp: replaces a function by its states, `@f.state0` for its beginning and one for
/// each trace.
mlir::FailureOr<llvm::SmallVector<FuncOp>> splitStates(FuncOp function);

/// Dispatch.cpp: makes the frame a parameter, numbers the states from 1 in order, and makes the
/// functions that the machine calls: `@rtsl_run_state`, `@rtsl_frame_size`, `@rtsl_ray_kinds` with
/// its tables (RayGraph.h), and `@f_first` for each of machineSlots(), 0 if there is no such
/// function or it does nothing, and for each other exported function that was split.
mlir::LogicalResult makeDispatch(mlir::ModuleOp module);

} // namespace rtsl::continuation
