//===- IncomingEdges.h - the operands that predecessors pass to a block ---===//
//
// A block with arguments gets their values from its predecessors, once for each edge: a conditional
// branch may have two edges to the same block, with different values.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/Block.h"
#include "mlir/Interfaces/ControlFlowInterfaces.h"
#include "llvm/ADT/SetVector.h"
#include "llvm/ADT/SmallVector.h"

namespace rtsl::ir {

/// An edge of the control-flow graph: from a terminator to one of its successors.
struct Edge {
  mlir::Operation *terminator;
  unsigned successor; // its number among the successors

  mlir::Block *from() const { return terminator->getBlock(); }
  mlir::Block *to() const { return terminator->getSuccessor(successor); }

  /// The operands that are passed along the edge, to read and to change. The terminator must be a
  /// branch.
  mlir::SuccessorOperands operands() const {
    return llvm::cast<mlir::BranchOpInterface>(terminator).getSuccessorOperands(successor);
  }

  /// The operand passed for this argument of the edge's target block. Null if the terminator
  /// produces the value itself, or does not say what it passes.
  mlir::Value passedTo(mlir::BlockArgument argument) const {
    return llvm::isa<mlir::BranchOpInterface>(terminator) ? operands()[argument.getArgNumber()]
                                                          : mlir::Value();
  }
};

/// Calls `visit(Edge)` for each edge into `block`. Edges from the same predecessor come together,
/// in the order of its successors. `visit` may change the operands and the targets of edges.
template <typename Visit>
void forEachEdgeInto(mlir::Block &block, Visit visit) {
  llvm::SmallVector<Edge> edges;
  for (mlir::Block *from :
       llvm::SmallSetVector<mlir::Block *, 4>(block.pred_begin(), block.pred_end()))
    for (unsigned successor = 0; successor < from->getNumSuccessors(); ++successor)
      if (from->getSuccessor(successor) == &block)
        edges.push_back({from->getTerminator(), successor});
  for (Edge edge : edges)
    visit(edge);
}

} // namespace rtsl::ir
