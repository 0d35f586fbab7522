//===- Operators.cpp - operators and assignments --------------------------===//
//
// An operator of RTSL is one of C++ where that is always defined and means the same. An int may
// overflow, a divisor may be zero, a matrix product adds in RTSL's order: those are functions of
// the runtime header, unless it is plain from the operands that nothing can happen.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace rtsl::cpp {

using ast::BinaryOp;
using typed::ExprKind;

//===----------------------------------------------------------------------===//
// What an int can be
//===----------------------------------------------------------------------===//

static constexpr std::int64_t intMin = std::numeric_limits<std::int32_t>::min();
static constexpr std::int64_t intMax = std::numeric_limits<std::int32_t>::max();

std::optional<Interval> FunctionPrinter::range(BinaryOp op, const typed::Expr &left,
                                               const typed::Expr &right) {
  const std::optional<Interval> a = range(left), b = range(right);
  if (op == BinaryOp::BitAnd) {
    if (a && a->low >= 0 && b && b->low >= 0)
      return Interval{0, std::min(a->high, b->high)};
    if (b && b->low >= 0)
      return Interval{0, b->high};
    if (a && a->low >= 0)
      return Interval{0, a->high};
    return std::nullopt;
  }
  if (op == BinaryOp::Mod && b && b->low > 0)
    return Interval{a && a->low >= 0 ? 0 : 1 - b->high, b->high - 1};
  if (!a || !b)
    return std::nullopt;
  Interval result;
  switch (op) {
  case BinaryOp::Add:
    result = {a->low + b->low, a->high + b->high};
    break;
  case BinaryOp::Sub:
    result = {a->low - b->high, a->high - b->low};
    break;
  case BinaryOp::Mul: {
    auto [low, high] =
        std::minmax({a->low * b->low, a->low * b->high, a->high * b->low, a->high * b->high});
    result = {low, high};
    break;
  }
  case BinaryOp::Div:
    if (b->low <= 0)
      return std::nullopt;
    result = {std::min(a->low, std::int64_t(0)), std::max(a->high, std::int64_t(0))};
    break;
  default:
    return std::nullopt;
  }
  if (result.low < intMin || result.high > intMax)
    return std::nullopt;
  return result;
}

std::optional<Interval> FunctionPrinter::range(const typed::Expr &expr) {
  if (!expr.type->is(TypeKind::Int))
    return std::nullopt;
  switch (expr.kind) {
  case ExprKind::Literal: {
    const std::int64_t value = cast<typed::LiteralExpr>(expr).value.scalars.front().i;
    return Interval{value, value};
  }
  case ExprKind::Variable: {
    const typed::Variable *variable = cast<typed::VariableExpr>(expr).variable;
    if (variable->constant) {
      const std::int64_t value = variable->constant->scalars.front().i;
      return Interval{value, value};
    }
    if (auto counter = counters.find(variable); counter != counters.end())
      return counter->second;
    return std::nullopt;
  }
  case ExprKind::Binary: {
    const auto &op = cast<typed::BinaryExpr>(expr);
    return range(op.op, *op.left, *op.right);
  }
  case ExprKind::Unary: {
    const auto &op = cast<typed::UnaryExpr>(expr);
    const std::optional<Interval> inner = range(*op.operand);
    if (op.op != typed::UnaryOp::Minus || !inner || inner->low == intMin)
      return std::nullopt;
    return Interval{-inner->high, -inner->low};
  }
  case ExprKind::Length:
    return Interval{0, intMax};
  case ExprKind::Convert:
    if (cast<typed::ConvertExpr>(expr).operand->type->is(TypeKind::Bool))
      return Interval{0, 1};
    return std::nullopt;
  case ExprKind::Builtin:
    switch (cast<typed::BuiltinExpr>(expr).builtin) {
    case typed::Builtin::DominantAxis:
      return Interval{0, 3};
    case typed::Builtin::BitCount:
      return Interval{0, 32};
    case typed::Builtin::FindLSB:
    case typed::Builtin::FindMSB:
      return Interval{-1, 31};
    default:
      return std::nullopt;
    }
  default:
    return std::nullopt;
  }
}

//===----------------------------------------------------------------------===//
// Operators
//===----------------------------------------------------------------------===//

/// The operator of C++ that is spelled alike.
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

/// A literal divisor that no dividend goes wrong with.
static bool isSafeDivisor(const typed::Expr &expr) {
  if (auto *convert = dynCast<typed::ConvertExpr>(&expr))
    return convert->operand->type->is(TypeKind::Int) && isSafeDivisor(*convert->operand);
  auto *literal = dynCast<typed::LiteralExpr>(&expr);
  return literal && literal->type->isScalar() && literal->value.scalars.front().i > 0;
}

std::optional<Operator> FunctionPrinter::plainOperator(BinaryOp op, const typed::Expr &left,
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
    if (isInt && !range(op, left, right))
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
  case BinaryOp::GreaterEqual: // of a uint and zero: compilers find that too plain
    return isUint && isZero(right) ? std::nullopt : std::optional(operatorFor(op));
  case BinaryOp::Greater:
  case BinaryOp::LessEqual:
    return isUint && isZero(left) ? std::nullopt : std::optional(operatorFor(op));
  default:
    return operatorFor(op);
  }
}

std::string FunctionPrinter::functionFor(BinaryOp op, const typed::Expr &left,
                                         const typed::Expr &right) {
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

void FunctionPrinter::compareStructs(const Type *type) {
  if (type->is(TypeKind::Array))
    return compareStructs(type->element);
  if (!type->is(TypeKind::Struct) || !context.required.comparedStructs.insert(type).second)
    return;
  for (const typed::Field &field : type->structure->fields)
    compareStructs(field.type);
}

// `a + b + c` of ints is `rtsl::add(a, b, c)`.
void FunctionPrinter::appendOperands(BinaryOp op, const typed::Expr &expr,
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

Code FunctionPrinter::binary(BinaryOp op, const typed::Expr &left, const typed::Expr &right) {
  const Operator own = operatorFor(op);
  if (op == BinaryOp::LogicalAnd || op == BinaryOp::LogicalOr) {
    const Code first = operand(left, Binding::BitOr), second = apart(right, Binding::BitOr);
    if (same(first, negated(second)) || same(second, negated(first))) // compilers find it odd
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
    return cpp::call(functionFor(op, left, right), operands(all, Binding::Assignment));
  }

  std::vector<Code> both;
  if (conflicts(context.effects.expression(left), context.effects.expression(right)))
    both = operands({&left, &right}, bindingOf(own));
  else
    both = {operand(left, bindingOf(own)), operand(right, bindingOf(own))};
  // Bools that lie in memory compare with those that do not as values do.
  if (op == BinaryOp::Equal || op == BinaryOp::NotEqual || op == BinaryOp::LogicalXor) {
    Code &stored = both[isInMemory(left) ? 0 : 1];
    if (left.type->isVector() && left.type->element->is(TypeKind::Bool) &&
        isInMemory(left) != isInMemory(right))
      stored = cpp::construct(context.types.of(left.type), {stored});
  }
  const bool compares = bindingOf(own) == Binding::Equality || bindingOf(own) == Binding::Relation;
  if (compares && left.type->scalar() && same(both[0], both[1])) { // compilers find `x == x` odd
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

Code FunctionPrinter::unary(const typed::UnaryExpr &expr) {
  if (expr.op == typed::UnaryOp::Not)
    return cpp::unary(UnaryOperator::Not, operand(*expr.operand, Binding::Unary));
  if (expr.op == typed::UnaryOp::BitNot)
    return cpp::unary(UnaryOperator::BitNot, operand(*expr.operand, Binding::Unary));
  const Type *type = expr.operand->type, *scalar = type->scalar();
  if (scalar && scalar->is(TypeKind::Int)) {
    if (auto *literal = dynCast<typed::LiteralExpr>(expr.operand);
        literal && literal->type->isScalar() && literal->value.scalars.front().i == intMin)
      return integer(intMin);
    if (!range(expr))
      return cpp::call("rtsl::negate", {argument(*expr.operand)});
  }
  // GLM subtracts four components from 0, and a zero keeps its sign then.
  if ((type->isVector() && type->count == 4) || (type->isMatrix() && type->rows() == 4))
    return cpp::call("rtsl::negate", {argument(*expr.operand)});
  return cpp::unary(UnaryOperator::Minus, operand(*expr.operand, Binding::Unary));
}

//===----------------------------------------------------------------------===//
// Assignments
//===----------------------------------------------------------------------===//

void FunctionPrinter::assignComponents(const Code &target, const std::vector<std::uint8_t> &parts,
                                       const Code &from, Statements &out) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    out.push_back(statement(cpp::assign(component(target, parts[i]), component(from, i))));
}

Code FunctionPrinter::incDec(const typed::IncDecExpr &expr, bool resultIsUsed) {
  const typed::Expr *vector = nullptr;
  const Type *scalar = expr.target->type->scalar();
  if (const std::vector<std::uint8_t> parts = components(*expr.target, vector);
      parts.size() > 1) { // `v.xy++`
    const Code old = hoist(expr.target->type, "value", argument(*expr.target));
    const Code changed = hoist(expr.target->type, "value", stepped(old, scalar, expr.increment));
    assignComponents(place(*vector), parts, changed, *before);
    return expr.prefix ? changed : old;
  }
  const Code target = place(*expr.target);
  // Where the value is used a function is plainer to compilers, which warn of `x = x++ + 1`.
  bool isSafe = !scalar->is(TypeKind::Int) && !resultIsUsed;
  if (auto *variable = dynCast<typed::VariableExpr>(expr.target))
    isSafe |= counters.count(variable->variable) != 0;
  if (!isSafe) {
    const char *name = expr.increment ? "rtsl::increment" : "rtsl::decrement";
    if (!expr.prefix && resultIsUsed)
      name = expr.increment ? "rtsl::postIncrement" : "rtsl::postDecrement";
    return cpp::call(name, {target});
  }
  const UnaryOperator op = expr.increment ? UnaryOperator::Increment : UnaryOperator::Decrement;
  return expr.prefix ? cpp::unary(op, target) : postfix(op, target);
}

Code FunctionPrinter::stepped(const Code &value, const Type *scalar, bool increment) {
  if (scalar->is(TypeKind::Int)) // may overflow
    return cpp::call(increment ? "rtsl::add" : "rtsl::subtract", {value, integer(1)});
  return cpp::binary(increment ? Operator::Add : Operator::Subtract, value,
                     cpp::literal(scalar->is(TypeKind::Float) ? "1.0f" : "1u"));
}

Code FunctionPrinter::assign(const typed::AssignExpr &expr, bool resultIsUsed) {
  const Effects value = context.effects.expression(*expr.value);
  const typed::Expr *vector = nullptr;
  const std::vector<std::uint8_t> parts = components(*expr.target, vector);
  const Effects indices = indexEffects(*expr.target);
  const bool storeIndices = conflicts(indices, value) || (parts.size() > 1 && !indices.isPure());

  // Indices that do something are evaluated once; the old value is kept if evaluating the new one
  // changes it.
  Code stored, old;
  const bool changesOld =
      expr.compound && conflicts(context.effects.expression(*expr.target), value);
  if (expr.compound && (changesOld || !indices.isPure())) {
    stored = place(parts.size() > 1 ? *vector : *expr.target, true);
    std::vector<Code> codes;
    for (std::uint8_t part : parts)
      codes.push_back(component(stored, part));
    old = hoist(expr.target->type, "value",
                parts.size() > 1 ? cpp::construct(context.types.of(expr.target->type), codes)
                                 : stored);
  }

  const std::optional<Operator> plain =
      expr.compound ? plainOperator(expr.op, *expr.target, *expr.value) : std::nullopt;
  auto combined = [&]() -> Code {
    if (!expr.compound) {
      // `a = b = c` stays as it is; an assignment anywhere else becomes a statement of its own.
      auto *inner = dynCast<typed::AssignExpr>(expr.value);
      if (inner && !replaced.count(inner) &&
          !conflicts(context.effects.expression(*expr.target), context.effects.expression(*inner)))
        return assign(*inner, true);
      return argument(*expr.value);
    }
    const Code left = old ? old : argument(*expr.target);
    if (plain)
      return cpp::binary(*plain, left, operand(*expr.value, bindingOf(*plain)));
    return cpp::call(functionFor(expr.op, *expr.target, *expr.value),
                     {left, argument(*expr.value)});
  };

  if (parts.size() > 1) { // `v.zx = ...`: component by component
    const Code target = stored ? stored : place(*vector, storeIndices);
    const bool isFree = !expr.compound && isSimple(*expr.value) &&
                        !conflicts(context.effects.expression(*vector), value);
    Code from = combined();
    // A simple value that is no part of the target can be named again and again.
    std::set<const void *> written = context.effects.expression(expr).writes;
    const bool overlaps = std::any_of(written.begin(), written.end(),
                                      [&](const void *at) { return value.reads.count(at) != 0; });
    if (!isFree || overlaps)
      from = hoist(expr.target->type, "value", from);
    assignComponents(target, parts, from, *before);
    return resultIsUsed ? from : Code();
  }

  if (expr.compound && plain && !old) {
    const Code target = place(*expr.target, storeIndices);
    return cpp::assign(*plain, target, argument(*expr.value));
  }
  const Code target = stored ? stored : place(*expr.target, storeIndices);
  return cpp::assign(target, combined());
}

} // namespace rtsl::cpp
