//===- LeaveSsa.cpp - values to variables ---------------------------------===//
//
//     cf.br ^loop(%zero)                       rtsl.store %zero, %i
//   ^loop(%i):                                 cf.br ^loop
//     ...                            ==>     ^loop:
//     %next = arith.addi %i, %one              ...
//     cf.br ^loop(%next)                       %old = rtsl.load %i
//                                              %next = arith.addi %old, %one
//                                              rtsl.store %next, %i
//                                              cf.br ^loop
//
// A block argument and the values that flow into it share a variable unless they interfere or have
// different names in the source. Two values interfere if one is live where the other is defined
// (Budimlic et al., "Fast copy coalescing and live-range identification", 2002).
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/NamedLocation.h"
#include "codegen/passes/continuation/common/Liveness.h"
#include "codegen/passes/continuation/common/Names.h"
#include "codegen/passes/restructure/Steps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/Interfaces/ControlFlowInterfaces.h"
#include "llvm/ADT/MapVector.h"

namespace rtsl::restructuring {

using mlir::Block;
using mlir::Value;
using IsVisible = llvm::function_ref<bool(Value, Block *)>;

// A branch with several successors cannot store the operands of one edge: that edge gets a block.
void splitEdges(FuncOp function) {
  for (Block &block : llvm::make_early_inc_range(function.getBody())) {
    mlir::Operation *terminator = block.getTerminator();
    auto branch = llvm::dyn_cast<mlir::BranchOpInterface>(terminator);
    if (!branch || terminator->getNumSuccessors() < 2)
      continue;
    for (unsigned edge = 0; edge < terminator->getNumSuccessors(); ++edge) {
      mlir::SuccessorOperands operands = branch.getSuccessorOperands(edge);
      if (operands.empty())
        continue;
      Block *between = new Block;
      function.getBody().getBlocks().insert(std::next(block.getIterator()), between);
      mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(between);
      mlir::cf::BranchOp::create(builder, terminator->getLoc(), terminator->getSuccessor(edge),
                                 operands.getForwardedOperands());
      operands.erase(0, operands.size());
      terminator->setSuccessor(between, edge);
    }
  }
}

namespace {

/// May the operation be duplicated freely in the text?
bool isRepeatable(mlir::Operation *op) {
  if (llvm::isa<ir::VarOp>(op))
    return false;
  return op->getNumResults() == 1 &&
         (llvm::isa<ir::PtrType>(op->getResult(0).getType()) ||
          op->hasTrait<mlir::OpTrait::ConstantLike>() ||
          llvm::isa<ir::NullRefOp, ir::NextOp, mlir::arith::IndexCastUIOp>(op));
}

/// Repeats constants, addresses and indices where their definitions are not visible. Addresses are
/// not values, and no variable holds a value of type `index`.
void repeatWhereUsed(FuncOp function, IsVisible isVisible) {
  llvm::SmallVector<mlir::Operation *> work;
  function.walk([&](mlir::Operation *op) {
    if (op != function && isRepeatable(op))
      work.push_back(op);
  });
  while (!work.empty()) {
    mlir::Operation *op = work.pop_back_val();
    Value value = op->getResult(0);
    llvm::SmallVector<mlir::OpOperand *> uses;
    for (mlir::OpOperand &use : value.getUses())
      if (!isVisible(value, use.getOwner()->getBlock()))
        uses.push_back(&use);
    for (mlir::OpOperand *use : uses) {
      mlir::Operation *copy = mlir::OpBuilder(use->getOwner()).clone(*op);
      use->set(copy->getResult(0));
      for (Value operand : copy->getOperands()) // may not be visible here either
        if (mlir::Operation *from = operand.getDefiningOp(); from && isRepeatable(from))
          work.push_back(from);
    }
    if (op->use_empty() && !uses.empty())
      op->erase();
  }
}

class Variables {
public:
  Variables(FuncOp function, IsVisible isVisible)
      : function(function), isVisible(isVisible), liveness(function) {
    liveness.compute();
  }
  void run();

private:
  void collect();
  bool needsVariable(Value value);
  void joinArguments();
  void join(Value argument, Value incoming);
  bool isLiveAfter(Value value, Value definition);
  void makeVariables();
  Value load(Value member, mlir::Operation *before);
  void copyAlong(mlir::cf::BranchOp branch);
  void storeDefinitions();
  void loadUses();

  struct Web {
    llvm::SmallVector<Value> members;
    ir::VariableName name;
    Value address;
  };

  FuncOp function;
  IsVisible isVisible;
  continuation::Liveness liveness;
  llvm::MapVector<Value, unsigned> webOf;
  llvm::SmallVector<Web> webs;
};

bool Variables::needsVariable(Value value) {
  auto argument = llvm::dyn_cast<mlir::BlockArgument>(value);
  if (argument)
    return !argument.getOwner()->isEntryBlock();
  return llvm::any_of(value.getUsers(),
                      [&](mlir::Operation *user) { return !isVisible(value, user->getBlock()); });
}

void Variables::collect() {
  auto add = [&](Value value) {
    webOf[value] = webs.size();
    webs.push_back({{value}, ir::nameIn(value.getLoc()), {}});
  };
  for (Value value : liveness.values())
    if (needsVariable(value))
      add(value);
}

/// Is `value` live after the definition of `definition`?
bool Variables::isLiveAfter(Value value, Value definition) {
  Block *block = definition.getParentBlock();
  mlir::Operation *at = definition.getDefiningOp(); // null: the beginning
  const bool isLiveIn = liveness.into(block).test(liveness.numberOf(value));
  if (value.getParentBlock() == block) {
    mlir::Operation *own = value.getDefiningOp();
    if (own && (!at || at->isBeforeInBlock(own)))
      return false;
  } else if (!isLiveIn) {
    return false;
  }
  for (Block *next : block->getSuccessors())
    if (liveness.into(next).test(liveness.numberOf(value)))
      return true;
  return llvm::any_of(value.getUsers(), [&](mlir::Operation *user) {
    return user->getBlock() == block && (!at || at->isBeforeInBlock(user));
  });
}

void Variables::join(Value argument, Value incoming) {
  auto isFree = [](Value value) {
    mlir::Operation *op = value.getDefiningOp();
    return op && !op->hasTrait<mlir::OpTrait::ConstantLike>() && op->getNumResults() == 1;
  };
  if (!webOf.count(incoming)) {
    if (!isFree(incoming))
      return;
    webOf[incoming] = webs.size();
    webs.push_back({{incoming}, ir::nameIn(incoming.getLoc()), {}});
  }
  const unsigned into = webOf[argument], from = webOf[incoming];
  if (into == from)
    return;
  const bool haveNames = !webs[into].name.isEmpty() && !webs[from].name.isEmpty();
  bool meet = argument.getType() != incoming.getType() ||
              (haveNames && !(webs[into].name == webs[from].name));
  for (Value a : webs[into].members)
    for (Value b : webs[from].members)
      meet = meet || isLiveAfter(a, b) || isLiveAfter(b, a);
  if (meet)
    return;
  for (Value member : webs[from].members) {
    webOf[member] = into;
    webs[into].members.push_back(member);
  }
  if (webs[into].name.isEmpty())
    webs[into].name = webs[from].name;
  webs[from].members.clear();
}

void Variables::joinArguments() {
  for (Block &block : llvm::drop_begin(function.getBody()))
    for (mlir::BlockArgument argument : block.getArguments())
      for (Block *from : block.getPredecessors())
        join(argument, llvm::cast<mlir::cf::BranchOp>(from->getTerminator())
                           .getDestOperands()[argument.getArgNumber()]);
}

void Variables::makeVariables() {
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockBegin(&function.getBody().front());
  continuation::UniqueNames names;
  // Values that need no variable and were not joined remain values.
  for (Web &web : webs) {
    if (web.members.size() == 1 && !needsVariable(web.members.front())) {
      webOf.erase(web.members.front());
      continue;
    }
    if (web.members.empty())
      continue;
    const std::string name =
        web.name.isEmpty() ? continuation::sourceName(web.members.front()) : web.name.text;
    auto variable = ir::VarOp::create(builder, web.members.front().getLoc(), names.unique(name),
                                      web.members.front().getType());
    ir::attr::value.set(variable); // stores come before loads
    if (web.name.isOfShortCircuit)
      ir::attr::shortCircuit.set(variable);
    web.address = variable;
  }
}

Value Variables::load(Value member, mlir::Operation *before) {
  mlir::OpBuilder builder(before);
  return ir::LoadOp::create(builder, member.getLoc(), webs[webOf.lookup(member)].address);
}

/// Stores the operands of the branch, in parallel: every variable is read before it is overwritten.
void Variables::copyAlong(mlir::cf::BranchOp branch) {
  struct Copy {
    unsigned to;
    Value from;
  };
  llvm::SmallVector<Copy> copies;
  for (auto [argument, value] :
       llvm::zip(branch.getDest()->getArguments(), branch.getDestOperands()))
    if (!webOf.count(value) || webOf.lookup(value) != webOf.lookup(argument))
      copies.push_back({webOf.lookup(argument), value});
  auto reads = [&](const Copy &copy, unsigned web) {
    auto found = webOf.find(copy.from);
    return found != webOf.end() && found->second == web;
  };
  mlir::OpBuilder builder(branch);
  while (!copies.empty()) {
    auto *free = llvm::find_if(copies, [&](const Copy &copy) {
      return llvm::none_of(copies, [&](const Copy &other) { return reads(other, copy.to); });
    });
    if (free ==
        copies.end()) { // only cycles are left: save the value that the first one overwrites
      free = copies.begin();
      Value old = ir::LoadOp::create(builder, branch.getLoc(), webs[free->to].address);
      for (Copy &copy : copies)
        if (reads(copy, free->to))
          copy.from = old;
    }
    Value value = webOf.count(free->from) ? load(free->from, branch) : free->from;
    ir::StoreOp::create(builder, free->from.getLoc(), value, webs[free->to].address);
    copies.erase(free);
  }
}

void Variables::storeDefinitions() {
  for (auto [value, web] : webOf)
    if (mlir::Operation *op = value.getDefiningOp()) {
      mlir::OpBuilder builder(op->getContext());
      builder.setInsertionPointAfter(op);
      ir::StoreOp::create(builder, value.getLoc(), value, webs[web].address);
    }
}

void Variables::loadUses() {
  for (auto [value, web] : webOf) {
    llvm::SmallDenseMap<mlir::Operation *, Value> loaded; // by user, which may use it twice
    for (mlir::OpOperand &use : llvm::make_early_inc_range(value.getUses())) {
      mlir::Operation *user = use.getOwner();
      auto store = llvm::dyn_cast<ir::StoreOp>(user);
      if (store && store.getAddress() == webs[web].address && value.getDefiningOp())
        continue;
      Value &own = loaded[user];
      if (!own)
        own = load(value, user);
      use.set(own);
    }
  }
}

void Variables::run() {
  collect();
  joinArguments();
  makeVariables();
  llvm::SmallVector<mlir::cf::BranchOp> branches;
  function.walk([&](mlir::cf::BranchOp branch) {
    if (!branch.getDestOperands().empty())
      branches.push_back(branch);
  });
  for (mlir::cf::BranchOp branch : branches) {
    copyAlong(branch);
    branch.getDestOperandsMutable().clear();
  }
  storeDefinitions();
  loadUses();
  for (Block &block : llvm::drop_begin(function.getBody()))
    block.eraseArguments(0, block.getNumArguments());
}

} // namespace

void leaveSsa(FuncOp function, IsVisible isVisible) {
  repeatWhereUsed(function, isVisible);
  Variables(function, isVisible).run();
}

} // namespace rtsl::restructuring
