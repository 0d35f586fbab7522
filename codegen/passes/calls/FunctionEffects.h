//===- FunctionEffects.h - what functions read and write ------------------===//
#pragma once

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/SymbolTable.h"
#include "llvm/ADT/DenseSet.h"
#include "llvm/ADT/StringSet.h"

#include <map>

namespace rtsl::codegen {

/// What a function does, with its callees. What it stores for its own lookups is left out.
struct FunctionEffects {
  bool isPure = true; // but for what it reads here, for what it reads and writes through its
                      // arguments, and for results of lookups, which are among `writes`
  bool sendsRays = false;
  bool traces = false;             // rays that shaders run for
  unsigned operations = 0;         // with those of its callees
  bool writesAny = false;          // more than `writes`
  bool writesArguments = false;    // through its own; those of its callees count as operands
  llvm::StringSet<> reads, writes; // state variables

  /// Does it only compute something from the members and the state that it reads?
  bool onlyReads() const { return isPure && writes.empty(); }
  /// Is its result worth keeping while rays are sent to lights?
  bool isCostly() const { return operations > 20; }
};

class EffectsOfFunctions {
public:
  explicit EffectsOfFunctions(mlir::ModuleOp module);

  const FunctionEffects &of(mlir::func::FuncOp function);
  const FunctionEffects &of(mlir::func::CallOp call) { return of(calleeOf(call)); }
  mlir::func::FuncOp calleeOf(mlir::func::CallOp call) const {
    return symbols.lookup<mlir::func::FuncOp>(call.getCallee());
  }

  /// Does some caller pass it the address of a state variable?
  bool mayReceiveState(mlir::func::FuncOp function) const {
    return receiveState.contains(function);
  }

private:
  mlir::SymbolTable symbols;
  llvm::DenseSet<mlir::Operation *> receiveState;
  std::map<mlir::Operation *, FunctionEffects> known;
};

} // namespace rtsl::codegen
