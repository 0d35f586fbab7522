//===- Steps.h - how a function is brought back to level 1 ----------------===//
//
// In the order in which Restructure.cpp calls them; each lies in the file that is named here.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/Dominance.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/DenseSet.h"
#include "llvm/ADT/STLFunctionalExtras.h"
#include "llvm/ADT/SmallVector.h"

namespace rtsl::restructuring {

using mlir::func::FuncOp;

/// LeaveSsa.cpp: a way on which a branch with several ways passes arguments gets a block of its
/// own.
void giveBlocksToWays(FuncOp function);

/// MakeReducible.cpp: copies blocks until each loop is entered at one block. A loop that a trace
/// was cut out of may be entered in its middle, at several places.
void makeReducible(FuncOp function);

/// LeaveSsa.cpp: block arguments, and values that are used where `isVisible` says that they cannot
/// be seen, become variables; operations that compute addresses are repeated where they are used.
void leaveSsa(FuncOp function, llvm::function_ref<bool(mlir::Value, mlir::Block *use)> isVisible);

/// Plan.cpp: where each block goes in the structured function.
class Plan {
public:
  explicit Plan(FuncOp function);

  /// What a loop is left for: the block to which `rtsl.break` goes, and whether its code stands
  /// behind the loop (or somewhere further out).
  struct Exit {
    mlir::Block *target = nullptr;
    bool standsBehindLoop = false;
  };
  bool isLoopHeader(mlir::Block *block) const { return exits.count(block) != 0; }
  Exit exitOf(mlir::Block *header) const { return exits.lookup(header); }

  /// Is the code of the block put where the one branch to it stands?
  bool isInline(mlir::Block *block) const { return inlined.contains(block); }
  /// The blocks whose code follows what `block` branches to, in order.
  llvm::ArrayRef<mlir::Block *> following(mlir::Block *block) const;
  /// The blocks whose code follows a loop and the block behind it: ways out of the loop meet there.
  llvm::ArrayRef<mlir::Block *> followingLoop(mlir::Block *header) const;
  /// Does the code of `use` stand where values of `definition` can be seen?
  bool isVisible(mlir::Block *definition, mlir::Block *use) const;

private:
  llvm::DenseMap<mlir::Block *, Exit> exits;
  llvm::DenseSet<mlir::Block *> inlined;
  llvm::DenseMap<mlir::Block *, llvm::SmallVector<mlir::Block *, 2>> merges, mergesBehindLoop;
  llvm::DenseMap<mlir::Block *, mlir::Block *> parent; // the block in whose sequence it stands
};

/// BuildRegions.cpp: replaces the blocks, which have no arguments any more, by regions.
mlir::LogicalResult buildRegions(FuncOp function, const Plan &plan);

/// JoinFlags.cpp: makes one flag of those that say the same. Those that go leave the list.
void joinFlags(llvm::SmallVectorImpl<ir::VarOp> &flags);

} // namespace rtsl::restructuring
