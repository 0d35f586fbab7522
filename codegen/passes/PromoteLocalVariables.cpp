//===- PromoteLocalVariables.cpp - variables of one block become values ---===//
#include "codegen/passes/PromoteLocalVariables.h"

#include "codegen/ir/RtslOps.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Interfaces/DataLayoutInterfaces.h"
#include "mlir/Pass/Pass.h"

namespace rtsl::codegen {

namespace {

/// The variable that the operation loads, stores or clears as a whole, if it does nothing else with one.
ir::VarOp accessedBy(mlir::Operation *op) {
  mlir::Value address;
  if (auto load = llvm::dyn_cast<ir::LoadOp>(op))
    address = load.getAddress();
  else if (auto store = llvm::dyn_cast<ir::StoreOp>(op))
    address = store.getAddress();
  else if (auto clear = llvm::dyn_cast<ir::ClearOp>(op))
    address = clear.getAddress();
  return address ? address.getDefiningOp<ir::VarOp>() : ir::VarOp();
}

/// The block that has all accesses of a variable; null if there are several, or if it is used in another way.
mlir::Block *blockOf(ir::VarOp variable) {
  if (variable.getPromotableSlots().empty())
    return nullptr;
  mlir::Block *only = nullptr;
  for (mlir::Operation *user : variable->getUsers()) {
    if (accessedBy(user) != variable || (only && user->getBlock() != only))
      return nullptr;
    only = user->getBlock();
  }
  return only;
}

using Variables = llvm::SmallPtrSet<mlir::Operation *, 32>;

/// A variable that is read before it is written stays: what it holds may come from another block, or round a loop.
void promoteIn(mlir::Block &block, const Variables &variables) {
  llvm::DenseMap<mlir::Operation *, mlir::Value> held;
  Variables left;
  const mlir::DataLayout layout;
  const llvm::SmallPtrSet<mlir::OpOperand *, 1> noUses;
  mlir::OpBuilder builder(block.getParentOp()->getContext());
  for (mlir::Operation &op : llvm::make_early_inc_range(block)) {
    ir::VarOp variable = accessedBy(&op);
    if (!variable || !variables.contains(variable) || left.contains(variable))
      continue;
    mlir::Value &value = held[variable];
    const mlir::MemorySlot slot = variable.getPromotableSlots().front();
    if (auto load = llvm::dyn_cast<ir::LoadOp>(op)) {
      if (!value) {
        left.insert(variable);
        continue;
      }
      load.getResult().replaceAllUsesWith(value);
    } else if (auto store = llvm::dyn_cast<ir::StoreOp>(op)) {
      value = store.getValue();
      (void)store.removeBlockingUses(slot, noUses, builder, value, layout); // passes the name on
    } else {
      builder.setInsertionPoint(&op);
      value = ir::createZero(builder, op.getLoc(), slot.elemType);
    }
    op.erase();
  }
  for (mlir::Operation *variable : variables)
    if (!left.contains(variable))
      variable->erase();
}

struct PromoteLocalVariables : mlir::PassWrapper<PromoteLocalVariables, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(PromoteLocalVariables)
  explicit PromoteLocalVariables(unsigned fewest) : fewest(fewest) {}
  llvm::StringRef getArgument() const override { return "rtsl-promote-local-vars"; }
  llvm::StringRef getDescription() const override { return "variables that one block alone uses become values"; }

  void runOnOperation() override {
    llvm::SmallVector<ir::VarOp> variables;
    getOperation().walk([&](ir::VarOp variable) { variables.push_back(variable); });
    if (variables.size() < fewest)
      return;
    llvm::DenseMap<mlir::Block *, Variables> ofBlocks;
    for (ir::VarOp variable : variables)
      if (mlir::Block *block = blockOf(variable))
        ofBlocks[block].insert(variable);
    for (mlir::Block &block : getOperation().getBody())
      if (auto own = ofBlocks.find(&block); own != ofBlocks.end())
        promoteIn(block, own->second);
  }

  unsigned fewest;
};

} // namespace

std::unique_ptr<mlir::Pass> createPromoteLocalVariablesPass(unsigned fewest) {
  return std::make_unique<PromoteLocalVariables>(fewest);
}

} // namespace rtsl::codegen
