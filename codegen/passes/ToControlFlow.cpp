//===- ToControlFlow.cpp - structured control flow to branches ------------===//
#include "codegen/passes/ToControlFlow.h"

#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/PatternMatch.h"
#include "mlir/Pass/Pass.h"
#include "mlir/Transforms/RegionUtils.h"

namespace rtsl::codegen {

using mlir::Block;
using mlir::Location;
using mlir::OpBuilder;
using mlir::Region;
using mlir::Value;
namespace cf = mlir::cf;

namespace {

/// The targets of jumps in a region.
struct Targets {
  Block *onYield = nullptr;
  Block *onBreak = nullptr;
  Block *onContinue = nullptr;
  Block *onFalse = nullptr; // for a false `rtsl.condition`; a true one continues like a yield
};

class Lowering {
public:
  explicit Lowering(OpBuilder builder) : builder(builder) {}
  void lowerBlock(Block *block, const Targets &targets);

private:
  Block *lowerRegion(Region &region, const Targets &targets, Block *before);
  void lower(ir::IfOp op, const Targets &targets, Block *rest);
  void lower(ir::LoopOp op, const Targets &targets, Block *rest);
  void lower(ir::SwitchOp op, const Targets &targets, Block *rest);
  void lower(ir::IlluminanceOp op, const Targets &targets, Block *rest);
  void lowerTerminator(mlir::Operation *terminator, const Targets &targets);

  OpBuilder builder;
};

/// Moves the one block of `region` in front of `before` and lowers it. Returns it.
Block *Lowering::lowerRegion(Region &region, const Targets &targets, Block *before) {
  Block *block = &region.front();
  block->moveBefore(before);
  lowerBlock(block, targets);
  return block;
}

//     block              block: cond_br c, then, else
//     rtsl.if c    -->   then:  ... br rest
//     ...                else:  ... br rest
//                        rest:  ...
void Lowering::lower(ir::IfOp op, const Targets &targets, Block *rest) {
  Targets inside = targets;
  inside.onYield = rest;
  Block *block = op->getBlock();
  Block *thenBlock = lowerRegion(op.getThenRegion(), inside, rest);
  Block *elseBlock =
      op.getElseRegion().empty() ? rest : lowerRegion(op.getElseRegion(), inside, rest);
  builder.setInsertionPointToEnd(block);
  cf::CondBranchOp::create(builder, op.getLoc(), op.getCondition(), thenBlock, elseBlock);
}

//     block: br cond (post_test: br body)
//     cond:  ... cond_br c, body, rest
//     body:  ... br step           continue -> step, break -> rest
//     step:  ... br cond
//     rest:  ...
// Without `step`, "step" is "cond"; without `cond`, "cond" is "body".
void Lowering::lower(ir::LoopOp op, const Targets &targets, Block *rest) {
  Block *block = op->getBlock();
  Block *body = &op.getBody().front();
  Block *cond = op.getCondition().empty() ? body : &op.getCondition().front();
  Block *step = op.getStep().empty() ? cond : &op.getStep().front();
  bool bodyFirst = op.getPostTest();

  if (cond != body)
    lowerRegion(op.getCondition(), {/*onYield=*/body, nullptr, nullptr, /*onFalse=*/rest}, rest);
  lowerRegion(op.getBody(), {/*onYield=*/step, /*onBreak=*/rest, /*onContinue=*/step, nullptr},
              bodyFirst && cond != body ? cond : rest);
  if (step != cond)
    lowerRegion(op.getStep(), {/*onYield=*/cond, nullptr, nullptr, nullptr},
                bodyFirst && cond != body ? cond : rest);
  builder.setInsertionPointToEnd(block);
  cf::BranchOp::create(builder, op.getLoc(), bodyFirst ? body : cond);
}

//     block: switch v, default: d, 1: arm1, ...
//     arm1:  ... br arm2           an arm falls into the next; break -> rest
//     arm2:  ... br rest
//     rest:  ...
void Lowering::lower(ir::SwitchOp op, const Targets &targets, Block *rest) {
  Block *block = op->getBlock();
  llvm::SmallVector<Block *> arms;
  for (Region &arm : op.getArms())
    arms.push_back(&arm.front());

  llvm::SmallVector<int32_t> values;
  llvm::SmallVector<Block *> destinations;
  for (auto [index, arm] : llvm::enumerate(op.getArms())) {
    for (int32_t value : op.armValues(index)) {
      values.push_back(value);
      destinations.push_back(arms[index]);
    }
    Targets inside = targets;
    inside.onYield = index + 1 < arms.size() ? arms[index + 1] : rest;
    inside.onBreak = rest;
    lowerRegion(arm, inside, rest);
  }
  Block *otherwise = op.getDefaultArm() ? arms[*op.getDefaultArm()] : rest;

  builder.setInsertionPointToEnd(block);
  if (values.empty()) {
    cf::BranchOp::create(builder, op.getLoc(), otherwise);
    return;
  }
  llvm::SmallVector<mlir::ValueRange> noOperands(destinations.size());
  cf::SwitchOp::create(builder, op.getLoc(), op.getValue(), otherwise, mlir::ValueRange(),
                       llvm::ArrayRef<int32_t>(values), destinations, noOperands);
}

//     block: n = light_count; br cond(0)
//     cond(i):  cond_br i < n, test, rest
//     test:  lit = illuminate i, P; cond_br lit, body, step
//     body:  ... br step           continue -> step, break -> rest
//     step:  br cond(i + 1)
//     rest:  ...
void Lowering::lower(ir::IlluminanceOp op, const Targets &targets, Block *rest) {
  Location location = op.getLoc();
  Block *block = op->getBlock();
  mlir::Type i32 = builder.getI32Type();

  builder.setInsertionPointToEnd(block);
  Value count = ir::LightCountOp::create(builder, location, i32);
  Value zero = mlir::arith::ConstantOp::create(builder, location, builder.getI32IntegerAttr(0));
  Value one = mlir::arith::ConstantOp::create(builder, location, builder.getI32IntegerAttr(1));
  const Location named = mlir::NameLoc::get(builder.getStringAttr("lightIndex"), location);
  Block *cond = builder.createBlock(rest, {i32}, {named});
  Block *test = builder.createBlock(rest);
  Block *step = builder.createBlock(rest);
  Block *body = lowerRegion(
      op.getBody(), {/*onYield=*/step, /*onBreak=*/rest, /*onContinue=*/step, nullptr}, step);
  Value index = cond->getArgument(0);

  builder.setInsertionPointToEnd(block);
  cf::BranchOp::create(builder, location, cond, mlir::ValueRange(zero));

  builder.setInsertionPointToEnd(cond);
  Value more =
      mlir::arith::CmpIOp::create(builder, location, mlir::arith::CmpIPredicate::ult, index, count);
  cf::CondBranchOp::create(builder, location, more, test, rest);

  builder.setInsertionPointToEnd(test);
  Value lit = ir::IlluminateOp::create(builder, location, builder.getI1Type(), index, op.getPoint(),
                                       op.getNormal(), op.getCosAngle());
  cf::CondBranchOp::create(builder, location, lit, body, step);

  builder.setInsertionPointToEnd(step);
  Value next = mlir::arith::AddIOp::create(builder, location, index, one);
  cf::BranchOp::create(builder, location, cond, mlir::ValueRange(next));
}

void Lowering::lowerTerminator(mlir::Operation *terminator, const Targets &targets) {
  builder.setInsertionPoint(terminator);
  Location location = terminator->getLoc();
  if (llvm::isa<ir::YieldOp>(terminator))
    cf::BranchOp::create(builder, location, targets.onYield);
  else if (llvm::isa<ir::BreakOp>(terminator))
    cf::BranchOp::create(builder, location, targets.onBreak);
  else if (llvm::isa<ir::ContinueOp>(terminator))
    cf::BranchOp::create(builder, location, targets.onContinue);
  else if (auto condition = llvm::dyn_cast<ir::ConditionOp>(terminator))
    cf::CondBranchOp::create(builder, location, condition.getCondition(), targets.onYield,
                             targets.onFalse);
  else if (auto returnOp = llvm::dyn_cast<ir::ReturnOp>(terminator))
    mlir::func::ReturnOp::create(builder, location, returnOp.getValues());
  else
    return; // already on level 2
  terminator->erase();
}

/// Lowers everything in `block`, which is split after each structured op; the last part gets the
/// terminator.
void Lowering::lowerBlock(Block *block, const Targets &targets) {
  for (auto next = block->begin(); next != block->end();) {
    mlir::Operation *op = &*next++;
    if (!llvm::isa<ir::IfOp, ir::LoopOp, ir::SwitchOp, ir::IlluminanceOp>(op))
      continue;
    Block *rest = block->splitBlock(next);
    if (auto ifOp = llvm::dyn_cast<ir::IfOp>(op))
      lower(ifOp, targets, rest);
    else if (auto loop = llvm::dyn_cast<ir::LoopOp>(op))
      lower(loop, targets, rest);
    else if (auto switchOp = llvm::dyn_cast<ir::SwitchOp>(op))
      lower(switchOp, targets, rest);
    else
      lower(llvm::cast<ir::IlluminanceOp>(op), targets, rest);
    op->erase();
    block = rest;
    next = block->begin();
  }
  lowerTerminator(&block->back(), targets);
}

struct ToControlFlow : mlir::PassWrapper<ToControlFlow, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(ToControlFlow)
  llvm::StringRef getArgument() const override { return "rtsl-to-cf"; }
  llvm::StringRef getDescription() const override {
    return "replaces structured control flow by blocks and branches";
  }

  void runOnOperation() override {
    llvm::SmallVector<Block *> blocks;
    for (Block &block : getOperation().getBody())
      blocks.push_back(&block);
    Lowering lowering{OpBuilder(&getContext())};
    for (Block *block : blocks)
      lowering.lowerBlock(block, {});
    mlir::IRRewriter rewriter(&getContext());
    (void)mlir::eraseUnreachableBlocks(rewriter, getOperation()->getRegions());
  }
};

} // namespace

std::unique_ptr<mlir::Pass> createToControlFlowPass() {
  return std::make_unique<ToControlFlow>();
}

} // namespace rtsl::codegen
