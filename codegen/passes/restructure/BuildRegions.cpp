//===- BuildRegions.cpp - branches to regions -----------------------------===//
//
// Walks the plan from the entry on. The code of a block is appended to the region under
// construction, then that of its successors, then that of the blocks in which these paths join:
//
//     ^a: A; cond_br %c, ^b, ^d          A
//     ^b: B; br ^d                ==>    rtsl.if %c { B }
//     ^d: D                              D
//
// A branch becomes nothing if its target follows anyway, `rtsl.continue` or `rtsl.break` if these
// lead to it. Otherwise the target is further out: a flag is set, control leaves the current
// construct, and the flag is tested after it:
//
//     %far = rtsl.var "left"
//     rtsl.loop do { ... rtsl.if %found { far = true; rtsl.break } ... }
//     rtsl.if %far { on to the target }
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/restructure/Steps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "llvm/ADT/MapVector.h"

namespace rtsl::restructuring {

using mlir::Block;
using mlir::Value;

namespace {

class Builder {
public:
  Builder(FuncOp function, const Plan &plan)
      : function(function), plan(plan), builder(function.getContext()) {}
  mlir::LogicalResult run();

private:
  /// A construct that control can leave with a flag.
  struct Level {
    enum Kind : std::uint8_t { Sequence, Loop, Switch } kind;
    Block *block;                               // the flags are declared in this block,
    mlir::Operation *after;                     // after this operation; null: at the beginning
    llvm::MapVector<Block *, Value> flags = {}; // by target
    bool isLeft = false;                        // a loop: left by `rtsl.break` without a flag
  };
  /// The targets of jumps at a point.
  struct Context {
    Block *next = nullptr;    // target of the end of the region
    Block *header = nullptr;  // `rtsl.continue`
    Block *breakTo = nullptr; // `rtsl.break`
    Level *level = nullptr;   // the innermost
    Level *loop = nullptr;    // the innermost that is a loop
  };
  using Part = llvm::function_ref<bool(Block *at, const Context &)>;

  // Each of these appends code to `at`. True: control may reach the end, and then continues at
  // context.next; false: the last operation is a terminator.
  bool putBlock(Block *block, Block *at, const Context &context);
  bool putLoop(Block *header, Block *at, const Context &context);
  bool putBody(Block *block, Block *at, const Context &context);
  bool putSequence(Part first, llvm::ArrayRef<Block *> rest, Block *at, const Context &context);
  bool putFlagged(llvm::ArrayRef<std::pair<Block *, Value>> flags, Part otherwise, Block *at,
                  const Context &context);
  bool putTerminator(mlir::Operation *terminator, Block *at, const Context &context);
  bool putChoice(mlir::cf::CondBranchOp branch, Block *at, const Context &context);
  bool putSwitch(mlir::cf::SwitchOp choice, Block *at, const Context &context);
  bool putEdge(Block *target, Block *at, const Context &context);
  bool putJump(Block *target, Block *at, const Context &context);
  bool putUnreachable(Block *at);
  bool putIf(ir::IfOp choice, bool thenIsOpen, bool elseIsOpen, Block *at);
  void dropUntestedFlags();

  Level open(Level::Kind kind, Block *at) {
    return {kind, at, at->empty() ? nullptr : &at->back()};
  }
  template <typename Op, typename... Args>
  Op put(Block *at, Args &&...args) {
    builder.setInsertionPointToEnd(at);
    return Op::create(builder, location, std::forward<Args>(args)...);
  }

  FuncOp function;
  const Plan &plan;
  mlir::OpBuilder builder;
  mlir::Location location = builder.getUnknownLoc();
  llvm::DenseSet<Block *> insideOf; // headers of the loops whose bodies are under construction
  llvm::SmallVector<ir::VarOp> allFlags;
  bool failed = false;
};

//===----------------------------------------------------------------------===//
// Jumps
//===----------------------------------------------------------------------===//

bool Builder::putJump(Block *target, Block *at, const Context &context) {
  if (target == context.next)
    return true;
  if (target == context.header) {
    put<ir::ContinueOp>(at);
    return false;
  }
  if (target == context.breakTo) {
    context.loop->isLeft = true;
    put<ir::BreakOp>(at);
    return false;
  }
  Level &level = *context.level;
  Value &flag = level.flags[target];
  if (!flag) {
    if (level.after)
      builder.setInsertionPointAfter(level.after);
    else
      builder.setInsertionPointToStart(level.block);
    allFlags.push_back(ir::VarOp::create(builder, location, "left", builder.getI1Type()));
    flag = allFlags.back();
  }
  put<ir::StoreOp>(at, put<mlir::arith::ConstantOp>(at, builder.getBoolAttr(true)), flag);
  if (level.kind != Level::Loop)
    return true;
  put<ir::BreakOp>(at);
  return false;
}

bool Builder::putEdge(Block *target, Block *at, const Context &context) {
  const bool goesBack = insideOf.contains(target);
  return plan.isInline(target) && !goesBack ? putBlock(target, at, context)
                                            : putJump(target, at, context);
}

/// Ends a region after a loop that is never left.
bool Builder::putUnreachable(Block *at) {
  llvm::SmallVector<Value> zeros;
  builder.setInsertionPointToEnd(at);
  for (mlir::Type type : function.getResultTypes())
    zeros.push_back(ir::createZero(builder, location, type));
  put<ir::ReturnOp>(at, zeros);
  return false;
}

//===----------------------------------------------------------------------===//
// Choices
//===----------------------------------------------------------------------===//

/// Completes an `rtsl.if` whose arms are complete. After an arm that leaves, the other one needs no
/// region: it follows.
bool Builder::putIf(ir::IfOp choice, bool thenIsOpen, bool elseIsOpen, Block *at) {
  Block *thenBlock = &choice.getThenRegion().front(), *elseBlock = &choice.getElseRegion().front();
  const bool isOnlyElse = thenBlock->empty() && !elseBlock->empty();
  if (thenIsOpen && (!elseIsOpen || isOnlyElse)) {
    builder.setInsertionPoint(choice);
    Value yes = mlir::arith::ConstantOp::create(builder, location, builder.getBoolAttr(true));
    choice.getConditionMutable().assign(
        mlir::arith::XOrIOp::create(builder, location, choice.getCondition(), yes));
    thenBlock->moveBefore(elseBlock);
    elseBlock->moveBefore(&choice.getThenRegion(), choice.getThenRegion().end());
    std::swap(thenBlock, elseBlock);
    std::swap(thenIsOpen, elseIsOpen);
  }
  if (!thenIsOpen) {
    at->getOperations().splice(at->end(), elseBlock->getOperations());
    elseBlock->erase();
    return elseIsOpen;
  }
  put<ir::YieldOp>(thenBlock);
  if (elseBlock->empty())
    elseBlock->erase();
  else
    put<ir::YieldOp>(elseBlock);
  if (thenBlock->getOperations().size() == 1)
    choice.erase();
  return true;
}

bool Builder::putChoice(mlir::cf::CondBranchOp branch, Block *at, const Context &context) {
  if (branch.getTrueDest() == branch.getFalseDest())
    return putEdge(branch.getTrueDest(), at, context);
  auto choice = put<ir::IfOp>(at, branch.getCondition());
  Block *thenBlock = &choice.getThenRegion().emplaceBlock();
  Block *elseBlock = &choice.getElseRegion().emplaceBlock();
  const bool thenIsOpen = putEdge(branch.getTrueDest(), thenBlock, context);
  const bool elseIsOpen = putEdge(branch.getFalseDest(), elseBlock, context);
  return putIf(choice, thenIsOpen, elseIsOpen, at);
}

bool Builder::putSwitch(mlir::cf::SwitchOp choice, Block *at, const Context &context) {
  llvm::MapVector<Block *, llvm::SmallVector<int32_t>> targets;
  if (choice.getCaseValues())
    for (auto [value, target] :
         llvm::zip(choice.getCaseValues()->getValues<llvm::APInt>(), choice.getCaseDestinations()))
      targets[target].push_back(static_cast<int32_t>(value.getSExtValue()));
  const bool hasDefault = choice.getDefaultDestination() != context.next;
  if (hasDefault)
    targets[choice.getDefaultDestination()];

  std::optional<unsigned> defaultArm;
  llvm::SmallVector<llvm::SmallVector<int32_t>> values;
  for (auto &[target, ofTarget] : targets) {
    if (target == choice.getDefaultDestination())
      defaultArm = values.size();
    values.push_back(ofTarget);
  }
  Level level = open(Level::Switch, at);
  auto arms = put<ir::SwitchOp>(at, choice.getFlag(), values, defaultArm);
  Context inside = context;
  inside.level = &level;
  inside.breakTo = nullptr; // `rtsl.break` leaves the switch
  bool isOpen = !defaultArm;
  for (auto [entry, arm] : llvm::zip(targets, arms.getArms())) {
    if (!putEdge(entry.first, &arm.front(), inside))
      continue;
    put<ir::BreakOp>(&arm.front());
    isOpen = true;
  }
  if (!isOpen)
    return putUnreachable(at);
  return putFlagged(
      llvm::to_vector(level.flags), [](Block *, const Context &) { return true; }, at, context);
}

/// Tests flags one after the other; if none is set, continues with `otherwise`.
bool Builder::putFlagged(llvm::ArrayRef<std::pair<Block *, Value>> flags, Part otherwise, Block *at,
                         const Context &context) {
  if (flags.empty())
    return otherwise(at, context);
  auto [target, flag] = flags.front();
  auto choice = put<ir::IfOp>(at, put<ir::LoadOp>(at, flag));
  Block *thenBlock = &choice.getThenRegion().emplaceBlock();
  Block *elseBlock = &choice.getElseRegion().emplaceBlock();
  const bool thenIsOpen = putJump(target, thenBlock, context);
  const bool elseIsOpen = putFlagged(flags.drop_front(), otherwise, elseBlock, context);
  return putIf(choice, thenIsOpen, elseIsOpen, at);
}

//===----------------------------------------------------------------------===//
// Blocks
//===----------------------------------------------------------------------===//

bool Builder::putBlock(Block *block, Block *at, const Context &context) {
  if (!plan.isLoopHeader(block))
    return putBody(block, at, context);
  return putSequence(
      [&](Block *into, const Context &around) { return putLoop(block, into, around); },
      plan.followingLoop(block), at, context);
}

bool Builder::putLoop(Block *header, Block *at, const Context &context) {
  const Plan::Exit exit = plan.exitOf(header);
  Level level = open(Level::Loop, at);
  location = header->front().getLoc();
  auto loop = put<ir::LoopOp>(at, /*postTest=*/false);
  Block *body = &loop.getBody().emplaceBlock();
  Context inside = {header, header, exit.target, &level, &level};
  insideOf.insert(header);
  if (putBody(header, body, inside))
    put<ir::YieldOp>(body);
  insideOf.erase(header);

  if (!level.isLeft && level.flags.empty())
    return putUnreachable(at);
  if (level.isLeft)
    return putFlagged(
        llvm::to_vector(level.flags),
        [&](Block *into, const Context &around) {
          return exit.followsLoop ? putBlock(exit.target, into, around)
                                  : putJump(exit.target, into, around);
        },
        at, context);
  // The last exit with a flag needs no test: there is no other one.
  Block *last = level.flags.back().first;
  level.flags.pop_back();
  return putFlagged(
      llvm::to_vector(level.flags),
      [&](Block *into, const Context &around) { return putJump(last, into, around); }, at, context);
}

bool Builder::putBody(Block *block, Block *at, const Context &context) {
  mlir::Operation *terminator = block->getTerminator();
  at->getOperations().splice(at->end(), block->getOperations(), block->begin(),
                             terminator->getIterator());
  return putSequence(
      [&](Block *into, const Context &around) { return putTerminator(terminator, into, around); },
      plan.following(block), at, context);
}

/// `first`, whose paths join in the first block of `rest`, and then the others.
bool Builder::putSequence(Part first, llvm::ArrayRef<Block *> rest, Block *at,
                          const Context &context) {
  if (rest.empty())
    return first(at, context);
  Level level = open(Level::Sequence, at);
  Context inside = context;
  inside.next = rest.front();
  inside.level = &level;
  if (!first(at, inside)) {
    failed = true; // in the plan the paths join in this block
    return false;
  }
  return putSequence(
      [&](Block *into, const Context &around) {
        return putFlagged(
            llvm::to_vector(level.flags),
            [&](Block *inner, const Context &there) {
              return putBlock(rest.front(), inner, there);
            },
            into, around);
      },
      rest.drop_front(), at, context);
}

bool Builder::putTerminator(mlir::Operation *terminator, Block *at, const Context &context) {
  location = terminator->getLoc();
  if (auto branch = llvm::dyn_cast<mlir::cf::BranchOp>(terminator))
    return putEdge(branch.getDest(), at, context);
  if (auto branch = llvm::dyn_cast<mlir::cf::CondBranchOp>(terminator))
    return putChoice(branch, at, context);
  if (auto choice = llvm::dyn_cast<mlir::cf::SwitchOp>(terminator))
    return putSwitch(choice, at, context);
  if (llvm::isa<ir::EndOp, mlir::func::ReturnOp>(terminator)) {
    put<ir::ReturnOp>(at, terminator->getOperands());
    return false;
  }
  terminator->emitError() << "`" << terminator->getName()
                          << "` cannot become structured control flow";
  failed = true;
  return putUnreachable(at);
}

/// A flag is not tested if the loop has no other exit, or if both targets are the same.
void Builder::dropUntestedFlags() {
  llvm::erase_if(allFlags, [](ir::VarOp flag) {
    if (llvm::any_of(flag->getUsers(), [](mlir::Operation *user) {
          return !llvm::isa<ir::StoreOp>(user) && !user->use_empty();
        }))
      return false;
    for (mlir::Operation *user : llvm::make_early_inc_range(flag->getUsers())) {
      auto store = llvm::dyn_cast<ir::StoreOp>(user);
      mlir::Operation *value = store ? store.getValue().getDefiningOp() : nullptr;
      user->erase();
      if (value)
        value->erase();
    }
    flag.erase();
    return true;
  });
}

mlir::LogicalResult Builder::run() {
  mlir::Region &body = function.getBody();
  llvm::SmallVector<Block *> old;
  for (Block &block : body)
    old.push_back(&block);
  Block *whole = new Block;
  whole->insertBefore(old.front());
  for (mlir::BlockArgument argument : old.front()->getArguments())
    argument.replaceAllUsesWith(whole->addArgument(argument.getType(), argument.getLoc()));
  if (putBlock(old.front(), whole, {}))
    putUnreachable(whole);
  for (Block *block : old)
    block->dropAllDefinedValueUses();
  for (Block *block : old)
    block->erase();
  dropUntestedFlags();
  joinFlags(allFlags);
  return mlir::failure(failed);
}

} // namespace

mlir::LogicalResult buildRegions(FuncOp function, const Plan &plan) {
  return Builder(function, plan).run();
}

} // namespace rtsl::restructuring
