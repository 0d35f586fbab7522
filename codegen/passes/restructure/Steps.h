//===- Steps.h - the steps of restructuring a function --------------------===//
//
// In the order in which Restructure.cpp calls them, each with its file.
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

/// LeaveSsa.cpp: an edge on which a branch with several successors passes arguments gets a block of
/// its own.
void splitEdges(FuncOp function);

/// MakeReducible.cpp: copies blocks until each loop has one entry. A loop that contained a trace
/// may have several.
void makeReducible(FuncOp function);

/// LeaveSsa.cpp: block arguments, and values that are used where `isVisible` is false, become
/// variables; operations that compute addresses are repeated where they are used.
void leaveSsa(FuncOp function, llvm::function_ref<bool(mlir::Value, mlir::Block *use)> isVisible);

/// Plan.cpp: the position of each block in the structured function.
class Plan {
public:
  explicit Plan(FuncOp function);

  /// The main exit of a loop: the target of `rtsl.break`, and whether its code follows the loop (or
  /// is further out).
  struct Exit {
    mlir::Block *target = nullptr;
    bool followsLoop = false;
  };
  bool isLoopHeader(mlir::Block *block) const { return exits.count(block) != 0; }
  Exit exitOf(mlir::Block *header) const { return exits.lookup(header); }

  /// Is the code of the block put at the one branch to it?
  bool isInline(mlir::Block *block) const { return inlined.contains(block); }
  /// The blocks whose code follows the successors of `block`, in order.
  llvm::ArrayRef<mlir::Block *> following(mlir::Block *block) const;
  /// The blocks whose code follows a loop and its exit block: exits of the loop join there.
  llvm::ArrayRef<mlir::Block *> followingLoop(mlir::Block *header) const;
  /// Are values of `definition` visible in the code of `use`?
  bool isVisible(mlir::Block *definition, mlir::Block *use) const;

private:
  llvm::DenseMap<mlir::Block *, Exit> exits;
  llvm::DenseSet<mlir::Block *> inlined;
  llvm::DenseMap<mlir::Block *, llvm::SmallVector<mlir::Block *, 2>> merges, mergesAfterLoop;
  llvm::DenseMap<mlir::Block *, mlir::Block *> parent; // the block in whose sequence it is
};

/// BuildRegions.cpp: replaces the blocks, which have no arguments any more, by regions.
mlir::LogicalResult buildRegions(FuncOp function, const Plan &plan);

/// JoinFlags.cpp: joins flags that are always equal. Erased ones are removed from the list.
void joinFlags(llvm::SmallVectorImpl<ir::VarOp> &flags);

} // namespace rtsl::restructuring
