//===- LowerStmts.cpp - statements ----------------------------------------===//
#include "codegen/lower/Lowering.h"
#include "language/formulas/Common.h"
#include "language/formulas/Elementary.h"

#include "sema/typed/Casting.h"

namespace rtsl::lowering {

using ast::StmtKind;

void FunctionLowering::lowerAll(const std::vector<typed::StmtPtr> &body) {
  for (const typed::StmtPtr &stmt : body) {
    if (emitter.isTerminated())
      return; // code after a return, break or continue never runs
    lower(stmt);
  }
}

void FunctionLowering::lower(const typed::Stmt &stmt) {
  emitter.setLoc(module.location(stmt.range));
  switch (stmt.kind) {
  case StmtKind::Compound:
    return lowerAll(cast<typed::CompoundStmt>(stmt).body);
  case StmtKind::Declaration:
    for (const typed::Variable *variable : cast<typed::DeclarationStmt>(stmt).variables)
      lowerDeclaration(*variable);
    return;
  case StmtKind::Expression:
    if (auto *builtin = dynCast<typed::BuiltinExpr>(cast<typed::ExpressionStmt>(stmt).expr.get());
        builtin && has(builtin->builtin, typed::effect::EndsHit)) {
      emitter.setLoc(module.location(builtin->range));
      return answerHit(builtin->builtin);
    }
    lowerDiscarded(*cast<typed::ExpressionStmt>(stmt).expr);
    return;
  case StmtKind::If:
    return lowerIf(cast<typed::IfStmt>(stmt));
  case StmtKind::For: {
    const auto &loop = cast<typed::ForStmt>(stmt);
    lower(loop.init);
    emitter.setLoc(module.location(stmt.range));
    return lowerLoop(loop.condition.get(), *loop.body, loop.step.get(), false);
  }
  case StmtKind::While: {
    const auto &loop = cast<typed::WhileStmt>(stmt);
    return lowerLoop(loop.condition.get(), *loop.body, nullptr, false);
  }
  case StmtKind::DoWhile: {
    const auto &loop = cast<typed::DoWhileStmt>(stmt);
    return lowerLoop(loop.condition.get(), *loop.body, nullptr, true);
  }
  case StmtKind::Switch:
    return lowerSwitch(cast<typed::SwitchStmt>(stmt));
  case StmtKind::Break:
    emitter.make<ir::BreakOp>();
    return;
  case StmtKind::Continue:
    emitter.make<ir::ContinueOp>();
    return;
  case StmtKind::Return:
    return emitReturn(cast<typed::ReturnStmt>(stmt).value.get());
  case StmtKind::Illuminance:
    return lowerIlluminance(cast<typed::IlluminanceStmt>(stmt));
  case StmtKind::Case: // only in the syntax tree
  case StmtKind::Empty:
    return;
  }
}

void FunctionLowering::lowerDeclaration(const typed::Variable &variable) {
  emitter.setLoc(module.location(variable.range));
  Value address = variables.lookup(&variable).address;
  if (!address && variable.isConst && variable.init)
    if (Value constant = tableOf(*variable.init, variable.name)) {
      variables[&variable].address = constant;
      return;
    }
  if (!address && module.options.source && isNamedMatrix(variable))
    return;
  if (!address)
    address = variables[&variable].address = variableOf(variable.name, variable.type);
  if (variable.init)
    lowerInto(*variable.init, address);
}

void FunctionLowering::lowerIf(const typed::IfStmt &stmt) {
  Value condition = value(*stmt.condition);
  emitter.setLoc(module.location(stmt.range));
  auto then = [&] { lower(stmt.thenStmt); };
  auto otherwise = [&] { lower(stmt.elseStmt); };
  if (stmt.elseStmt)
    emitter.ifThen(condition, then, otherwise);
  else
    emitter.ifThen(condition, then);
}

void FunctionLowering::lowerLoop(const typed::Expr *condition, const typed::Stmt &body,
                                 const typed::Expr *step, bool testAfter) {
  auto test = [&]() -> Value { return value(*condition); };
  auto run = [&] { lower(body); };
  auto advance = [&] {
    emitter.setLoc(module.location(step->range));
    lowerDiscarded(*step);
  };
  mlir::Location location = emitter.getLoc();
  llvm::function_ref<Value()> noTest = nullptr;
  Emitter::Block noStep = nullptr;
  emitter.loop(testAfter, condition ? llvm::function_ref<Value()>(test) : noTest, run,
               step ? Emitter::Block(advance) : noStep);
  emitter.setLoc(location);
}

// A variable declared in one arm is in scope in the next, which control may enter directly: such
// variables are declared before the switch.
void FunctionLowering::lowerSwitch(const typed::SwitchStmt &stmt) {
  Value selector = value(*stmt.value);
  std::vector<Emitter::Arm> arms;
  for (const auto &arm : stmt.arms) {
    for (const typed::StmtPtr &inner : arm.body)
      if (auto *declaration = dynCast<typed::DeclarationStmt>(inner))
        for (const typed::Variable *variable : declaration->variables) {
          emitter.setLoc(module.location(variable->range));
          variables[variable].address = variableOf(variable->name, variable->type);
        }
    arms.push_back({arm.values, arm.isDefault, [this, &arm] { lowerAll(arm.body); }});
  }
  emitter.setLoc(module.location(stmt.range));
  emitter.switchOver(selector, arms);
}

// The angle is between 0 and pi: pi or more includes every light.
void FunctionLowering::lowerIlluminance(const typed::IlluminanceStmt &stmt) {
  Value point = value(*stmt.point);
  Value normal, cosAngle;
  if (stmt.normal && stmt.angle) {
    normal = value(*stmt.normal);
    if (module.options.source)
      cosAngle = wholeExpression(SourceTable::Kind::AngleCosine, *stmt.angle, {stmt.angle.get()},
                                 value(*stmt.angle), emitter.getF32Type());
  }
  if (stmt.normal && stmt.angle && !module.options.source) {
    Num angle = number(*stmt.angle);
    constexpr double pi = 3.14159265358979323846;
    cosAngle = formulas::cos(formulas::clamp(angle, angle.like(0), angle.like(pi)));
  }
  emitter.setLoc(module.location(stmt.range));
  emitter.illuminance(point, normal, cosAngle, [&] { lower(stmt.body); });
}

} // namespace rtsl::lowering
