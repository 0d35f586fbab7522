//===- PromoteVariables.cpp - promotion of all variables of a function ----===//
#include "codegen/passes/variables/PromoteVariables.h"

#include "codegen/ir/IncomingEdges.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/PatternMatch.h"
#include "mlir/Interfaces/DataLayoutInterfaces.h"
#include "mlir/Pass/Pass.h"
#include "mlir/Transforms/RegionUtils.h"

namespace rtsl::codegen {

namespace {

using mlir::Value;

/// The variable that the operation loads, stores or clears as a whole, if it accesses no other.
ir::VarOp accessedBy(mlir::Operation *op) {
  Value address;
  if (auto load = llvm::dyn_cast<ir::LoadOp>(op))
    address = load.getAddress();
  else if (auto store = llvm::dyn_cast<ir::StoreOp>(op))
    address = store.getAddress();
  else if (auto clear = llvm::dyn_cast<ir::ClearOp>(op))
    address = clear.getAddress();
  return address ? address.getDefiningOp<ir::VarOp>() : ir::VarOp();
}

bool isPromotable(ir::VarOp variable) {
  return !variable.getPromotableSlots().empty() &&
         llvm::all_of(variable->getUsers(),
                      [&](mlir::Operation *user) { return accessedBy(user) == variable; });
}

/// The algorithm of Braun et al., with all blocks and edges known from the start.
class Promotion {
public:
  Promotion(mlir::func::FuncOp function, llvm::ArrayRef<ir::VarOp> variables)
      : function(function), variables(variables), builder(function.getContext()) {
    for (ir::VarOp variable : variables)
      promoted.insert(variable);
  }

  void run() {
    for (mlir::Block &block : function.getBody())
      walk(block);
    llvm::DenseMap<Value, Value> values;
    for (auto [load, variable] : first)
      values[load.getResult()] = atStart(load->getBlock(), variable);
    for (std::size_t i = 0; i < arguments.size();
         ++i) // in order, like the arguments of a block; this may add more
      complete(arguments[i].first, arguments[i].second);
    for (auto [load, variable] : first) {
      Value value = load.getResult();
      for (auto next = values.find(value); next != values.end(); next = values.find(value))
        value = next->second; // which may be another load, further up
      load.getResult().replaceAllUsesWith(value);
    }
    for (auto [load, variable] : first)
      load.erase();
    for (ir::VarOp variable : variables)
      variable.erase();
  }

private:
  using BlockVariable = std::pair<mlir::Block *, mlir::Operation *>; // of a variable in a block

  /// Within a block, loads are replaced by the value stored before; loads before any store are
  /// collected in `first`.
  void walk(mlir::Block &block) {
    const mlir::DataLayout layout;
    const llvm::SmallPtrSet<mlir::OpOperand *, 1> noUses;
    for (mlir::Operation &op : llvm::make_early_inc_range(block)) {
      ir::VarOp variable = accessedBy(&op);
      if (!variable || !promoted.contains(variable))
        continue;
      Value &held = ends[{&block, variable}];
      const mlir::MemorySlot slot = variable.getPromotableSlots().front();
      if (auto load = llvm::dyn_cast<ir::LoadOp>(op)) {
        if (!held) {
          held = load.getResult();
          first.push_back({load, variable});
          continue;
        }
        load.getResult().replaceAllUsesWith(held);
      } else if (auto store = llvm::dyn_cast<ir::StoreOp>(op)) {
        held = store.getValue();
        (void)store.removeBlockingUses(slot, noUses, builder, held, layout); // transfers the name
      } else {
        builder.setInsertionPoint(&op);
        held = ir::createZero(builder, op.getLoc(), slot.elemType);
      }
      op.erase();
    }
  }

  /// The value of a variable at the beginning of the block: an argument if there are several
  /// predecessors.
  Value atStart(mlir::Block *block, ir::VarOp variable) {
    llvm::SmallVector<mlir::Block *> passed; // all of them begin with the same value
    Value value;
    while (!value) {
      if (auto known = starts.find({block, variable}); known != starts.end()) {
        value = known->second;
        break;
      }
      passed.push_back(block);
      const mlir::MemorySlot slot = variable.getPromotableSlots().front();
      if (block->isEntryBlock()) {
        builder.setInsertionPoint(variable);
        value = variable.getDefaultValue(slot, builder);
      } else if (mlir::Block *predecessor = block->getUniquePredecessor()) {
        auto end = ends.find({predecessor, variable});
        value = end != ends.end() ? end->second : Value();
        block = predecessor;
      } else {
        mlir::BlockArgument argument = block->addArgument(slot.elemType, variable.getLoc());
        variable.handleBlockArgument(slot, argument, builder); // names it
        arguments.push_back({argument, variable});
        value = argument;
      }
    }
    for (mlir::Block *one : passed)
      starts[{one, variable}] = value;
    return value;
  }

  /// Passes the variable's values at the ends of the predecessors to the argument.
  void complete(mlir::BlockArgument argument, ir::VarOp variable) {
    ir::forEachEdgeInto(*argument.getOwner(), [&](ir::Edge edge) {
      auto end = ends.find({edge.from(), variable});
      edge.operands().append(end != ends.end() ? end->second : atStart(edge.from(), variable));
    });
  }

  mlir::func::FuncOp function;
  llvm::ArrayRef<ir::VarOp> variables;
  llvm::SmallPtrSet<mlir::Operation *, 32> promoted;
  mlir::OpBuilder builder;
  llvm::DenseMap<BlockVariable, Value> starts,
      ends; // known values; `ends`: of blocks that access the variable
  // loads whose value is the one at the beginning of the block
  llvm::SmallVector<std::pair<ir::LoadOp, ir::VarOp>> first;
  llvm::SmallVector<std::pair<mlir::BlockArgument, ir::VarOp>> arguments;
};

struct PromoteVariables
    : mlir::PassWrapper<PromoteVariables, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(PromoteVariables)
  explicit PromoteVariables(unsigned fewest) : fewest(fewest) {}
  llvm::StringRef getArgument() const override { return "rtsl-promote-vars"; }
  llvm::StringRef getDescription() const override {
    return "promotes all variables to values at once";
  }

  void runOnOperation() override {
    if (getOperation().isExternal())
      return;
    llvm::SmallVector<ir::VarOp> variables;
    for (ir::VarOp variable : getOperation().getBody().front().getOps<ir::VarOp>())
      if (isPromotable(variable))
        variables.push_back(variable);
    if (variables.size() < fewest)
      return;
    mlir::IRRewriter rewriter(&getContext());
    (void)mlir::eraseUnreachableBlocks(rewriter,
                                       getOperation()->getRegions()); // which may be cyclic
    Promotion(getOperation(), variables).run();
  }

  unsigned fewest;
};

} // namespace

std::unique_ptr<mlir::Pass> createPromoteVariablesPass(unsigned fewest) {
  return std::make_unique<PromoteVariables>(fewest);
}

} // namespace rtsl::codegen
