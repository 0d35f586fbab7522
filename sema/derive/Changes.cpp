//===- Changes.cpp - which variables of a function change -----------------===//
#include "sema/derive/Changes.h"

#include "sema/derive/Rules.h"
#include "sema/derive/Term.h"
#include "sema/typed/Casting.h"
#include "sema/typed/Walk.h"

#include <algorithm>

namespace rtsl::derive {

using namespace typed;

void Changes::addParameters(AxisSet given) {
  for (const auto &parameter : function.parameters)
    if (isDifferentiable(parameter->type)) {
      varied.insert(parameter.get());
      if (parameter->direction != ast::Direction::In) // the caller gets its change
        used.insert(parameter.get());
    }
  axesUsed.add(given);
}

/// Rays differ in another way inside of `intersect` than at the hit.
static bool isOfPrimitive(const Function &function) {
  return function.owner && function.owner->root == "rt_Primitive";
}

bool Changes::isFollowed(const Function &called) const {
  return isAtHit && (!isOfPrimitive(called) || isOfPrimitive(function));
}

bool Changes::followsOutputs(const Function &called) const {
  return isFollowed(called) && derivation.hasVariants(called);
}

bool Changes::isCallVaried(const Function &called, const std::vector<ExprPtr> &args) const {
  return isFollowed(called) && derivation.canBeFollowed(called) &&
         (std::any_of(args.begin(), args.end(),
                      [&](const ExprPtr &arg) { return isVaried(*arg); }) ||
          derivation.readsSeeds(called));
}

bool Changes::isVaried(const Expr &expr) const {
  if (!isAtHit || !isDifferentiable(expr.type))
    return false;
  const auto any = [&](const std::vector<ExprPtr> &exprs) {
    return std::any_of(exprs.begin(), exprs.end(),
                       [&](const ExprPtr &one) { return isVaried(*one); });
  };
  switch (expr.kind) {
  case ExprKind::State:
    return changeOf(cast<StateExpr>(expr).variable, function, Axis::X) != nullptr;
  case ExprKind::Member:
    return changes(*cast<MemberExpr>(expr).member);
  case ExprKind::Variable:
    return varied.count(cast<VariableExpr>(expr).variable) != 0;
  case ExprKind::Field:
    return isVaried(*cast<FieldExpr>(expr).base);
  case ExprKind::Swizzle:
    return isVaried(*cast<SwizzleExpr>(expr).base);
  case ExprKind::Index:
    return isVaried(*cast<IndexExpr>(expr).base);
  case ExprKind::Unary:
    return isVaried(*cast<UnaryExpr>(expr).operand);
  case ExprKind::Binary:
    return isVaried(*cast<BinaryExpr>(expr).left) || isVaried(*cast<BinaryExpr>(expr).right);
  case ExprKind::Assign: {
    const auto &assign = cast<AssignExpr>(expr);
    const Variable *target = rootVariable(*assign.target);
    return target && varied.count(target) != 0;
  }
  case ExprKind::Conditional:
    return isVaried(*cast<ConditionalExpr>(expr).whenTrue) ||
           isVaried(*cast<ConditionalExpr>(expr).whenFalse);
  case ExprKind::Comma:
    return isVaried(*cast<CommaExpr>(expr).right);
  case ExprKind::Convert:
    return isVaried(*cast<ConvertExpr>(expr).operand);
  case ExprKind::Construct:
    return any(cast<ConstructExpr>(expr).args);
  case ExprKind::Builtin:
    return hasRule(cast<BuiltinExpr>(expr).builtin) && any(cast<BuiltinExpr>(expr).args);
  case ExprKind::Call:
    return isCallVaried(*cast<CallExpr>(expr).function, cast<CallExpr>(expr).args);
  case ExprKind::MethodCall: {
    const auto &call = cast<MethodCallExpr>(expr);
    return call.function && isCallVaried(*call.function, call.args);
  }
  default:
    return false;
  }
}

/// Finds what depends on what, and whose changes are used, in one walk over the body.
void Changes::collect() {
  const auto useArgs = [&](const Function &called, const std::vector<ExprPtr> &args) {
    if (followsOutputs(called))
      for (std::size_t i = 0; i < args.size(); ++i)
        if (called.parameters[i]->direction != ast::Direction::In &&
            isDifferentiable(args[i]->type))
          outputs.push_back({rootVariable(*args[i]), &called, &args});
    if (!isAtHit || !derivation.hasVariants(called) || !derivation.asks(called))
      return;
    axesUsed.add(AxisSet::both());
    for (const ExprPtr &arg : args)
      roots.push_back(arg.get());
  };
  forEachExpr(*function.body, [&](const Expr &expr) {
    if (auto *assign = dynCast<AssignExpr>(&expr)) {
      if (const Variable *target = rootVariable(*assign->target))
        dependences.emplace_back(target, assign->value.get());
    } else if (auto *builtin = dynCast<BuiltinExpr>(&expr)) {
      if (builtin->builtin == Builtin::DFdx || builtin->builtin == Builtin::DFdy) {
        axesUsed.add(AxisSet::only(builtin->builtin == Builtin::DFdx ? Axis::X : Axis::Y));
        roots.push_back(builtin->args.front().get());
      }
    } else if (auto *call = dynCast<CallExpr>(&expr)) {
      useArgs(*call->function, call->args);
    } else if (auto *call = dynCast<MethodCallExpr>(&expr)) {
      if (call->function)
        useArgs(*call->function, call->args);
    }
  });
  forEachStmt(*function.body, [&](const Stmt &stmt) {
    if (auto *declaration = dynCast<DeclarationStmt>(&stmt))
      for (const Variable *variable : declaration->variables)
        if (variable->init)
          dependences.emplace_back(variable, variable->init.get());
  });
}

void Changes::use(const Expr &expr) {
  forEachExpr(expr, [&](const Expr &inner) {
    if (auto *variable = dynCast<VariableExpr>(&inner); variable)
      used.insert(variable->variable);
  });
}

void Changes::find(AxisSet returned) {
  if (!isAtHit)
    return;
  const auto any = [&](const std::vector<ExprPtr> &args) {
    return std::any_of(args.begin(), args.end(),
                       [&](const ExprPtr &arg) { return isVaried(*arg); });
  };
  collect();
  axesUsed.add(returned);
  if (returned.has[0] || returned.has[1])
    forEachStmt(*function.body, [&](const Stmt &stmt) {
      if (auto *end = dynCast<ReturnStmt>(&stmt); end && end->value)
        roots.push_back(end->value.get());
    });
  for (std::size_t before = varied.size() + 1; before != varied.size();) {
    before = varied.size();
    for (const auto &[variable, value] : dependences)
      if (isDifferentiable(variable->type) && isVaried(*value))
        varied.insert(variable);
    for (const Output &output : outputs)
      if (output.variable && isDifferentiable(output.variable->type) &&
          (any(*output.args) || derivation.readsSeeds(*output.called)))
        varied.insert(output.variable);
  }
  for (const Expr *root : roots)
    use(*root);
  for (std::size_t before = used.size() + 1; before != used.size();) {
    before = used.size();
    for (const auto &[variable, value] : dependences)
      if (used.count(variable))
        use(*value);
    for (const Output &output : outputs)
      if (used.count(output.variable))
        for (const ExprPtr &arg : *output.args)
          use(*arg);
  }
}

} // namespace rtsl::derive
