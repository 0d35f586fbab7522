//===- Liveness.h - which values are needed where -------------------------===//
//
// MLIR's own liveness is by operation and has no order; here it is by block, of one function, in
// program order, and a suspend may be told what it hands on.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/common/TracedFunctions.h"

#include "llvm/ADT/BitVector.h"
#include "llvm/ADT/DenseMap.h"

namespace rtsl::continuation {

class Liveness {
public:
  explicit Liveness(FuncOp function);

  /// Computes what is live from the uses of values. With `handedOn`, a suspend needs those values
  /// (as bits) and not what is live behind it.
  using HandedOn = llvm::DenseMap<mlir::Operation *, llvm::BitVector>;
  void compute(const HandedOn *handedOn = nullptr);

  /// After compute() with what suspends hand on: this one hands on these values, and what it handed
  /// on before.
  void extend(ir::SuspendOp suspend, const llvm::BitVector &handedOn);

  /// Values that are live at the beginning of a block and not its arguments.
  const llvm::BitVector &into(mlir::Block *block) const { return blocks.find(block)->second.in; }

  /// Program order: blocks in reverse postorder, arguments, then operations; a definition is before
  /// what it dominates.
  llvm::ArrayRef<mlir::Value> values() const { return all; }
  unsigned numberOf(mlir::Value value) const { return numbers.lookup(value); }
  llvm::SmallVector<mlir::Value> valuesOf(const llvm::BitVector &set) const;
  llvm::BitVector none() const { return llvm::BitVector(all.size()); }

private:
  struct BlockSets {
    llvm::BitVector used, defined, in; // used: before it is defined here
  };
  llvm::SmallVector<mlir::Block *> order; // reverse postorder
  llvm::SmallVector<mlir::Value> all;
  llvm::DenseMap<mlir::Value, unsigned> numbers;
  llvm::DenseMap<mlir::Block *, BlockSets> blocks;
};

} // namespace rtsl::continuation
