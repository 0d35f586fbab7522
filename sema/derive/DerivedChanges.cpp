//===- DerivedChanges.cpp - the change of an expression -------------------===//
#include "sema/derive/DerivedBody.h"
#include "sema/derive/Rules.h"
#include "sema/model/Conversion.h"
#include "sema/typed/Walk.h"

namespace rtsl::derive {

using namespace typed;
using ast::BinaryOp;

Term DerivedBody::factor(const Expr &expr) {
  if (derivation.isPure(expr))
    return {copy(expr), types};
  const Variable *&variable = kept[&expr];
  if (!variable)
    variable = &addKept(expr.type, expr.range);
  auto node = makeExpr<VariableExpr>(expr.type, expr.range);
  node->variable = variable;
  return {std::move(node), types};
}

ExprPtr DerivedBody::companionPlace(const Expr &place, Axis axis) {
  switch (place.kind) {
  case ExprKind::Variable: {
    auto node = makeExpr<VariableExpr>(place.type, place.range);
    node->variable = companions.at(cast<VariableExpr>(place).variable).along[int(axis)];
    return node;
  }
  case ExprKind::Field: {
    auto node = makeExpr<FieldExpr>(place.type, place.range);
    node->base = companionPlace(*cast<FieldExpr>(place).base, axis);
    node->field = cast<FieldExpr>(place).field;
    return node;
  }
  case ExprKind::Swizzle: {
    auto node = makeExpr<SwizzleExpr>(place.type, place.range);
    node->base = companionPlace(*cast<SwizzleExpr>(place).base, axis);
    node->components = cast<SwizzleExpr>(place).components;
    return node;
  }
  default: {
    const auto &index = cast<IndexExpr>(place);
    auto node = makeExpr<IndexExpr>(place.type, place.range);
    node->base = companionPlace(*index.base, axis);
    node->index = factor(*index.index).take();
    return node;
  }
  }
}

Term DerivedBody::changeOfBinary(BinaryOp op, const Expr &left, const Expr &right, const Type *type,
                                 Axis axis) {
  const Term ofLeft = change(left, axis), ofRight = change(right, axis);
  switch (op) {
  case BinaryOp::Add:
    return fitted(ofLeft, type) + fitted(ofRight, type);
  case BinaryOp::Sub:
    return fitted(ofLeft, type) - fitted(ofRight, type);
  case BinaryOp::Mul: {
    const Term first = ofLeft.isZero() ? Term() : ofLeft * factor(right);
    const Term second = ofRight.isZero() ? Term() : factor(left) * ofRight;
    return fitted(first, type) + fitted(second, type);
  }
  case BinaryOp::Div: {
    const Term divisor = factor(right);
    if (ofRight.isZero())
      return fitted(ofLeft / divisor, type);
    return fitted((ofLeft - factor(left) / divisor * ofRight) / divisor, type);
  }
  default:
    return {};
  }
}

Term DerivedBody::changeOfConstruct(const ConstructExpr &expr, Axis axis) {
  // Beyond a smaller matrix a larger one is the identity, which does not change.
  if (expr.type->isMatrix() && expr.args.size() == 1 && expr.args.front()->type->isMatrix() &&
      (expr.args.front()->type->columns() < expr.type->columns() ||
       expr.args.front()->type->rows() < expr.type->rows()))
    return {};
  auto node = makeExpr<ConstructExpr>(expr.type, expr.range);
  for (const ExprPtr &arg : expr.args) {
    Term value = change(*arg, axis);
    node->args.push_back(value.isZero() ? zero(arg->type, arg->range) : value.take());
  }
  return {std::move(node), types};
}

Term DerivedBody::changeOfBuiltin(const BuiltinExpr &expr, Axis axis) {
  std::vector<Term> values, changed;
  for (const ExprPtr &arg : expr.args) {
    values.push_back(factor(*arg));
    changed.push_back(change(*arg, axis));
  }
  return derivative(expr, std::move(values), std::move(changed), types);
}

ExprPtr DerivedBody::callOfVariant(const Expr &call, const Function &variant,
                                   std::vector<ExprPtr> args) {
  if (auto *method = dynCast<MethodCallExpr>(&call)) {
    auto node = makeExpr<MethodCallExpr>(call.type, call.range);
    node->receiver = copy(method->receiver);
    node->method = variant.name;
    node->function = &variant;
    node->args = std::move(args);
    return node;
  }
  const auto &plain = cast<CallExpr>(call);
  auto node = makeExpr<CallExpr>(call.type, call.range);
  node->function = &variant;
  node->onSelf = plain.onSelf;
  node->isOfBase = plain.isOfBase;
  node->args = std::move(args);
  return node;
}

Term DerivedBody::changeOfCall(const Expr &expr, const Function &function,
                               const std::vector<ExprPtr> &args, Axis axis) {
  const Result wanted = axis == Axis::X ? Result::AlongX : Result::AlongY;
  const AxisSet given = derivation.axesOf(function, wanted);
  std::vector<ExprPtr> all;
  for (const ExprPtr &arg : args)
    all.push_back(factor(*arg).take());
  for (std::size_t i = 0; i < args.size(); ++i)
    if (isDifferentiable(function.parameters[i]->type))
      for (Axis along : axes)
        if (given.contains(along)) {
          Term value = change(*args[i], along);
          all.push_back(value.isZero() ? zero(args[i]->type, args[i]->range) : value.take());
        }
  return {callOfVariant(expr, derivation.variant(function, wanted), std::move(all)), types};
}

Term DerivedBody::changeOfState(const StateExpr &expr, Axis axis) {
  auto node = makeExpr<StateExpr>(expr.type, expr.range);
  node->variable = *changeOf(expr.variable, from, axis);
  Term change(std::move(node), types);
  if (expr.variable != StateVariable::InverseRayDirection)
    return change;
  const Term inverse = factor(expr); // of the direction, of which this is the change
  return -(inverse * inverse * change);
}

Term DerivedBody::change(const Expr &expr, Axis axis) {
  if (!changes.isVaried(expr))
    return {};
  switch (expr.kind) {
  case ExprKind::State:
    return changeOfState(cast<StateExpr>(expr), axis);
  case ExprKind::Member: {
    auto node = makeExpr<MemberExpr>(expr.type, expr.range);
    node->member = &derivation.changeOf(*cast<MemberExpr>(expr).member, axis);
    return {std::move(node), types};
  }
  case ExprKind::Variable: {
    const Companions *found = companionsOf(expr);
    if (!found || !found->along[static_cast<int>(axis)])
      return {};
    return {companionPlace(expr, axis), types};
  }
  case ExprKind::Field: {
    auto node = makeExpr<FieldExpr>(expr.type, expr.range);
    node->base = change(*cast<FieldExpr>(expr).base, axis).take();
    node->field = cast<FieldExpr>(expr).field;
    return node->base ? Term(std::move(node), types) : Term();
  }
  case ExprKind::Swizzle: {
    auto node = makeExpr<SwizzleExpr>(expr.type, expr.range);
    node->base = change(*cast<SwizzleExpr>(expr).base, axis).take();
    node->components = cast<SwizzleExpr>(expr).components;
    return node->base ? Term(std::move(node), types) : Term();
  }
  case ExprKind::Index: {
    auto node = makeExpr<IndexExpr>(expr.type, expr.range);
    node->base = change(*cast<IndexExpr>(expr).base, axis).take();
    if (!node->base)
      return {};
    node->index = factor(*cast<IndexExpr>(expr).index).take();
    return {std::move(node), types};
  }
  case ExprKind::Unary:
    return -change(*cast<UnaryExpr>(expr).operand, axis);
  case ExprKind::Binary: {
    const auto &binary = cast<BinaryExpr>(expr);
    return changeOfBinary(binary.op, *binary.left, *binary.right, expr.type, axis);
  }
  case ExprKind::Assign: { // it has been evaluated before
    const auto &assign = cast<AssignExpr>(expr);
    const Companions *found = companionsOf(*assign.target);
    if (!found || !found->along[static_cast<int>(axis)])
      return {};
    return {companionPlace(*assign.target, axis), types};
  }
  case ExprKind::Conditional: {
    const auto &choice = cast<ConditionalExpr>(expr);
    const Term condition = factor(*choice.condition);
    return select(condition, change(*choice.whenTrue, axis), change(*choice.whenFalse, axis),
                  expr.type);
  }
  case ExprKind::Comma:
    return change(*cast<CommaExpr>(expr).right, axis);
  case ExprKind::Convert:
    return change(*cast<ConvertExpr>(expr).operand, axis);
  case ExprKind::Construct:
    return changeOfConstruct(cast<ConstructExpr>(expr), axis);
  case ExprKind::Builtin:
    return changeOfBuiltin(cast<BuiltinExpr>(expr), axis);
  case ExprKind::Call: {
    const auto &call = cast<CallExpr>(expr);
    return changeOfCall(expr, *call.function, call.args, axis);
  }
  case ExprKind::MethodCall: {
    const auto &call = cast<MethodCallExpr>(expr);
    return changeOfCall(expr, *call.function, call.args, axis);
  }
  default:
    return {};
  }
}

} // namespace rtsl::derive
