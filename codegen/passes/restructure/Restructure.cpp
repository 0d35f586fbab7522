//===- Restructure.cpp - blocks and branches to structured control flow ---===//
#include "codegen/passes/restructure/Restructure.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/MemoryAccesses.h"

#include "codegen/passes/restructure/Steps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/IR/Iterators.h"
#include "mlir/IR/Matchers.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "mlir/Pass/Pass.h"
#include "mlir/Pass/PassRegistry.h"

namespace rtsl {

using namespace restructuring;
using mlir::Block;

namespace {

/// Does an expression that is stored to a variable, its first operand, change only that variable?
bool changesNothingElse(mlir::Operation *evaluation) {
  auto changed = ir::attr::changes.of(evaluation);
  return !changed || (changed.size() == 1 && changed[0] == 0);
}

/// Erases flags that are set but never tested.
void dropUnreadVariables(FuncOp function) {
  llvm::SmallVector<ir::VarOp> variables;
  function.walk([&](ir::VarOp variable) { variables.push_back(variable); });
  for (ir::VarOp variable : variables) {
    auto isWrite = [&](mlir::Operation *user) {
      auto store = llvm::dyn_cast<ir::StoreOp>(user);
      const bool isAllOfIt = llvm::isa<ir::EvaluateOp>(user) && ir::attr::into.isOn(user) &&
                             ir::attr::plain.isOn(user) &&
                             llvm::count(user->getOperands(), variable.getResult()) == 1 &&
                             user->getOperand(0) == variable.getResult() &&
                             changesNothingElse(user);
      return llvm::isa<ir::ClearOp>(user) || isAllOfIt ||
             (store && store.getAddress() == variable.getResult());
    };
    if (!llvm::all_of(variable->getUsers(), isWrite))
      continue;
    for (mlir::Operation *user : llvm::make_early_inc_range(variable->getUsers()))
      user->erase();
    variable.erase();
  }
}

/// The operation of `block` that is or contains `op`; null if there is none.
mlir::Operation *ancestorIn(Block *block, mlir::Operation *op) {
  while (op && op->getBlock() != block)
    op = op->getParentOp();
  return op;
}

/// Variables that were made of values move to the innermost region that has all their uses. So do
/// those of the source, if they are initialised there.
void placeVariables(FuncOp function) {
  for (auto variable : llvm::to_vector(function.getBody().front().getOps<ir::VarOp>())) {
    const bool isValue = ir::attr::value.isOn(variable);
    if (!isValue && !ir::attr::declared.isOn(variable))
      continue;
    ir::attr::value.removeFrom(variable);
    Block *common = nullptr;
    for (mlir::Operation *user : variable->getUsers()) {
      if (!common)
        common = user->getBlock();
      while (!ancestorIn(common, user))
        common = common->getParentOp()->getBlock();
    }
    mlir::Operation *first = nullptr;
    for (mlir::Operation *user : variable->getUsers())
      if (mlir::Operation *at = ancestorIn(common, user); !first || at->isBeforeInBlock(first))
        first = at;
    auto clear = llvm::dyn_cast_or_null<ir::ClearOp>(first);
    if (first && (isValue || (clear && clear.getAddress() == variable.getResult())))
      variable->moveBefore(first);
  }
}

/// rtsl.loop do { A; rtsl.if %c { rtsl.break }; B }  ==>  rtsl.loop cond { A; !c } do { B }
/// if B uses no value of A.
void findCondition(ir::LoopOp loop) {
  Block &body = loop.getBody().front();
  ir::IfOp exit;
  for (mlir::Operation &op : body)
    if ((exit = llvm::dyn_cast<ir::IfOp>(op)) || op.getNumRegions() != 0 ||
        llvm::isa<ir::VarOp>(op))
      break;
  if (!exit || !exit.getElseRegion().empty() ||
      !llvm::isa<ir::BreakOp>(exit.getThenRegion().front().front()))
    return;
  for (mlir::Operation &op : llvm::make_range(body.begin(), exit->getIterator()))
    for (mlir::Operation *user : op.getUsers())
      if (user->getBlock() != &body || exit->isBeforeInBlock(user))
        return;
  mlir::OpBuilder builder(exit);
  mlir::Value goesOn;
  auto inverse = exit.getCondition().getDefiningOp<mlir::arith::XOrIOp>();
  if (inverse && mlir::matchPattern(inverse.getRhs(), mlir::m_One())) {
    goesOn = inverse.getLhs();
  } else {
    mlir::Location location = exit.getLoc();
    mlir::Value yes = mlir::arith::ConstantOp::create(builder, location, builder.getBoolAttr(true));
    goesOn = mlir::arith::XOrIOp::create(builder, location, exit.getCondition(), yes);
  }
  ir::ConditionOp::create(builder, exit.getLoc(), goesOn);
  exit.erase();
  Block &condition = loop.getCondition().emplaceBlock();
  auto end = llvm::find_if(body, llvm::IsaPred<ir::ConditionOp>);
  condition.getOperations().splice(condition.end(), body.getOperations(), body.begin(),
                                   std::next(end));
}

/// Erases values that only branches used.
void dropDeadCode(FuncOp function) {
  function.walk<mlir::WalkOrder::PostOrder, mlir::ReverseIterator>([](mlir::Operation *op) {
    auto evaluation = llvm::dyn_cast<ir::EvaluateOp>(op);
    const bool isUnread = evaluation && op->use_empty() && ir::changesNothing(evaluation);
    if (isUnread || mlir::isOpTriviallyDead(op))
      op->erase();
  });
}

} // namespace

mlir::LogicalResult restructure(FuncOp function) {
  if (function.isExternal())
    return mlir::success();
  splitEdges(function);
  makeReducible(function);
  leaveSsa(function, [plan = Plan(function)](mlir::Value value, Block *use) {
    return plan.isVisible(value.getParentBlock(), use);
  });
  if (mlir::failed(buildRegions(function, Plan(function))))
    return mlir::failure();
  dropDeadCode(function);
  dropUnreadVariables(function);
  placeVariables(function);
  function.walk([](ir::LoopOp loop) { findCondition(loop); });
  dropDeadCode(function);
  return mlir::success();
}

mlir::LogicalResult restructure(mlir::ModuleOp module) {
  for (FuncOp function : module.getOps<FuncOp>())
    if (mlir::failed(restructure(function)))
      return mlir::failure();
  return mlir::success();
}

namespace {

struct RestructurePass : mlir::PassWrapper<RestructurePass, mlir::OperationPass<FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(RestructurePass)
  llvm::StringRef getArgument() const override { return "rtsl-restructure"; }
  llvm::StringRef getDescription() const override {
    return "turns blocks and branches into structured control flow";
  }
  void getDependentDialects(mlir::DialectRegistry &registry) const override {
    registry.insert<ir::RtslDialect>();
  }
  void runOnOperation() override {
    if (mlir::failed(restructure(getOperation())))
      signalPassFailure();
  }
};

} // namespace

void registerRestructurePass() {
  mlir::PassRegistration<RestructurePass>();
}

} // namespace rtsl
