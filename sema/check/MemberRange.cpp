//===- MemberRange.cpp - `in [low, high]` after a name --------------------===//
#include "sema/check/FunctionChecker.h"
#include "sema/check/Program.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/Casting.h"

#include <algorithm>
#include <cmath>

namespace rtsl {

/// The type of the numbers that a value of this type consists of, to which a range applies; null if
/// it consists of something else.
static const Type *numberOf(const Type *type, const TypeContext &types) {
  while (type->is(TypeKind::Array) || type->is(TypeKind::Buffer))
    type = type->element;
  if (type->is(TypeKind::Color))
    return types.floatType;
  if (type->isVector())
    type = type->element;
  return type->isNumericScalar() ? type : nullptr;
}

static double toDouble(typed::Constant::Scalar scalar, const Type *type) {
  return type->is(TypeKind::Float) ? double(scalar.f)
         : type->is(TypeKind::Int) ? double(scalar.i)
                                   : double(scalar.u);
}

/// Is it `inf`, or `-inf` for the lower bound?
static bool isInfinity(const ast::Expr &bound, bool isLow) {
  const ast::Expr *expr = &bound;
  if (isLow) {
    const auto *negation = dynamic_cast<const ast::UnaryExpr *>(expr);
    if (!negation || negation->op != ast::UnaryOp::Minus)
      return false;
    expr = negation->operand.get();
  }
  const auto *name = dynamic_cast<const ast::NameExpr *>(expr);
  return name && name->name == "inf";
}

/// One bound; none, and reported, if it is not a constant of the member's numbers.
static std::optional<double> boundOf(FunctionChecker &checker, const ast::Expr &bound, bool isLow,
                                     const Type *number) {
  if (isInfinity(bound, isLow))
    return isLow ? -Range::unbounded : Range::unbounded;
  const typed::ExprPtr checked = checker.checkInitializer(bound, number);
  std::unique_ptr<typed::Constant> known;
  if (!checked || !checker.requireConstant(*checked, "the bound of a range", &known) || !known)
    return std::nullopt;
  return toDouble(known->scalars.front(), number);
}

/// The range that a member or parameter of this type has; none if none is written, or if it is
/// wrong, which is reported.
std::optional<Range> Program::rangeOf(FunctionChecker &checker, const ast::ValueRange &written,
                                      const Type *type) {
  if (!written.isGiven() || type->isError())
    return std::nullopt;
  const Type *number = numberOf(type, types);
  if (!number) {
    diagnostics.report(Code::misplacedRange, written.range,
                       "it is for numbers, vectors, colors, and arrays and buffers of them");
    return std::nullopt;
  }
  const std::optional<double> low = boundOf(checker, *written.low, true, number);
  const std::optional<double> high = boundOf(checker, *written.high, false, number);
  if (!low || !high)
    return std::nullopt;
  const bool includesLow = written.includesLow && std::isinf(*low);
  const bool includesHigh = written.includesHigh && std::isinf(*high);
  if (includesLow)
    diagnostics.report(Code::infiniteBound, written.lowBracket).fix(written.lowBracket, "(");
  if (includesHigh)
    diagnostics.report(Code::infiniteBound, written.highBracket).fix(written.highBracket, ")");
  if (includesLow || includesHigh)
    return std::nullopt;
  const Range range{*low, *high, written.includesLow, written.includesHigh};
  if (!range.isEmpty())
    return range;
  diagnostics.report(Code::emptyRange, written.range, toString(range));
  return std::nullopt;
}

/// Sets the range of a member whose type and default are known, and checks the default.
void Program::checkRange(FunctionChecker &checker, const ast::VariableDecl &declaration,
                         typed::Member &member) {
  const ast::ValueRange &written = declaration.values;
  const char *whyNot = !written.isGiven()                     ? nullptr
                       : member.access != ast::Access::Public ? "the scene sets public members only"
                       : declaration.directionRange.isValid() ? "the program writes this buffer"
                                                              : nullptr;
  if (whyNot) {
    diagnostics.report(Code::misplacedRange, written.range, whyNot);
    return;
  }
  member.values = rangeOf(checker, written, member.type);
  if (!member.values || !member.init)
    return;

  const std::optional<typed::Constant> known = evaluate(*member.init);
  const Type *number = numberOf(member.type, types);
  const auto isOutside = [&](typed::Constant::Scalar scalar) {
    return !member.values->contains(toDouble(scalar, number));
  };
  if (known && std::any_of(known->scalars.begin(), known->scalars.end(), isOutside))
    diagnostics
        .report(Code::defaultOutOfRange, declaration.init->range, member.name,
                toString(*member.values))
        .label(written.range, "the range");
}

} // namespace rtsl
