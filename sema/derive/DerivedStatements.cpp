//===- DerivedStatements.cpp - statements with changes beside them --------===//
#include "sema/derive/DerivedBody.h"
#include "sema/model/Conversion.h"
#include "sema/typed/Walk.h"

#include <utility>

namespace rtsl::derive {

using namespace typed;
using ast::StmtKind;

template <typename T>
static std::unique_ptr<T> blank(const T &from) {
  auto made = std::make_unique<T>();
  made->range = from.range;
  made->comment = from.comment;
  return made;
}

static StmtPtr evaluation(ExprPtr expr, SourceRange range) {
  auto made = std::make_unique<ExpressionStmt>();
  made->range = range;
  made->expr = std::move(expr);
  return made;
}

/// One statement; several become a block.
StmtPtr DerivedBody::statement(const StmtPtr &one) {
  if (!one)
    return nullptr;
  std::vector<StmtPtr> made;
  statement(*one, made);
  if (made.size() == 1 && made.front()->kind != StmtKind::Declaration)
    return std::move(made.front());
  auto block = std::make_unique<CompoundStmt>();
  block->range = one->range;
  block->body = std::move(made);
  return block;
}

/// Where an expression writes variables as `out` arguments of functions that do not write their
/// changes: statements that set the changes of these variables to 0.
void DerivedBody::forgetWritten(const Expr &expr, std::vector<StmtPtr> &out) {
  const auto forget = [&](const Expr &place) {
    const Companions *written = companionsOf(place);
    for (Axis axis : axes)
      if (written && written->along[static_cast<int>(axis)]) {
        auto assign = makeExpr<AssignExpr>(place.type, place.range);
        assign->target = companionPlace(place, axis);
        assign->value = zero(place.type, place.range);
        out.push_back(evaluation(std::move(assign), place.range));
      }
  };
  const auto forgetOutputs = [&](const Function &function, const std::vector<ExprPtr> &args) {
    if (changes.followsOutputs(function)) // then the call writes them
      return;
    for (std::size_t i = 0; i < args.size(); ++i)
      if (function.parameters[i]->direction != ast::Direction::In)
        forget(*args[i]);
  };
  forEachExpr(expr, [&](const Expr &inner) {
    if (auto *builtin = dynCast<BuiltinExpr>(&inner)) {
      for (std::size_t i = 0; i < builtin->args.size(); ++i)
        if (isOutArgument(builtin->builtin, i))
          forget(*builtin->args[i]);
    } else if (auto *call = dynCast<CallExpr>(&inner)) {
      forgetOutputs(*call->function, call->args);
    } else if (auto *call = dynCast<MethodCallExpr>(&inner); call && call->function) {
      forgetOutputs(*call->function, call->args);
    }
  });
}

void DerivedBody::declare(const Variable &declared, std::vector<StmtPtr> &out) {
  Variable &variable = *to.locals.emplace_back(variableLike(declared));
  const bool hasCompanions = changes.hasCompanions(&declared);
  Term values[2];
  if (hasCompanions && declared.init)
    for (Axis axis : axes)
      if (changes.usedAxes().contains(axis))
        values[static_cast<int>(axis)] = change(*declared.init, axis);
  // A value that must be evaluated only once is evaluated before the changes.
  const bool valueFirst = declared.init && !derivation.isPure(*declared.init);
  if (hasCompanions && !valueFirst)
    addCompanions(declared, out, values);
  variable.init = copy(declared.init);
  variables[&declared] = &variable;
  declareKept(out);
  out.push_back(declaration(variable));
  if (hasCompanions && valueFirst)
    addCompanions(declared, out, values);
  if (declared.init)
    forgetWritten(*declared.init, out);
}

void DerivedBody::evaluate(const Expr &expr, SourceRange range, std::vector<StmtPtr> &out) {
  std::vector<ExprPtr> steps;
  if (auto *assign = dynCast<AssignExpr>(&expr); assign && companionsOf(*assign->target))
    steps = assignmentSteps(*assign);
  else
    steps.push_back(copy(expr));
  declareKept(out);
  for (ExprPtr &step : steps)
    if (step->kind != ExprKind::Variable || steps.size() == 1) // only the value, which is not used
      out.push_back(evaluation(std::move(step), range));
  forgetWritten(expr, out);
}

/// Declarations of a variable with companions are placed before the loop, in a block around both.
void DerivedBody::loop(const ForStmt &stmt, std::vector<StmtPtr> &out) {
  auto made = blank(stmt);
  std::vector<StmtPtr> before;
  if (stmt.init)
    statement(*stmt.init, before);
  if (before.size() == 1) {
    made->init = std::move(before.front());
    before.clear();
  }
  made->condition = copy(stmt.condition);
  made->step = copy(stmt.step);
  declareKept(out);
  made->body = statement(stmt.body);
  if (before.empty()) {
    out.push_back(std::move(made));
    return;
  }
  auto block = std::make_unique<CompoundStmt>();
  block->range = stmt.range;
  block->body = std::move(before);
  block->body.push_back(std::move(made));
  out.push_back(std::move(block));
}

ExprPtr DerivedBody::returned(const ExprPtr &value) {
  if (!value || result == Result::Value)
    return copy(value);
  return derivativeOf(*value, result == Result::AlongX ? Axis::X : Axis::Y);
}

/// A statement inside of another one. Variables that it needs are declared with it; those that the
/// outer statement needs are still declared before that one.
StmtPtr DerivedBody::nested(const StmtPtr &one) {
  std::vector<StmtPtr> declarations = std::exchange(keptDeclarations, {});
  StmtPtr made = statement(one);
  keptDeclarations = std::move(declarations);
  return made;
}

std::unique_ptr<SwitchStmt> DerivedBody::choice(const SwitchStmt &stmt) {
  auto made = blank(stmt);
  made->value = copy(stmt.value);
  std::vector<StmtPtr> declarations = std::exchange(keptDeclarations, {});
  for (const SwitchStmt::Arm &arm : stmt.arms) {
    SwitchStmt::Arm &copied = made->arms.emplace_back();
    copied.values = arm.values;
    copied.isDefault = arm.isDefault;
    copied.range = arm.range;
    for (const StmtPtr &inner : arm.body)
      statement(*inner, copied.body);
  }
  keptDeclarations = std::move(declarations);
  return made;
}

std::unique_ptr<IlluminanceStmt> DerivedBody::illuminance(const IlluminanceStmt &stmt) {
  auto made = blank(stmt);
  made->point = copy(stmt.point);
  made->normal = copy(stmt.normal);
  made->angle = copy(stmt.angle);
  made->body = nested(stmt.body);
  return made;
}

/// A statement that becomes one statement, after declarations.
StmtPtr DerivedBody::single(const Stmt &stmt) {
  switch (stmt.kind) {
  case StmtKind::If: {
    const auto &branch = cast<IfStmt>(stmt);
    auto made = blank(branch);
    made->condition = copy(branch.condition);
    made->thenStmt = nested(branch.thenStmt);
    made->elseStmt = nested(branch.elseStmt);
    return made;
  }
  case StmtKind::While: {
    const auto &loop = cast<WhileStmt>(stmt);
    auto made = blank(loop);
    made->condition = copy(loop.condition);
    made->body = nested(loop.body);
    return made;
  }
  case StmtKind::DoWhile: {
    const auto &loop = cast<DoWhileStmt>(stmt);
    auto made = blank(loop);
    made->body = statement(loop.body);
    made->condition = copy(loop.condition);
    return made;
  }
  case StmtKind::Switch:
    return choice(cast<SwitchStmt>(stmt));
  case StmtKind::Illuminance:
    return illuminance(cast<IlluminanceStmt>(stmt));
  case StmtKind::Break:
    return blank(cast<BreakStmt>(stmt));
  case StmtKind::Continue:
    return blank(cast<ContinueStmt>(stmt));
  case StmtKind::Return: {
    auto made = blank(cast<ReturnStmt>(stmt));
    made->value = returned(cast<ReturnStmt>(stmt).value);
    return made;
  }
  default:
    return nullptr;
  }
}

void DerivedBody::statement(const Stmt &stmt, std::vector<StmtPtr> &out) {
  const std::size_t first = out.size();
  switch (stmt.kind) {
  case StmtKind::Compound: {
    const auto &block = cast<CompoundStmt>(stmt);
    auto made = blank(block);
    for (const StmtPtr &inner : block.body)
      statement(*inner, made->body);
    return out.push_back(std::move(made));
  }
  case StmtKind::Declaration:
    for (const Variable *variable : cast<DeclarationStmt>(stmt).variables)
      declare(*variable, out);
    if (out.size() > first)
      out[first]->comment = stmt.comment;
    return;
  case StmtKind::Expression:
    evaluate(*cast<ExpressionStmt>(stmt).expr, stmt.range, out);
    out[first]->comment = stmt.comment;
    return;
  case StmtKind::For:
    return loop(cast<ForStmt>(stmt), out);
  default:
    if (StmtPtr made = single(stmt)) {
      declareKept(out);
      out.push_back(std::move(made));
    }
  }
}

} // namespace rtsl::derive
