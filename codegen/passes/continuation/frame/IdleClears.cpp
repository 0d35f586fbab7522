//===- IdleClears.cpp - clears of variables that are overwritten ----------===//
//
//   rtsl.clear %ray                       rtsl.clear %ray
//   rtsl.clear %ray             ==>       ...
//   ...
//
// Variables in memory are cleared at their declaration, and again when they move to the frame. In
// C++ output a clear should appear only where the zeros are read.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/passes/continuation/frame/Steps.h"

#include "llvm/ADT/SmallPtrSet.h"

namespace rtsl::continuation {

namespace {

bool mentions(mlir::Operation *op, mlir::Value root) {
  return llvm::any_of(op->getOperands(), [&](mlir::Value operand) {
    return llvm::isa<ir::PtrType>(operand.getType()) && ir::baseAddress(operand) == root;
  });
}

/// Does the operation overwrite the whole variable without reading it?
bool overwrites(mlir::Operation *op, mlir::Value root) {
  if (auto clear = llvm::dyn_cast<ir::ClearOp>(op))
    return clear.getAddress() == root;
  if (auto copy = llvm::dyn_cast<ir::CopyOp>(op))
    return copy.getTarget() == root && ir::baseAddress(copy.getSource()) != root;
  if (auto evaluation = llvm::dyn_cast<ir::EvaluateOp>(op))
    return ir::attr::into.isOn(evaluation) && evaluation.getOperand(0) == root &&
           llvm::none_of(evaluation.getOperands().drop_front(), [&](mlir::Value operand) {
             return llvm::isa<ir::PtrType>(operand.getType()) && ir::baseAddress(operand) == root;
           });
  return false;
}

/// Is the variable overwritten on every path before it is accessed?
bool isIdle(ir::ClearOp clear) {
  const mlir::Value root = clear.getAddress();
  llvm::SmallPtrSet<mlir::Block *, 16> seen;
  llvm::SmallVector<mlir::Block::iterator> begins = {std::next(clear->getIterator())};
  llvm::SmallVector<mlir::Block *> blocks = {clear->getBlock()};
  while (!begins.empty()) {
    auto at = begins.pop_back_val();
    mlir::Block *block = blocks.pop_back_val();
    bool isOver = false;
    for (; at != block->end() && !isOver; ++at) {
      isOver = overwrites(&*at, root);
      if (!isOver && !llvm::isa<ir::FieldOp, ir::ElementOp>(*at) && mentions(&*at, root))
        return false;
    }
    if (isOver)
      continue;
    for (mlir::Block *next : block->getSuccessors())
      if (seen.insert(next).second) {
        begins.push_back(next->begin());
        blocks.push_back(next);
      }
  }
  return true;
}

} // namespace

void removeIdleClears(FuncOp function) {
  llvm::SmallVector<ir::ClearOp> clears;
  function.walk([&](ir::ClearOp clear) {
    if (llvm::isa_and_nonnull<ir::VarOp, ir::FrameObjectOp>(clear.getAddress().getDefiningOp()))
      clears.push_back(clear);
  });
  for (ir::ClearOp clear : clears)
    if (isIdle(clear))
      clear.erase();
}

} // namespace rtsl::continuation
