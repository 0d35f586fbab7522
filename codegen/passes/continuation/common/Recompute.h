//===- Recompute.h - operations that can be repeated after a trace --------===//
//
// An operation can be executed again after a trace if it has no side effect and reads no memory
// that may have changed since its first execution. Members and buffers are constant for a launch.
// The state variables of a ray do not change while other rays run, but its own shader may write
// them: a load of one can be repeated only if no path from the load to the trace, without passing
// the load again, may write it. Arguments of blocks, random numbers, results of calls and of
// traces, and loads of local variables can never be repeated.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/StringMap.h"
#include "llvm/ADT/StringSet.h"

namespace rtsl::continuation {

/// State variables that may be written.
struct StateWrites {
  bool any = false;
  llvm::StringSet<> names;

  bool mayWrite(llvm::StringRef name) const { return any || names.contains(name); }
  /// True if this added any.
  bool add(const StateWrites &other);
};

/// Finds which state variables the functions of a module may write, including their callees.
class WriteSummary {
public:
  explicit WriteSummary(mlir::ModuleOp module);
  /// The state variables that one operation may write.
  StateWrites of(mlir::Operation *op) const;
  StateWrites ofFunction(FuncOp function) const {
    return functions.lookup(function.getSymNameAttr());
  }

private:
  void propagate(mlir::ModuleOp module);

  llvm::DenseMap<mlir::StringAttr, StateWrites> functions;
  StateWrites illumination; // written by lights when a point is lit
};

/// Which operations of one function can be recomputed.
class Recompute {
public:
  Recompute(FuncOp function, const WriteSummary &summary) : function(function), summary(summary) {}

  /// Whether `op`, which dominates `suspend`, has the same results when executed again after it, if
  /// its operands are available.
  bool isPossible(mlir::Operation *op, ir::SuspendOp suspend);

private:
  bool isUnchanged(ir::LoadOp load, llvm::StringRef state, ir::SuspendOp suspend);

  FuncOp function;
  const WriteSummary &summary;
  llvm::DenseMap<std::pair<mlir::Operation *, mlir::Operation *>, bool> unchanged;
  llvm::DenseMap<mlir::Operation *, bool> free; // of side effects; cached for all traces
  llvm::StringMap<bool> written;                // by the function anywhere
};

} // namespace rtsl::continuation
