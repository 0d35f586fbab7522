//===- Recompute.h - what gives the same value again behind a trace -------===//
//
// An operation can be executed again behind a trace if it has no effect and reads nothing that may
// have changed since it was executed before. Members and buffers are constant for a launch. The
// state variables of a ray stay its own while other rays run, but its shader may write them: a load
// of one counts only if no path from the load to the trace, without passing the load again, can
// write it. Arguments of blocks, random numbers, results of calls, of traces and loads of local
// variables never do.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/StringMap.h"
#include "llvm/ADT/StringSet.h"

namespace rtsl::continuation {

/// State variables that something may write.
struct StateWrites {
  bool any = false;
  llvm::StringSet<> names;

  bool mayWrite(llvm::StringRef name) const { return any || names.contains(name); }
  /// True if there was anything new.
  bool add(const StateWrites &other);
};

/// Which state variables the functions of a module may write, calls included.
class WriteSummary {
public:
  explicit WriteSummary(mlir::ModuleOp module);
  /// What one operation may write.
  StateWrites of(mlir::Operation *op) const;
  StateWrites ofFunction(FuncOp function) const {
    return functions.lookup(function.getSymNameAttr());
  }

private:
  void propagate(mlir::ModuleOp module);

  llvm::DenseMap<mlir::StringAttr, StateWrites> functions;
  StateWrites illumination; // what lights write when a point is lit
};

/// Answers for one function.
class Recompute {
public:
  Recompute(FuncOp function, const WriteSummary &summary) : function(function), summary(summary) {}

  /// Whether `op`, which dominates `suspend`, gives the same results again when it is executed
  /// behind it, if its operands are there.
  bool isPossible(mlir::Operation *op, ir::SuspendOp suspend);

private:
  bool isUnchanged(ir::LoadOp load, llvm::StringRef state, ir::SuspendOp suspend);

  FuncOp function;
  const WriteSummary &summary;
  llvm::DenseMap<std::pair<mlir::Operation *, mlir::Operation *>, bool> unchanged;
  llvm::DenseMap<mlir::Operation *, bool> free; // of effects; asked for again at each trace
  llvm::StringMap<bool> written;                // by the function anywhere
};

} // namespace rtsl::continuation
