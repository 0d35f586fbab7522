#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using typed::ExprKind;

Code Expressions::initialiser(const typed::Expr &expr) {
  return apart(expr, Binding::Assignment);
}

//===----------------------------------------------------------------------===//
// Order
//===----------------------------------------------------------------------===//

/// The name of a variable for the expression's value, derived from the first call in it.
static std::string hintFor(const typed::Expr &expr) {
  std::string hint;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (!hint.empty() || !typed::hasSideEffects(inner))
      return;
    if (auto *builtin = dynCast<typed::BuiltinExpr>(&inner))
      hint = typed::name(builtin->builtin);
    else if (auto *call = dynCast<typed::CallExpr>(&inner))
      hint = call->function->name;
    else if (auto *call = dynCast<typed::MethodCallExpr>(&inner))
      hint = call->method;
  });
  if (auto *variable = dynCast<typed::VariableExpr>(&expr))
    hint = variable->variable->name;
  return hint.empty() ? "value" : hint;
}

std::vector<Code> Expressions::operands(const std::vector<const typed::Expr *> &exprs,
                                        Binding atLeast) {
  std::vector<typed::Effects> all;
  bool anyEffects = false;
  for (const typed::Expr *expr : exprs) {
    all.push_back(context.effects.expression(*expr));
    anyEffects |= !all.back().isPure();
  }
  anyEffects &= printer.isNested;
  std::vector<Code> codes;
  for (std::size_t i = 0; i < exprs.size(); ++i) {
    bool shows = false;
    for (std::size_t later = i + 1; anyEffects && later < exprs.size(); ++later)
      shows |= conflicts(all[i], all[later]);
    codes.push_back(shows ? printer.hoist(exprs[i]->type, hintFor(*exprs[i]), argument(*exprs[i]))
                          : operand(*exprs[i], atLeast));
  }
  return codes;
}

std::vector<Code> Expressions::arguments(const std::vector<typed::ExprPtr> &exprs) {
  std::vector<const typed::Expr *> pointers;
  for (const typed::ExprPtr &expr : exprs)
    pointers.push_back(expr.get());
  return operands(pointers, Binding::Assignment);
}

Code Expressions::apart(const typed::Expr &expr, Binding atLeast) {
  Statements *outer = printer.before;
  printer.before = nullptr;
  Code code = operand(expr, atLeast);
  printer.before = outer;
  return code;
}

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

Code Expressions::operand(const typed::Expr &expr, Binding atLeast) {
  Code code = this->expr(expr);
  // The author's parentheses are kept around expressions with operators.
  const bool keeps = code && atLeast > Binding::Or && bindingOf(code) < Binding::Unary &&
                     context.notes.inParentheses(expr.range);
  return keeps ? parentheses(code) : code;
}

Code Expressions::expr(const typed::Expr &expr) {
  if (auto found = printer.replaced.find(&expr); found != printer.replaced.end())
    return found->second;
  if (printer.before)
    return lowered(expr);
  // No statement can go before this expression: those go into a lambda that is called at once.
  Statements statements;
  const bool outer = printer.isInLambda;
  printer.before = &statements;
  printer.isInLambda = true;
  Code code = lowered(expr);
  printer.before = nullptr;
  printer.isInLambda = outer;
  if (statements.empty())
    return code;
  if (code) // null: an expression of type void
    statements.push_back(returning(code));
  return lambda(std::move(statements));
}

Code Expressions::lowered(const typed::Expr &expr) {
  switch (expr.kind) {
  case ExprKind::Literal: {
    const auto &value = cast<typed::LiteralExpr>(expr);
    if (const void *constant = printer.literals.namedConstant(value))
      return name(printer.nameOf(constant));
    return printer.literals.literal(expr.type, value.value, value.spelling);
  }
  case ExprKind::Variable:
  case ExprKind::State:
  case ExprKind::Member:
  case ExprKind::Field:
    return printer.lvalues.of(expr);
  case ExprKind::Index: {
    const auto &part = cast<typed::IndexExpr>(expr);
    const bool changes =
        conflicts(context.effects.expression(*part.base), context.effects.expression(*part.index));
    if (!part.base->type->isVector() || !changes)
      return printer.lvalues.of(expr);
    return printer.lvalues.element(
        part, printer.hoist(part.base->type, "value", argument(*part.base)),
        false); // the component of the vector before the index is evaluated
  }
  case ExprKind::Swizzle:
    return printer.conversions.swizzle(cast<typed::SwizzleExpr>(expr));
  case ExprKind::Length:
    return printer.lvalues.length(cast<typed::LengthExpr>(expr));
  case ExprKind::Unary:
    return printer.operators.unary(cast<typed::UnaryExpr>(expr));
  case ExprKind::IncDec:
    return printer.assignments.incDec(cast<typed::IncDecExpr>(expr), true);
  case ExprKind::Binary: {
    const auto &op = cast<typed::BinaryExpr>(expr);
    return printer.operators.binary(op.op, *op.left, *op.right);
  }
  case ExprKind::Assign: {
    const auto &assignment = cast<typed::AssignExpr>(expr);
    const typed::Expr *vector = nullptr;
    Code code = printer.assignments.assign(assignment, true);
    if (printer.lvalues.components(*assignment.target, vector).size() > 1 ||
        !printer.lvalues.isSimple(*assignment.target))
      return code;
    printer.before->push_back(statement(code));
    return printer.lvalues.of(*assignment.target);
  }
  case ExprKind::Conditional:
    return conditional(cast<typed::ConditionalExpr>(expr));
  case ExprKind::Comma: {
    const auto &comma = cast<typed::CommaExpr>(expr);
    const Statements left = printer.statements.expressionStatement(*comma.left);
    printer.before->insert(printer.before->end(), left.begin(), left.end());
    return lowered(*comma.right);
  }
  case ExprKind::Convert:
    return printer.conversions.convert(cast<typed::ConvertExpr>(expr));
  case ExprKind::Construct:
    return printer.conversions.construct(cast<typed::ConstructExpr>(expr));
  case ExprKind::Builtin:
    return printer.builtins.builtin(cast<typed::BuiltinExpr>(expr));
  case ExprKind::Call:
    return printer.calls.call(cast<typed::CallExpr>(expr));
  case ExprKind::MethodCall:
    return printer.calls.methodCall(cast<typed::MethodCallExpr>(expr));
  case ExprKind::String:
    return string(cast<typed::StringExpr>(expr).value);
  }
  return {};
}

bool isInMemory(const typed::Expr &expr) {
  if (auto *index = dynCast<typed::IndexExpr>(&expr))
    return !index->base->type->isVector() || isInMemory(*index->base);
  if (auto *assignment = dynCast<typed::AssignExpr>(&expr))
    return isInMemory(*assignment->target);
  if (auto *comma = dynCast<typed::CommaExpr>(&expr))
    return isInMemory(*comma->right);
  if (auto *construct = dynCast<typed::ConstructExpr>(
          &expr)) // a construction from a value of the same type is that value
    return construct->args.front()->type == expr.type && isInMemory(*construct->args.front());
  if (auto *convert = dynCast<typed::ConvertExpr>(&expr))
    return convert->operand->type == expr.type && isInMemory(*convert->operand);
  return expr.kind == ExprKind::Member || expr.kind == ExprKind::Field;
}

// C++ requires both values to be of one type.
Code Expressions::conditional(const typed::ConditionalExpr &expr) {
  auto choice = [&](const typed::Expr &value) {
    Code code = apart(value, Binding::Assignment);
    const bool isBools = value.type->isVector() && value.type->element->is(TypeKind::Bool);
    return isBools && isInMemory(value) ? cpp::construct(context.types.of(value.type), {code})
                                        : code;
  };
  Code condition = operand(*expr.condition, Binding::Or);
  Code whenTrue = choice(*expr.whenTrue);
  return cpp::conditional(condition, whenTrue, choice(*expr.whenFalse));
}

} // namespace rtsl::cpp
