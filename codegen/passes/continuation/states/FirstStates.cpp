//===- FirstStates.cpp - the states in which entry points begin -----------===//
//
//   @shade.state0(%object):                @shade.state0.first(%object) -> i32:
//     switch class_id %object                switch class_id %object
//       Glass: next jump @Glass.state0  ->     Glass: return 2     // @Glass.state0
//       Grey:  store ...; next done            Grey:  return 1     // @shade.state0
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/continuation/states/FirstStates.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/Slots.h"
#include "codegen/passes/continuation/common/TracedFunctions.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/IR/IRMapping.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"

#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/SmallPtrSet.h"

namespace rtsl::continuation {

namespace arith = mlir::arith;

namespace {

bool hasNoEffects(mlir::Block &block) {
  return llvm::all_of(block, [](mlir::Operation &op) { return mlir::isMemoryEffectFree(&op); });
}

/// The state that the block jumps to without doing anything; empty if there is none.
llvm::StringRef jumpsTo(mlir::Block &block) {
  auto end = llvm::dyn_cast<ir::EndOp>(block.getTerminator());
  auto next = end ? end.getNext().getDefiningOp<ir::NextOp>() : ir::NextOp();
  if (!next || next.getTransition() != ir::Transition::Jump || !hasNoEffects(block))
    return {};
  return *next.getState();
}

bool isEntry(FuncOp function) {
  return ir::attr::state.isOn(function) && ir::attr::entry.isOn(function);
}

/// The state that an entry's state jumps to whatever the object is, if nothing else jumps to it.
llvm::StringRef onlyTarget(FuncOp state) {
  const bool isUsed = !mlir::SymbolTable::symbolKnownUseEmpty(state, state->getParentOp());
  return isUsed || !state.getBody().hasOneBlock() ? llvm::StringRef()
                                                  : jumpsTo(state.getBody().front());
}

/// Whether a path through the state does nothing but jump.
bool mayOnlyJump(FuncOp state) {
  mlir::Block &entry = state.getBody().front();
  return jumpsTo(entry).empty() && hasNoEffects(entry) &&
         llvm::any_of(state.getBody(), [](mlir::Block &block) { return !jumpsTo(block).empty(); });
}

/// The blocks of a copy of an entry's state, and the numbers that they are to return.
class Choice {
public:
  Choice(FuncOp function, std::int32_t own, const StateNumbers &numbers)
      : function(function), own(own), numbers(numbers) {}

  void make() {
    visit(&function.getBody().front());
    eraseOthers();
    for (auto [block, number] : results)
      returnNumber(*block, number);
  }

private:
  /// Visits the blocks that are reached before the number is known.
  void visit(mlir::Block *block) {
    if (!reached.insert(block).second)
      return;
    const llvm::StringRef target = jumpsTo(*block);
    if (!target.empty())
      results[block] = numbers.lookup(target);
    else if (block->getNumSuccessors() == 0 || !hasNoEffects(*block))
      results[block] = own;
    else
      for (mlir::Block *next : block->getSuccessors())
        visit(next);
  }

  void eraseOthers() {
    llvm::SmallVector<mlir::Block *> others;
    for (mlir::Block &block : function.getBody())
      if (!reached.count(&block))
        others.push_back(&block);
    for (mlir::Block *block : others) {
      block->dropAllDefinedValueUses();
      block->dropAllReferences();
    }
    for (auto [block, number] : results)
      block->getTerminator()->dropAllReferences();
    for (mlir::Block *block : others)
      block->erase();
  }

  static void returnNumber(mlir::Block &block, std::int32_t number) {
    while (!block.empty())
      block.back().erase();
    auto builder = mlir::OpBuilder::atBlockEnd(&block);
    const mlir::Location location = builder.getUnknownLoc();
    mlir::Value value =
        arith::ConstantOp::create(builder, location, builder.getI32IntegerAttr(number));
    mlir::func::ReturnOp::create(builder, location, mlir::ValueRange(value));
  }

  FuncOp function;
  const std::int32_t own; // of the entry's state
  const StateNumbers &numbers;
  llvm::SmallPtrSet<mlir::Block *, 8> reached;
  llvm::MapVector<mlir::Block *, std::int32_t> results;
};

/// `@state.first(%object) -> i32`: the number of the state that is to run for the object.
FuncOp makeChoice(FuncOp state, const StateNumbers &numbers) {
  mlir::OpBuilder builder(state);
  const std::string name = (state.getSymName() + ".first").str();
  auto choice = FuncOp::create(builder, builder.getUnknownLoc(), name, state.getFunctionType());
  choice.setPrivate();
  mlir::IRMapping clones;
  state.getBody().cloneInto(&choice.getBody(), clones);
  Choice(choice, numbers.lookup(state.getSymName()), numbers).make();
  return choice;
}

} // namespace

std::map<std::string, std::string> findFirstStates(mlir::ModuleOp module) {
  std::map<std::string, std::string> first;
  for (llvm::StringRef slot : machineSlots())
    first[ir::slotSymbol(slot)];
  for (FuncOp state : llvm::make_early_inc_range(module.getOps<FuncOp>())) {
    if (!isEntry(state))
      continue;
    std::string &name = first[ir::attr::entry.of(state).getValue().str()];
    name = onlyTarget(state).str();
    if (name.empty())
      name = state.getSymName().str();
    else
      state.erase();
  }
  return first;
}

FuncOp makeFirstState(mlir::ModuleOp module, llvm::ArrayRef<FuncOp> states,
                      const StateNumbers &numbers) {
  mlir::OpBuilder builder(module.getContext());
  builder.setInsertionPointToEnd(module.getBody());
  const mlir::Location location = builder.getUnknownLoc();
  const mlir::Type number = builder.getI32Type();
  const mlir::Type object = ir::RefType::get(builder.getContext(), "object");
  auto function = FuncOp::create(builder, location, "rtsl_first_state",
                                 builder.getFunctionType({number, object}, {number}));
  mlir::Block *entry = function.addEntryBlock();
  mlir::Block *itself = function.addBlock();
  builder.setInsertionPointToEnd(itself);
  mlir::func::ReturnOp::create(builder, location, mlir::ValueRange(entry->getArgument(0)));
  llvm::SmallVector<std::int32_t> values;
  llvm::SmallVector<mlir::Block *> blocks;
  for (FuncOp state : states) {
    if (!isEntry(state) || !objectOf(state) || !mayOnlyJump(state))
      continue;
    FuncOp choice = makeChoice(state, numbers);
    mlir::Block *block = function.addBlock();
    builder.setInsertionPointToEnd(block);
    mlir::Value own = builder.createOrFold<ir::CastRefOp>(location, objectOf(state).getType(),
                                                          entry->getArgument(1));
    auto call = mlir::func::CallOp::create(builder, location, choice, mlir::ValueRange(own));
    mlir::func::ReturnOp::create(builder, location, call.getResults());
    values.push_back(numbers.lookup(state.getSymName()));
    blocks.push_back(block);
  }
  builder.setInsertionPointToEnd(entry);
  llvm::SmallVector<mlir::ValueRange> noOperands(blocks.size());
  mlir::cf::SwitchOp::create(builder, location, entry->getArgument(0), itself, mlir::ValueRange{},
                             llvm::ArrayRef<std::int32_t>(values), blocks, noOperands);
  return function;
}

} // namespace rtsl::continuation
