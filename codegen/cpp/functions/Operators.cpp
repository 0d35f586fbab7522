#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace rtsl::cpp {

using ast::BinaryOp;
using typed::ExprKind;

static constexpr std::int64_t intMin = std::numeric_limits<std::int32_t>::min();

/// The operator of C++ with the same spelling.
static Operator operatorFor(BinaryOp op) {
  static constexpr Operator all[] = {
      Operator::Multiply,   Operator::Divide,       Operator::Remainder,
      Operator::Add,        Operator::Subtract,     Operator::ShiftLeft,
      Operator::ShiftRight, Operator::Less,         Operator::Greater,
      Operator::LessEqual,  Operator::GreaterEqual, Operator::Equal,
      Operator::NotEqual,   Operator::BitAnd,       Operator::BitXor,
      Operator::BitOr,      Operator::And,          Operator::NotEqual,
      Operator::Or};
  return all[static_cast<int>(op)];
}

static bool isZero(const typed::Expr &expr) {
  auto *literal = dynCast<typed::LiteralExpr>(&expr);
  if (auto *convert = dynCast<typed::ConvertExpr>(&expr))
    return isZero(*convert->operand);
  return literal && literal->type->isScalar() && literal->value.scalars.front().u == 0;
}

/// A literal divisor for which no dividend overflows or is undefined.
static bool isSafeDivisor(const typed::Expr &expr) {
  if (auto *convert = dynCast<typed::ConvertExpr>(&expr))
    return convert->operand->type->is(TypeKind::Int) && isSafeDivisor(*convert->operand);
  auto *literal = dynCast<typed::LiteralExpr>(&expr);
  return literal && literal->type->isScalar() && literal->value.scalars.front().i > 0;
}

std::optional<Operator> Operators::plainOperator(BinaryOp op, const typed::Expr &left,
                                                 const typed::Expr &right) {
  const Type *l = left.type, *r = right.type;
  const bool hasMatrix = l->isMatrix() || r->isMatrix();
  const Type *scalar = l->scalar();
  const bool isInt = scalar && scalar->is(TypeKind::Int);
  const bool isUint = scalar && scalar->is(TypeKind::UInt);
  switch (op) {
  case BinaryOp::Mul:
    if (hasMatrix && !l->isScalar() && !r->isScalar())
      return std::nullopt;
    [[fallthrough]];
  case BinaryOp::Add:
  case BinaryOp::Sub:
    if (hasMatrix && (op != BinaryOp::Mul) && l != r)
      return std::nullopt;
    if (isInt && !printer.ranges.range(op, left, right))
      return std::nullopt;
    return operatorFor(op);
  case BinaryOp::Div:
    if (hasMatrix && !r->isScalar())
      return std::nullopt;
    [[fallthrough]];
  case BinaryOp::Mod:
    if ((isInt || isUint) && !isSafeDivisor(right))
      return std::nullopt;
    return operatorFor(op);
  case BinaryOp::Shl:
  case BinaryOp::Shr: {
    auto *count = dynCast<typed::LiteralExpr>(&right);
    const bool isKnown = l->isScalar() && count && count->value.scalars.front().u < 32;
    return isKnown && (isUint || op == BinaryOp::Shr) ? std::optional(operatorFor(op))
                                                      : std::nullopt;
  }
  case BinaryOp::Less:
  case BinaryOp::GreaterEqual: // compilers warn that `u < 0u` is never true
    return isUint && isZero(right) ? std::nullopt : std::optional(operatorFor(op));
  case BinaryOp::Greater:
  case BinaryOp::LessEqual:
    return isUint && isZero(left) ? std::nullopt : std::optional(operatorFor(op));
  default:
    return operatorFor(op);
  }
}

std::string Operators::functionFor(BinaryOp op, const typed::Expr &left, const typed::Expr &right) {
  const bool hasMatrix = left.type->isMatrix() || right.type->isMatrix();
  switch (op) {
  case BinaryOp::Mul:
    return hasMatrix ? "rtsl::mul" : "rtsl::multiply";
  case BinaryOp::Div:
    return hasMatrix ? "rtsl::divideByComponent" : "rtsl::divide";
  case BinaryOp::Add:
    return hasMatrix ? "rtsl::addByComponent" : "rtsl::add";
  case BinaryOp::Sub:
    return hasMatrix ? "rtsl::subtractByComponent" : "rtsl::subtract";
  case BinaryOp::Mod:
    return "rtsl::remainder";
  case BinaryOp::Shl:
    return "rtsl::shiftLeft";
  case BinaryOp::Shr:
    return "rtsl::shiftRight";
  case BinaryOp::Less:
    return "rtsl::lessThan";
  case BinaryOp::LessEqual:
    return "rtsl::lessThanEqual";
  case BinaryOp::Greater:
    return "rtsl::greaterThan";
  case BinaryOp::GreaterEqual:
    return "rtsl::greaterThanEqual";
  case BinaryOp::Equal:
    return "rtsl::equal";
  case BinaryOp::NotEqual:
  case BinaryOp::LogicalXor:
    return "rtsl::notEqual";
  default:
    return "";
  }
}

void Operators::compareStructs(const Type *type) {
  if (type->is(TypeKind::Array))
    return compareStructs(type->element);
  if (!type->is(TypeKind::Struct) || !context.required.comparedStructs.insert(type).second)
    return;
  for (const typed::Field &field : type->structure->fields)
    compareStructs(field.type);
}

// `a + b + c` of ints is `rtsl::add(a, b, c)`.
void Operators::appendOperands(BinaryOp op, const typed::Expr &expr,
                               std::vector<const typed::Expr *> &into) {
  auto *nested = dynCast<typed::BinaryExpr>(&expr);
  const bool isSum = (op == BinaryOp::Add || op == BinaryOp::Mul) && expr.type->scalar() &&
                     expr.type->scalar()->is(TypeKind::Int);
  if (!isSum || !nested || nested->op != op || plainOperator(op, *nested->left, *nested->right)) {
    into.push_back(&expr);
    return;
  }
  appendOperands(op, *nested->left, into);
  into.push_back(nested->right.get());
}

Code Operators::binary(BinaryOp op, const typed::Expr &left, const typed::Expr &right) {
  const Operator own = operatorFor(op);
  if (op == BinaryOp::LogicalAnd || op == BinaryOp::LogicalOr) {
    const Code first = printer.expressions.operand(left, Binding::BitOr),
               second = printer.expressions.apart(right, Binding::BitOr);
    if (same(first, negated(second)) || same(second, negated(first))) // compilers warn of `a && !a`
      return cpp::call(op == BinaryOp::LogicalAnd ? "rtsl::all" : "rtsl::any",
                       {cpp::construct("glm::bvec2", {first, second})});
    return cpp::binary(own, first, second);
  }
  if (op == BinaryOp::Equal || op == BinaryOp::NotEqual)
    compareStructs(left.type);

  if (!plainOperator(op, left, right)) {
    std::vector<const typed::Expr *> all;
    appendOperands(op, left, all);
    all.push_back(&right);
    return cpp::call(functionFor(op, left, right),
                     printer.expressions.operands(all, Binding::Assignment));
  }

  std::vector<Code> both;
  if (conflicts(context.effects.expression(left), context.effects.expression(right)))
    both = printer.expressions.operands({&left, &right}, bindingOf(own));
  else
    both = {printer.expressions.operand(left, bindingOf(own)),
            printer.expressions.operand(right, bindingOf(own))};
  // Bools have another type in memory: one in memory is converted if the other is not.
  if (op == BinaryOp::Equal || op == BinaryOp::NotEqual || op == BinaryOp::LogicalXor) {
    Code &stored = both[isInMemory(left) ? 0 : 1];
    if (left.type->isVector() && left.type->element->is(TypeKind::Bool) &&
        isInMemory(left) != isInMemory(right))
      stored = cpp::construct(context.types.of(left.type), {stored});
  }
  const bool compares = bindingOf(own) == Binding::Equality || bindingOf(own) == Binding::Relation;
  if (compares && left.type->scalar() && same(both[0], both[1])) { // compilers warn of `x == x`
    const Code compared = cpp::call(functionFor(op, left, right), both);
    if (left.type->isScalar())
      return compared;
    if (left.type->isVector() && op == BinaryOp::Equal)
      return cpp::call("rtsl::all", {compared});
    if (left.type->isVector() && op == BinaryOp::NotEqual)
      return cpp::call("rtsl::any", {compared});
  }
  return cpp::binary(own, both[0], both[1]);
}

Code Operators::unary(const typed::UnaryExpr &expr) {
  if (expr.op == typed::UnaryOp::Not)
    return cpp::unary(UnaryOperator::Not,
                      printer.expressions.operand(*expr.operand, Binding::Unary));
  if (expr.op == typed::UnaryOp::BitNot)
    return cpp::unary(UnaryOperator::BitNot,
                      printer.expressions.operand(*expr.operand, Binding::Unary));
  const Type *type = expr.operand->type, *scalar = type->scalar();
  if (scalar && scalar->is(TypeKind::Int)) {
    if (auto *literal = dynCast<typed::LiteralExpr>(expr.operand);
        literal && literal->type->isScalar() && literal->value.scalars.front().i == intMin)
      return integer(intMin);
    if (!printer.ranges.range(expr))
      return cpp::call("rtsl::negate", {printer.expressions.argument(*expr.operand)});
  }
  // GLM negates four components by subtracting them from 0, which does not change the sign of a
  // zero.
  if ((type->isVector() && type->count == 4) || (type->isMatrix() && type->rows() == 4))
    return cpp::call("rtsl::negate", {printer.expressions.argument(*expr.operand)});
  return cpp::unary(UnaryOperator::Minus,
                    printer.expressions.operand(*expr.operand, Binding::Unary));
}

} // namespace rtsl::cpp
