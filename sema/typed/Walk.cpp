//===- Walk.cpp - traversing a typed tree ---------------------------------===//
#include "sema/typed/Walk.h"

#include "sema/typed/Casting.h"

namespace rtsl {

using namespace typed;
using ast::StmtKind;

void forEachChild(const Expr &expr, const ExprVisitor &visit) {
  auto one = [&](const ExprPtr &child) {
    if (child)
      visit(*child);
  };
  auto several = [&](const std::vector<ExprPtr> &children) {
    for (const ExprPtr &child : children)
      one(child);
  };
  switch (expr.kind) {
  case ExprKind::Literal:
  case ExprKind::Variable:
  case ExprKind::State:
  case ExprKind::Member:
  case ExprKind::String:
    return;
  case ExprKind::Field:
    return one(cast<FieldExpr>(expr).base);
  case ExprKind::Swizzle:
    return one(cast<SwizzleExpr>(expr).base);
  case ExprKind::Index:
    one(cast<IndexExpr>(expr).base);
    return one(cast<IndexExpr>(expr).index);
  case ExprKind::Length:
    return one(cast<LengthExpr>(expr).base);
  case ExprKind::Unary:
    return one(cast<UnaryExpr>(expr).operand);
  case ExprKind::IncDec:
    return one(cast<IncDecExpr>(expr).target);
  case ExprKind::Binary:
    one(cast<BinaryExpr>(expr).left);
    return one(cast<BinaryExpr>(expr).right);
  case ExprKind::Assign:
    one(cast<AssignExpr>(expr).target);
    return one(cast<AssignExpr>(expr).value);
  case ExprKind::Conditional:
    one(cast<ConditionalExpr>(expr).condition);
    one(cast<ConditionalExpr>(expr).whenTrue);
    return one(cast<ConditionalExpr>(expr).whenFalse);
  case ExprKind::Comma:
    one(cast<CommaExpr>(expr).left);
    return one(cast<CommaExpr>(expr).right);
  case ExprKind::Convert:
    return one(cast<ConvertExpr>(expr).operand);
  case ExprKind::Construct:
    return several(cast<ConstructExpr>(expr).args);
  case ExprKind::Builtin:
    return several(cast<BuiltinExpr>(expr).args);
  case ExprKind::Call:
    return several(cast<CallExpr>(expr).args);
  case ExprKind::MethodCall:
    one(cast<MethodCallExpr>(expr).receiver);
    return several(cast<MethodCallExpr>(expr).args);
  }
}

void forEachExpr(const Expr &expr, const ExprVisitor &visit) {
  visit(expr);
  forEachChild(expr, [&](const Expr &child) { forEachExpr(child, visit); });
}

void forEachChild(const Stmt &stmt, const StmtVisitor &visitStmt, const ExprVisitor &visitExpr) {
  auto onExpr = [&](const ExprPtr &child) {
    if (child)
      visitExpr(*child);
  };
  auto onStmt = [&](const StmtPtr &child) {
    if (child)
      visitStmt(*child);
  };
  switch (stmt.kind) {
  case StmtKind::Compound:
    for (const StmtPtr &child : cast<CompoundStmt>(stmt).body)
      onStmt(child);
    return;
  case StmtKind::Declaration:
    for (const Variable *variable : cast<DeclarationStmt>(stmt).variables)
      onExpr(variable->init);
    return;
  case StmtKind::Expression:
    return onExpr(cast<ExpressionStmt>(stmt).expr);
  case StmtKind::If:
    onExpr(cast<IfStmt>(stmt).condition);
    onStmt(cast<IfStmt>(stmt).thenStmt);
    return onStmt(cast<IfStmt>(stmt).elseStmt);
  case StmtKind::For:
    onStmt(cast<ForStmt>(stmt).init);
    onExpr(cast<ForStmt>(stmt).condition);
    onExpr(cast<ForStmt>(stmt).step);
    return onStmt(cast<ForStmt>(stmt).body);
  case StmtKind::While:
    onExpr(cast<WhileStmt>(stmt).condition);
    return onStmt(cast<WhileStmt>(stmt).body);
  case StmtKind::DoWhile:
    onStmt(cast<DoWhileStmt>(stmt).body);
    return onExpr(cast<DoWhileStmt>(stmt).condition);
  case StmtKind::Switch:
    onExpr(cast<SwitchStmt>(stmt).value);
    for (const auto &arm : cast<SwitchStmt>(stmt).arms)
      for (const StmtPtr &child : arm.body)
        onStmt(child);
    return;
  case StmtKind::Return:
    return onExpr(cast<ReturnStmt>(stmt).value);
  case StmtKind::Illuminance:
    onExpr(cast<IlluminanceStmt>(stmt).point);
    onExpr(cast<IlluminanceStmt>(stmt).normal);
    onExpr(cast<IlluminanceStmt>(stmt).angle);
    return onStmt(cast<IlluminanceStmt>(stmt).body);
  case StmtKind::Case:
  case StmtKind::Break:
  case StmtKind::Continue:
  case StmtKind::Empty:
    return;
  }
}

void forEachExpr(const Stmt &stmt, const ExprVisitor &visit) {
  forEachChild(
      stmt, [&](const Stmt &child) { forEachExpr(child, visit); },
      [&](const Expr &child) { forEachExpr(child, visit); });
}

void forEachStmt(const Stmt &stmt, const StmtVisitor &visit) {
  visit(stmt);
  forEachChild(stmt, [&](const Stmt &child) { forEachStmt(child, visit); }, [](const Expr &) {});
}

const Variable *rootVariable(const Expr &place) {
  for (const Expr *at = &place;;) {
    if (const auto *field = dynCast<FieldExpr>(at))
      at = field->base.get();
    else if (const auto *swizzle = dynCast<SwizzleExpr>(at))
      at = swizzle->base.get();
    else if (const auto *index = dynCast<IndexExpr>(at))
      at = index->base.get();
    else if (const auto *variable = dynCast<VariableExpr>(at))
      return variable->variable;
    else
      return nullptr;
  }
}

/// Adds the variables that this expression itself assigns.
static void addAssigned(const Expr &expr, std::set<const Variable *> &assigned) {
  const auto add = [&](const Expr &place) {
    if (const Variable *variable = rootVariable(place))
      assigned.insert(variable);
  };
  const auto addOutputs = [&](const Function *function, const std::vector<ExprPtr> &args) {
    for (std::size_t i = 0; function && i < args.size(); ++i)
      if (function->parameters[i]->direction != ast::Direction::In)
        add(*args[i]);
  };
  if (const auto *assign = dynCast<AssignExpr>(&expr)) {
    add(*assign->target);
  } else if (const auto *incDec = dynCast<IncDecExpr>(&expr)) {
    add(*incDec->target);
  } else if (const auto *call = dynCast<CallExpr>(&expr)) {
    addOutputs(call->function, call->args);
  } else if (const auto *method = dynCast<MethodCallExpr>(&expr)) {
    addOutputs(method->function, method->args);
  } else if (const auto *builtin = dynCast<BuiltinExpr>(&expr)) {
    for (std::size_t i = 0; i < builtin->args.size(); ++i)
      if (isOutArgument(builtin->builtin, i))
        add(*builtin->args[i]);
  }
}

std::set<const Variable *> assignedVariables(const Stmt &stmt) {
  std::set<const Variable *> assigned;
  forEachExpr(stmt, [&](const Expr &expr) { addAssigned(expr, assigned); });
  return assigned;
}

std::set<const Variable *> assignedVariables(const Expr &expr) {
  std::set<const Variable *> assigned;
  forEachExpr(expr, [&](const Expr &inner) { addAssigned(inner, assigned); });
  return assigned;
}

} // namespace rtsl
