#include "codegen/cpp/errors/HitErrorWriter.h"

#include "llvm/ADT/TypeSwitch.h"

namespace rtsl::cpp {

std::optional<Statements> HitErrorWriter::body(mlir::func::FuncOp function) {
  Statements statements = write(function.getBody());
  return hasFailed ? std::nullopt : std::optional(std::move(statements));
}

Statements HitErrorWriter::write(mlir::Region &region) {
  Statements statements;
  if (!region.empty())
    for (mlir::Operation &op : region.front())
      write(op, statements);
  return statements;
}

void HitErrorWriter::write(mlir::Operation &op, Statements &out) {
  if (op.hasTrait<mlir::OpTrait::ConstantLike>()) // printed where it is used
    return;
  const bool isKnown = writeMemory(op, out) || writeOperator(op, out) || writeConversion(op, out) ||
                       writeFunction(op, out) || writeVector(op, out) || writeControl(op, out);
  hasFailed |= !isKnown;
}

/// `if (!condition) break;`
static Statement breakUnless(Code condition) {
  return branch(std::move(condition), {simple(StatementKind::Break)});
}

bool HitErrorWriter::writeControl(mlir::Operation &op, Statements &out) {
  bool isKnown = true;
  llvm::TypeSwitch<mlir::Operation *>(&op)
      .Case<ir::YieldOp>([](auto) {})
      .Case([&](ir::IfOp choice) {
        const Code condition = whole(choice.getCondition());
        Statement made = branch(condition, write(choice.getThenRegion()), /*hasBraces=*/true);
        made.otherwise = write(choice.getElseRegion());
        made.otherwiseHasBraces = !choice.getElseRegion().empty();
        out.push_back(std::move(made));
      })
      .Case([&](ir::LoopOp op) { out.push_back(loop(op)); })
      .Case([&](ir::SwitchOp choice) { out.push_back(switchOver(choice)); })
      .Case([&](ir::ConditionOp end) {
        out.push_back(breakUnless(unary(UnaryOperator::Not, whole(end.getCondition()))));
      })
      .Case([&](ir::BreakOp) { out.push_back(simple(StatementKind::Break)); })
      .Case([&](ir::ContinueOp) { out.push_back(simple(StatementKind::Continue)); })
      .Case<ir::ReturnOp, mlir::func::ReturnOp>([&](auto) {
        if (!llvm::isa<mlir::func::FuncOp>(op.getParentOp()))
          out.push_back(returning());
      })
      .Default([&](mlir::Operation *) { isKnown = false; });
  return isKnown;
}

/// A loop with a step, or whose condition follows its body:
///
///   for (bool isFirst = true;; isFirst = false) {
///     if (!isFirst) { step }
///     if (!isFirst && !condition) break;   // or `if (!condition) break;` where it comes first
///     body
///   }
///
/// `continue` goes to the step in the IR, so that stands at the beginning of the next iteration.
Statement HitErrorWriter::loop(ir::LoopOp op) {
  Statement made = simple(StatementKind::For);
  made.hasBraces = true;
  const bool hasStep = !op.getStep().empty() && op.getStep().front().getOperations().size() > 1;
  if (hasStep || op.getPostTest()) {
    const std::string own = unique("isFirst", taken);
    const Code isFirst = name(own), isLater = unary(UnaryOperator::Not, isFirst);
    made.init = {declaration("bool", own, boolean(true))};
    made.step = assign(isFirst, boolean(false));
    made.body = {branch(isLater, write(op.getStep()), /*hasBraces=*/true)};
    if (op.getPostTest() && !op.getCondition().empty()) {
      // The values of the condition are used in its own region alone; its `break` leaves the loop.
      mlir::Block &block = op.getCondition().front();
      auto end = llvm::cast<ir::ConditionOp>(block.getTerminator());
      for (mlir::Operation &inner : block.without_terminator())
        write(inner, made.body);
      const Code ends = unary(UnaryOperator::Not, whole(end.getCondition()));
      made.body.push_back(breakUnless(binary(Operator::And, isLater, ends)));
    }
  }
  if (!op.getPostTest())
    append(made.body, write(op.getCondition()));
  append(made.body, write(op.getBody()));
  return made;
}

Statement HitErrorWriter::switchOver(ir::SwitchOp op) {
  Statement made = simple(StatementKind::Switch);
  made.value = whole(op.getValue());
  const auto count = static_cast<unsigned>(op.getArms().size());
  for (unsigned i = 0; i < count; ++i) {
    mlir::Region &region = op.getArms()[i];
    Arm arm;
    for (std::int32_t value : op.armValues(i))
      arm.labels.push_back(integer(value));
    arm.isDefault = op.getDefaultArm() && *op.getDefaultArm() == i;
    arm.body = {block(write(region))};
    if (llvm::isa<ir::YieldOp>(region.front().getTerminator()))
      arm.body.push_back(simple(i + 1 < count ? StatementKind::Fallthrough : StatementKind::Break));
    made.arms.push_back(std::move(arm));
  }
  return made;
}

} // namespace rtsl::cpp
