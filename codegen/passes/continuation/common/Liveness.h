//===- Liveness.h - which values are live where ---------------------------===//
//
// MLIR's own liveness is by operation and unordered; this one is by block, for one function, in
// program order, and the values that a suspend uses can be given.
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

  /// Computes liveness from the uses of values. With `handedOn`, a suspend uses those values (as
  /// bits) and not all that are live after it.
  using HandedOn = llvm::DenseMap<mlir::Operation *, llvm::BitVector>;
  void compute(const HandedOn *handedOn = nullptr);

  /// After compute() with `handedOn`: adds these values to those that the suspend uses.
  void extend(ir::SuspendOp suspend, const llvm::BitVector &handedOn);

  /// The values that are live at the beginning of a block, without its arguments.
  const llvm::BitVector &into(mlir::Block *block) const { return blocks.find(block)->second.in; }

  /// Program order: blocks in reverse postorder, arguments, then operations; a definition is before
  /// all values that it dominates.
  llvm::ArrayRef<mlir::Value> values() const { return all; }
  unsigned numberOf(mlir::Value value) const { return numbers.lookup(value); }
  llvm::SmallVector<mlir::Value> valuesOf(const llvm::BitVector &set) const;
  llvm::BitVector none() const { return llvm::BitVector(all.size()); }

private:
  struct BlockSets {
    llvm::BitVector used, defined, in; // used: before a definition in the block
  };
  llvm::SmallVector<mlir::Block *> order; // reverse postorder
  llvm::SmallVector<mlir::Value> all;
  llvm::DenseMap<mlir::Value, unsigned> numbers;
  llvm::DenseMap<mlir::Block *, BlockSets> blocks;
};

} // namespace rtsl::continuation
