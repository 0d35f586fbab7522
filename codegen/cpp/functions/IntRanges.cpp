#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Casting.h"

#include <algorithm>
#include <limits>

namespace rtsl::cpp {

using ast::BinaryOp;
using typed::ExprKind;

static constexpr std::int64_t intMin = std::numeric_limits<std::int32_t>::min();
static constexpr std::int64_t intMax = std::numeric_limits<std::int32_t>::max();

std::optional<Interval> IntRanges::range(BinaryOp op, const typed::Expr &left,
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

static std::optional<Interval> rangeOf(typed::Builtin builtin) {
  switch (builtin) {
#define RTSL_BUILTIN(...)
#define RTSL_RESULT_RANGE(id, low, high)                                                           \
  case typed::Builtin::id:                                                                         \
    return Interval{low, high};
#include "language/Builtins.def"
  default:
    return std::nullopt;
  }
}

std::optional<Interval> IntRanges::range(const typed::Expr &expr) {
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
    if (auto counter = printer.counters.find(variable); counter != printer.counters.end())
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
    return rangeOf(cast<typed::BuiltinExpr>(expr).builtin);
  default:
    return std::nullopt;
  }
}

} // namespace rtsl::cpp
