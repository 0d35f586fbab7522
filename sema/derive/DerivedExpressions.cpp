//===- DerivedExpressions.cpp - expressions without dFdx and dFdy ---------===//
#include "sema/derive/DerivedBody.h"
#include "sema/model/Conversion.h"
#include "sema/typed/Walk.h"

#include <algorithm>

namespace rtsl::derive {

using namespace typed;

static ExprPtr comma(ExprPtr left, ExprPtr right) {
  auto node = makeExpr<CommaExpr>(right->type, right->range);
  node->left = std::move(left);
  node->right = std::move(right);
  return node;
}

static ExprPtr use(const Variable &variable, SourceRange range) {
  auto node = makeExpr<VariableExpr>(variable.type, range);
  node->variable = &variable;
  return node;
}

static ExprPtr set(ExprPtr target, ExprPtr value) {
  auto node = makeExpr<AssignExpr>(target->type, target->range);
  node->target = std::move(target);
  node->value = std::move(value);
  return node;
}

/// `dFdx(expr)`.
ExprPtr DerivedBody::derivativeOf(const Expr &expr, Axis axis) {
  Term value = change(expr, axis);
  ExprPtr changed = value.isZero() ? zero(expr.type, expr.range) : value.take();
  return derivation.isPure(expr) ? std::move(changed) : comma(copy(expr), std::move(changed));
}

/// Must the variant be called: because the function contains dFdx or dFdy and the variant's value
/// differs, or because it writes a variable whose change is used?
bool DerivedBody::isCalledWithFootprint(const Function &function,
                                        const std::vector<ExprPtr> &args) {
  if (changes.followsOutputs(function))
    for (std::size_t i = 0; i < args.size(); ++i)
      if (function.parameters[i]->direction != ast::Direction::In && companionsOf(*args[i]) &&
          isDifferentiable(args[i]->type))
        return true;
  if (!changes.atHit() || !derivation.hasVariants(function) || !derivation.asks(function))
    return false;
  const bool isReplaced = function.owner && function.owner->root != helperRoot;
  return (!isReplaced && derivation.readsSeeds(function)) ||
         std::any_of(args.begin(), args.end(),
                     [&](const ExprPtr &arg) { return changes.isVaried(*arg); });
}

/// The lvalue to which a call writes the change of an `out` argument; a temporary variable if that
/// change is not used.
ExprPtr DerivedBody::changeOfOutput(const Variable &parameter, const Expr &arg, Axis axis) {
  const Companions *written = companionsOf(arg);
  if (written && written->along[static_cast<int>(axis)])
    return companionPlace(arg, axis);
  return use(addKept(parameter.type, arg.range), arg.range);
}

ExprPtr DerivedBody::callWithFootprint(const Expr &expr, const Function &function,
                                       const std::vector<ExprPtr> &args) {
  std::vector<ExprPtr> changed;
  for (std::size_t i = 0; i < args.size(); ++i)
    if (const Variable &parameter = *function.parameters[i]; isDifferentiable(parameter.type))
      for (Axis axis : axes) {
        if (parameter.direction != ast::Direction::In) {
          changed.push_back(changeOfOutput(parameter, *args[i], axis));
          continue;
        }
        Term value = change(*args[i], axis);
        changed.push_back(value.isZero() ? zero(args[i]->type, args[i]->range) : value.take());
      }
  std::vector<ExprPtr> all = copies(args); // after the changes: it sets what they keep
  for (ExprPtr &one : changed)
    all.push_back(std::move(one));
  return callOfVariant(expr, derivation.variant(function, Result::Value), std::move(all));
}

/// An assignment to a variable with companions, in order. Changes are computed from the values
/// before it, but after what must be evaluated once.
std::vector<ExprPtr> DerivedBody::assignmentSteps(const AssignExpr &expr) {
  std::vector<ExprPtr> steps, changed;
  const Companions &written = *companionsOf(*expr.target);
  for (Axis axis : axes) {
    if (!written.along[static_cast<int>(axis)])
      continue;
    Term value = expr.compound ? changeOfBinary(expr.op, *expr.target, *expr.value, expr.type, axis)
                               : change(*expr.value, axis);
    changed.push_back(set(companionPlace(*expr.target, axis),
                          value.isZero() ? zero(expr.type, expr.range) : value.take()));
  }
  auto assign = makeExpr<AssignExpr>(expr.type, expr.range);
  assign->compound = expr.compound;
  assign->op = expr.op;
  assign->target = copy(expr.target);
  if (!derivation.isPure(*expr.target)) { // such as v[i++]: first, because of the index
    assign->value = copy(expr.value);
    const Variable &value = addKept(expr.type, expr.range);
    steps.push_back(set(use(value, expr.range), std::move(assign)));
    for (ExprPtr &one : changed)
      steps.push_back(std::move(one));
    steps.push_back(use(value, expr.range));
    return steps;
  }
  if (derivation.isPure(*expr.value)) {
    assign->value = copy(expr.value);
  } else {
    const Variable &value = addKept(expr.value->type, expr.range);
    steps.push_back(set(use(value, expr.range), copy(expr.value)));
    assign->value = use(value, expr.range);
  }
  for (ExprPtr &one : changed)
    steps.push_back(std::move(one));
  steps.push_back(std::move(assign));
  return steps;
}

ExprPtr DerivedBody::copy(const Expr &expr) {
  if (const auto found = kept.find(&expr); found != kept.end()) {
    const Variable &variable = *found->second;
    kept.erase(found);
    return set(use(variable, expr.range), copy(expr));
  }
  if (auto *builtin = dynCast<BuiltinExpr>(&expr)) {
    if (builtin->builtin == Builtin::DFdx)
      return derivativeOf(*builtin->args.front(), Axis::X);
    if (builtin->builtin == Builtin::DFdy)
      return derivativeOf(*builtin->args.front(), Axis::Y);
  } else if (auto *call = dynCast<CallExpr>(&expr)) {
    if (isCalledWithFootprint(*call->function, call->args))
      return callWithFootprint(expr, *call->function, call->args);
  } else if (auto *call = dynCast<MethodCallExpr>(&expr)) {
    if (call->function && isCalledWithFootprint(*call->function, call->args))
      return callWithFootprint(expr, *call->function, call->args);
  } else if (auto *assign = dynCast<AssignExpr>(&expr)) {
    if (companionsOf(*assign->target)) {
      std::vector<ExprPtr> steps = assignmentSteps(*assign);
      ExprPtr all = std::move(steps.front());
      for (std::size_t i = 1; i < steps.size(); ++i)
        all = comma(std::move(all), std::move(steps[i]));
      return all;
    }
  }
  return copyNode(expr);
}

} // namespace rtsl::derive
