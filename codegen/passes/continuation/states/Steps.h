//===- Steps.h - splitting into states and what follows -------------------===//
//
// Each step with its file; Split.cpp calls them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

namespace rtsl::continuation {

/// SplitStates.cpp: replaces a function by its states, `@f.state0` for its beginning and one for
/// each trace.
mlir::FailureOr<llvm::SmallVector<FuncOp>> splitStates(FuncOp function);

/// ForwardArguments.cpp: replaces block arguments that get only one value, on all paths, by that
/// value.
void forwardArguments(FuncOp function);

/// CleanStores.cpp: removes stores of values that the slot already holds. True if there were any.
bool cleanStores(FuncOp state);

/// SinkLoads.cpp: moves loads of the frame, and recomputed values, to their uses, but never into a
/// loop. True if any moved.
bool sinkLoads(FuncOp state);

/// Dispatch.cpp: makes the frame a parameter, numbers the states from 1 in order, and makes the
/// functions that the machine calls: `@rtsl_run_state`, `@rtsl_frame_size`, `@rtsl_ray_kinds` with
/// its tables (RayGraph.h), and `@f_first` for each of machineEntries(), 0 if there is no such
/// function or it does nothing, and for each other exported function that was split.
mlir::LogicalResult makeDispatch(mlir::ModuleOp module);

} // namespace rtsl::continuation
