//===- Operators.cpp - operators and assignments --------------------------===//
//
// An operator of RTSL is one of C++ where that is always defined and means the same. An int may
// overflow, a divisor may be zero, a matrix product adds in RTSL's order: those are functions of
// the runtime header, unless it is plain from the operands that nothing can happen.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/Printer.h"

#include "codegen/lower/Analysis.h"
#include "sema/Casting.h"

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

std::optional<Interval> FunctionPrinter::range(BinaryOp op, const typed::Expr &left, const typed::Expr &right) {
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
    auto [low, high] = std::minmax({a->low * b->low, a->low * b->high, a->high * b->low, a->high * b->high});
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

static const char *spelling(BinaryOp op) {
  static const char *const spellings[] = {"*",  "/",  "%",  "+", "-", "<<", ">>", "<",  ">", "<=",
                                          ">=", "==", "!=", "&", "^", "|",  "&&", "!=", "||"};
  return spellings[static_cast<int>(op)];
}

static Binding bindingOf(BinaryOp op) {
  switch (op) {
  case BinaryOp::Mul:
  case BinaryOp::Div:
  case BinaryOp::Mod:
    return Binding::Product;
  case BinaryOp::Add:
  case BinaryOp::Sub:
    return Binding::Sum;
  case BinaryOp::Shl:
  case BinaryOp::Shr:
    return Binding::Shift;
  case BinaryOp::Less:
  case BinaryOp::Greater:
  case BinaryOp::LessEqual:
  case BinaryOp::GreaterEqual:
    return Binding::Relation;
  case BinaryOp::Equal:
  case BinaryOp::NotEqual:
  case BinaryOp::LogicalXor:
    return Binding::Equality;
  case BinaryOp::BitAnd:
    return Binding::BitAnd;
  case BinaryOp::BitXor:
    return Binding::BitXor;
  case BinaryOp::BitOr:
    return Binding::BitOr;
  case BinaryOp::LogicalAnd:
    return Binding::And;
  case BinaryOp::LogicalOr:
    return Binding::Or;
  }
  return Binding::Comma;
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

const char *FunctionPrinter::plainOperator(BinaryOp op, const typed::Expr &left, const typed::Expr &right) {
  const Type *l = left.type, *r = right.type;
  const bool hasMatrix = l->isMatrix() || r->isMatrix();
  const Type *scalar = l->scalar();
  const bool isInt = scalar && scalar->is(TypeKind::Int);
  const bool isUint = scalar && scalar->is(TypeKind::UInt);
  switch (op) {
  case BinaryOp::Mul:
    if (hasMatrix && !l->isScalar() && !r->isScalar())
      return nullptr;
    [[fallthrough]];
  case BinaryOp::Add:
  case BinaryOp::Sub:
    if (hasMatrix && (op != BinaryOp::Mul) && l != r)
      return nullptr;
    if (isInt && !range(op, left, right))
      return nullptr;
    return spelling(op);
  case BinaryOp::Div:
    if (hasMatrix && !r->isScalar())
      return nullptr;
    [[fallthrough]];
  case BinaryOp::Mod:
    if ((isInt || isUint) && !isSafeDivisor(right))
      return nullptr;
    return spelling(op);
  case BinaryOp::Shl:
  case BinaryOp::Shr: {
    auto *count = dynCast<typed::LiteralExpr>(&right);
    const bool isKnown = l->isScalar() && count && count->value.scalars.front().u < 32;
    return isKnown && (isUint || op == BinaryOp::Shr) ? spelling(op) : nullptr;
  }
  case BinaryOp::Less:
  case BinaryOp::GreaterEqual: // of a uint and zero: compilers find that too plain
    return isUint && isZero(right) ? nullptr : spelling(op);
  case BinaryOp::Greater:
  case BinaryOp::LessEqual:
    return isUint && isZero(left) ? nullptr : spelling(op);
  default:
    return spelling(op);
  }
}

std::string FunctionPrinter::functionFor(BinaryOp op, const typed::Expr &left, const typed::Expr &right) {
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
  if (!type->is(TypeKind::Struct) || !module.comparedStructs.insert(type).second)
    return;
  for (const typed::Field &field : type->structure->fields)
    compareStructs(field.type);
}

// `a + b + c` of ints is `rtsl::add(a, b, c)`.
void FunctionPrinter::appendOperands(BinaryOp op, const typed::Expr &expr, std::vector<const typed::Expr *> &into) {
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
  const Binding binding = bindingOf(op);
  if (op == BinaryOp::LogicalAnd || op == BinaryOp::LogicalOr) {
    // Compilers ask for parentheses round && beside ||.
    const Binding inner = op == BinaryOp::LogicalOr ? Binding::BitOr : Binding::And;
    auto side = [&](const typed::Expr &expr, bool isRight) {
      auto *nested = dynCast<typed::BinaryExpr>(&expr);
      const bool isSame = nested && nested->op == op && !isRight;
      const Binding atLeast = isSame ? binding : std::max(inner, Binding::BitOr);
      return isRight ? apart(expr, atLeast) : operand(expr, atLeast);
    };
    const std::string first = side(left, false), second = side(right, true);
    if (first == "!" + second || second == "!" + first) // compilers find it odd
      return {std::string(op == BinaryOp::LogicalAnd ? "rtsl::all" : "rtsl::any") + "(glm::bvec2(" + first + ", " +
              second + "))"};
    return {first + " " + spelling(op) + " " + second, binding};
  }
  if (op == BinaryOp::Equal || op == BinaryOp::NotEqual)
    compareStructs(left.type);

  const char *plain = plainOperator(op, left, right);
  if (!plain) {
    std::vector<const typed::Expr *> all;
    appendOperands(op, left, all);
    all.push_back(&right);
    return {functionFor(op, left, right) + "(" + join(operands(all, Binding::Assignment), ", ") + ")"};
  }

  // Operators whose order of binding is not common knowledge get parentheses.
  const bool isUncommon = binding >= Binding::BitOr && binding <= Binding::Shift;
  auto needed = [&](const typed::Expr &expr, bool isRight) {
    auto *nested = dynCast<typed::BinaryExpr>(&expr);
    const bool isSame = nested && nested->op == op && !isRight &&
                        (binding == Binding::BitOr || binding == Binding::BitXor || binding == Binding::BitAnd);
    if (isUncommon && !isSame)
      return Binding::Unary;
    return isRight ? static_cast<Binding>(static_cast<int>(binding) + 1) : binding;
  };
  const Binding forLeft = needed(left, false), forRight = needed(right, true);
  std::vector<std::string> both;
  if (conflicts(module.effects.expression(left), module.effects.expression(right)))
    both = operands({&left, &right}, forRight);
  else
    both = {operand(left, forLeft), operand(right, forRight)};
  // Bools that lie in memory compare with those that do not as values do.
  if (op == BinaryOp::Equal || op == BinaryOp::NotEqual || op == BinaryOp::LogicalXor) {
    if (left.type->isVector() && left.type->element->is(TypeKind::Bool) && isInMemory(left) != isInMemory(right))
      both[isInMemory(left) ? 0 : 1] = module.type(left.type) + "(" + both[isInMemory(left) ? 0 : 1] + ")";
  }
  if (both[0] == both[1] && binding >= Binding::Equality && binding <= Binding::Relation &&
      left.type->scalar()) {
    // Compilers find `x == x` odd.
    const std::string call = functionFor(op, left, right) + "(" + both[0] + ", " + both[1] + ")";
    if (left.type->isScalar())
      return {call};
    if (left.type->isVector() && op == BinaryOp::Equal)
      return {"rtsl::all(" + call + ")"};
    if (left.type->isVector() && op == BinaryOp::NotEqual)
      return {"rtsl::any(" + call + ")"};
  }
  if (both[1].front() == '-' && (op == BinaryOp::Sub || op == BinaryOp::Add))
    both[1] = "(" + both[1] + ")"; // a - -b
  return {both[0] + " " + plain + " " + both[1], binding};
}

Code FunctionPrinter::unary(const typed::UnaryExpr &expr) {
  if (expr.op == typed::UnaryOp::Not)
    return {"!" + operand(*expr.operand, Binding::Unary), Binding::Unary};
  if (expr.op == typed::UnaryOp::BitNot)
    return {"~" + operand(*expr.operand, Binding::Unary), Binding::Unary};
  const Type *scalar = expr.operand->type->scalar();
  if (scalar && scalar->is(TypeKind::Int)) {
    if (auto *literal = dynCast<typed::LiteralExpr>(expr.operand); literal && literal->type->isScalar() &&
                                                                   literal->value.scalars.front().i == intMin)
      return {"std::numeric_limits<int>::min()"};
    if (!range(expr))
      return {"rtsl::negate(" + argument(*expr.operand) + ")"};
  }
  // GLM subtracts four components from 0, and a zero keeps its sign then.
  const Type *type = expr.operand->type;
  if ((type->isVector() && type->count == 4) || (type->isMatrix() && type->rows() == 4))
    return {"rtsl::negate(" + argument(*expr.operand) + ")"};
  std::string text = operand(*expr.operand, Binding::Unary);
  if (text.front() == '-')
    text = "(" + text + ")";
  return {"-" + text, Binding::Unary};
}

//===----------------------------------------------------------------------===//
// Assignments
//===----------------------------------------------------------------------===//

Code FunctionPrinter::incDec(const typed::IncDecExpr &expr, bool resultIsUsed) {
  const typed::Expr *vector = nullptr;
  if (components(*expr.target, vector).size() > 1) { // `v.xy++`
    const std::string value = argument(*expr.target);
    const std::string old = hoist(expr.target->type, "value", value);
    const std::string one = expr.target->type->scalar()->is(TypeKind::Float)  ? "1.0f"
                            : expr.target->type->scalar()->is(TypeKind::UInt) ? "1u"
                                                                              : "1";
    const bool isInt = expr.target->type->scalar()->is(TypeKind::Int);
    const std::string sum = isInt ? fmt::format("rtsl::{}({}, 1)", expr.increment ? "add" : "subtract", old)
                                  : fmt::format("{} {} {}", old, expr.increment ? "+" : "-", one);
    const std::string changed = hoist(expr.target->type, "value", sum);
    const std::vector<std::uint8_t> parts = components(*expr.target, vector);
    const std::string target = place(*vector).text;
    for (std::size_t i = 0; i < parts.size(); ++i)
      before->push_back(fmt::format("{}.{} = {}.{};", target, "xyzw"[parts[i]], changed, "xyzw"[i]));
    return {expr.prefix ? changed : old};
  }
  const std::string target = place(*expr.target).text;
  const Type *scalar = expr.target->type->scalar();
  // Where the value is used a function is plainer to compilers, which warn of `x = x++ + 1`.
  bool isSafe = !scalar->is(TypeKind::Int) && !resultIsUsed;
  if (auto *variable = dynCast<typed::VariableExpr>(expr.target))
    isSafe |= counters.count(variable->variable) != 0;
  if (!isSafe) {
    const char *name = expr.increment ? "increment" : "decrement";
    if (!expr.prefix && resultIsUsed)
      name = expr.increment ? "postIncrement" : "postDecrement";
    return {fmt::format("rtsl::{}({})", name, target)};
  }
  const char *op = expr.increment ? "++" : "--";
  return {expr.prefix ? op + target : target + op, Binding::Unary};
}

Code FunctionPrinter::assign(const typed::AssignExpr &expr, bool resultIsUsed) {
  const Effects value = module.effects.expression(*expr.value);
  const typed::Expr *vector = nullptr;
  const std::vector<std::uint8_t> parts = components(*expr.target, vector);
  const Effects indices = indexEffects(*expr.target);
  const bool storeIndices = conflicts(indices, value) || (parts.size() > 1 && !indices.isPure());

  // Indices that do something are evaluated once; the old value is kept if evaluating the new one changes it.
  std::string stored, old;
  const bool changesOld = expr.compound && conflicts(module.effects.expression(*expr.target), value);
  if (expr.compound && (changesOld || !indices.isPure())) {
    stored = place(parts.size() > 1 ? *vector : *expr.target, true).text;
    std::vector<std::string> texts;
    for (std::uint8_t part : parts)
      texts.push_back(stored + "." + "xyzw"[part]);
    old = hoist(expr.target->type, "value",
                parts.size() > 1 ? module.type(expr.target->type) + "(" + join(texts, ", ") + ")" : stored);
  }

  auto combined = [&]() -> std::string {
    if (!expr.compound) {
      // `a = b = c` stays as it is; an assignment anywhere else becomes a statement of its own.
      auto *inner = dynCast<typed::AssignExpr>(expr.value);
      if (inner && !replaced.count(inner) && !conflicts(module.effects.expression(*expr.target), module.effects.expression(*inner)))
        return assign(*inner, true).text;
      return argument(*expr.value);
    }
    const char *plain = plainOperator(expr.op, *expr.target, *expr.value);
    const Binding binding = bindingOf(expr.op);
    const std::string left = !old.empty() ? old : argument(*expr.target);
    if (plain)
      return left + " " + plain + " " +
             operand(*expr.value, static_cast<Binding>(static_cast<int>(binding) + 1));
    return functionFor(expr.op, *expr.target, *expr.value) + "(" + left + ", " + argument(*expr.value) + ")";
  };

  if (parts.size() > 1) { // `v.zx = ...`: component by component
    const std::string target = !stored.empty() ? stored : place(*vector, storeIndices).text;
    const bool isFree = !expr.compound && isSimple(*expr.value) &&
                        !conflicts(module.effects.expression(*vector), value);
    std::string from = combined();
    // A simple value that is no part of the target can be named again and again.
    std::set<const void *> written = module.effects.expression(expr).writes;
    const bool overlaps = std::any_of(written.begin(), written.end(),
                                      [&](const void *at) { return value.reads.count(at) != 0; });
    if (!isFree || overlaps)
      from = hoist(expr.target->type, "value", from);
    for (std::size_t i = 0; i < parts.size(); ++i)
      before->push_back(fmt::format("{}.{} = {}.{};", target, "xyzw"[parts[i]], from, "xyzw"[i]));
    return {resultIsUsed ? from : ""};
  }

  const char *plain = expr.compound ? plainOperator(expr.op, *expr.target, *expr.value) : nullptr;
  if (expr.compound && plain && old.empty()) {
    const std::string target = place(*expr.target, storeIndices).text;
    return {target + " " + plain + "= " + argument(*expr.value), Binding::Assignment};
  }
  const std::string target = !stored.empty() ? stored : place(*expr.target, storeIndices).text;
  return {target + " = " + combined(), Binding::Assignment};
}

} // namespace rtsl::cpp
