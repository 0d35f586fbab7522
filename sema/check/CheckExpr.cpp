//===- CheckExpr.cpp - expressions: the common part, literals, conversions ===//
#include "sema/check/FunctionChecker.h"
#include "sema/fold/ConstantFold.h"

#include <charconv>
#include <cmath>

namespace rtsl {

using typed::ExprPtr;

ExprPtr FunctionChecker::errorExpr(SourceRange range) {
  return makeExpr<typed::LiteralExpr>(types.error, range);
}

ExprPtr FunctionChecker::literal(const Type *type, SourceRange range, typed::Constant value,
                                 std::string spelling) {
  auto node = makeExpr<typed::LiteralExpr>(type, range);
  node->value = std::move(value);
  node->spelling = std::move(spelling);
  return node;
}

ExprPtr FunctionChecker::checkExpr(const ast::Expr &expr, Access access) {
  if (recursion >= maxRecursion || treeDepth >= maxTreeDepth) {
    diagnostics.report(Code::expressionTooDeep, expr.range, std::min(maxRecursion, maxTreeDepth));
    return errorExpr(expr.range);
  }
  ++recursion;
  ++treeDepth;
  ExprPtr result = dispatch(expr, access);
  --treeDepth;
  --recursion;
  return result;
}

ExprPtr FunctionChecker::dispatch(const ast::Expr &expr, Access access) {
  switch (expr.kind) {
  case ast::ExprKind::IntLiteral:
    return checkIntLiteral(cast<ast::IntLiteral>(expr), false);
  case ast::ExprKind::FloatLiteral:
    return checkFloatLiteral(cast<ast::FloatLiteral>(expr));
  case ast::ExprKind::BoolLiteral: {
    const bool value = cast<ast::BoolLiteral>(expr).value;
    return literal(types.boolType, expr.range, {{makeBool(value)}}, value ? "true" : "false");
  }
  case ast::ExprKind::StringLiteral: {
    auto node = makeExpr<typed::StringExpr>(types.string, expr.range);
    node->value = cast<ast::StringLiteral>(expr).value;
    return node;
  }
  case ast::ExprKind::Name:
    return checkName(cast<ast::NameExpr>(expr), access);
  case ast::ExprKind::Paren: {
    ExprPtr inner = checkExpr(*cast<ast::ParenExpr>(expr).inner, access);
    inner->range = expr.range;
    return inner;
  }
  case ast::ExprKind::Unary: {
    const auto &unary = cast<ast::UnaryExpr>(expr);
    return unary.op >= ast::UnaryOp::PreIncrement ? checkIncDec(unary) : checkUnary(unary);
  }
  case ast::ExprKind::Binary:
    return checkBinaryChain(cast<ast::BinaryExpr>(expr));
  case ast::ExprKind::Assign:
    return checkAssign(cast<ast::AssignExpr>(expr));
  case ast::ExprKind::Conditional:
    return checkConditional(cast<ast::ConditionalExpr>(expr));
  case ast::ExprKind::Comma: {
    const auto &comma = cast<ast::CommaExpr>(expr);
    ExprPtr left = checkOperand(*comma.left);
    ExprPtr right = checkOperand(*comma.right);
    auto node = makeExpr<typed::CommaExpr>(right->type, expr.range);
    node->left = std::move(left);
    node->right = std::move(right);
    return node;
  }
  case ast::ExprKind::Call:
    return checkCall(cast<ast::CallExpr>(expr));
  case ast::ExprKind::Construct: {
    const auto &construct = cast<ast::ConstructExpr>(expr);
    if (!construct.type.dimensions.empty() && !construct.type.dimensions[0].size)
      return constructUnsizedArray(construct);
    return checkConstruct(resolveType(construct.type, nullptr), construct.type.range,
                          construct.args, expr.range);
  }
  case ast::ExprKind::Member:
    return checkMember(cast<ast::MemberExpr>(expr), access);
  case ast::ExprKind::Index:
    return checkIndex(cast<ast::IndexExpr>(expr), access);
  case ast::ExprKind::InitializerList:
    diagnostics.report(Code::misplacedInitializerList, expr.range);
    return errorExpr(expr.range);
  case ast::ExprKind::Error:
    break;
  }
  return errorExpr(expr.range);
}

ExprPtr FunctionChecker::requireValue(ExprPtr expr) {
  if (expr->type->is(TypeKind::Void))
    diagnostics.report(Code::voidValue, expr->range);
  else if (expr->type->is(TypeKind::Buffer))
    diagnostics.report(Code::bufferAsValue, expr->range).note("use an element, or its `.length()`");
  else if (expr->type->is(TypeKind::String))
    diagnostics.report(Code::stringAsValue, expr->range);
  else
    return expr;
  return errorExpr(expr->range);
}

ExprPtr FunctionChecker::checkOperand(const ast::Expr &expr) {
  ExprPtr checked = checkExpr(expr);
  return checked->type->is(TypeKind::Void) ? std::move(checked) : requireValue(std::move(checked));
}

ExprPtr FunctionChecker::checkValue(const ast::Expr &expr, Access access) {
  return requireValue(checkExpr(expr, access));
}

ExprPtr FunctionChecker::testReference(ExprPtr expr) {
  return expr->type->is(TypeKind::Class) ? convertTo(std::move(expr), types.boolType)
                                         : std::move(expr);
}

ExprPtr FunctionChecker::checkCondition(const ast::Expr &expr) {
  ExprPtr condition = testReference(checkValue(expr));
  if (condition->type->is(TypeKind::Bool) || condition->type->isError())
    return condition;
  Diagnostic &diagnostic =
      diagnostics.report(Code::conditionNotBool, condition->range, toString(condition->type));
  if (condition->type->isNumericScalar()) {
    const char *zero = condition->type->is(TypeKind::Float)  ? " != 0.0"
                       : condition->type->is(TypeKind::UInt) ? " != 0u"
                                                             : " != 0";
    if (expr.kind == ast::ExprKind::Assign)
      diagnostic.note("did you mean `==`?");
    else
      diagnostic.fix(condition->range, sourceText(condition->range) + zero);
  } else if (condition->type->isVector() && condition->type->element->is(TypeKind::Bool)) {
    diagnostic.note("write `all(...)` or `any(...)`");
  }
  return errorExpr(condition->range);
}

//===----------------------------------------------------------------------===//
// Literals
//===----------------------------------------------------------------------===//

ExprPtr FunctionChecker::checkIntLiteral(const ast::IntLiteral &literalExpr, bool negated) {
  // Hexadecimal and octal literals denote bits: 0xffffffff is -1. Decimal ones denote numbers.
  const bool isDecimal = literalExpr.spelling.empty() || literalExpr.spelling[0] != '0';
  const std::uint64_t largest = literalExpr.isUnsigned || !isDecimal ? 0xffffffffull
                                : negated                            ? 0x80000000ull
                                                                     : 0x7fffffffull;
  if (literalExpr.value > largest) {
    const bool fitsUnsigned = literalExpr.value <= 0xffffffffull;
    Diagnostic &diagnostic =
        diagnostics.report(Code::literalTooLarge, literalExpr.range, sourceText(literalExpr.range),
                           literalExpr.isUnsigned ? "uint" : "int");
    if (fitsUnsigned && !negated)
      diagnostic.fix({literalExpr.range.file, literalExpr.range.end, literalExpr.range.end}, "u");
    return errorExpr(literalExpr.range);
  }
  const auto bits = static_cast<std::uint32_t>(literalExpr.value);
  return literal(literalExpr.isUnsigned ? types.uintType : types.intType, literalExpr.range,
                 {{makeUInt(bits)}}, literalExpr.spelling);
}

ExprPtr FunctionChecker::checkFloatLiteral(const ast::FloatLiteral &literalExpr) {
  float value = 0.0f;
  const char *begin = literalExpr.spelling.data(), *end = begin + literalExpr.spelling.size();
  // Decimal to binary32 directly: going through double would round twice.
  const std::from_chars_result result = std::from_chars(begin, end, value);
  if (result.ec == std::errc::result_out_of_range) {
    // The library does not report overflow or underflow; the double shows which.
    double wide = 0.0;
    const bool wideInRange = std::from_chars(begin, end, wide).ec == std::errc();
    const std::size_t exponent = literalExpr.spelling.find_first_of("eE");
    const bool tiny = wideInRange ? std::fabs(wide) < 1.0
                                  : exponent != std::string::npos &&
                                        exponent + 1 < literalExpr.spelling.size() &&
                                        literalExpr.spelling[exponent + 1] == '-';
    if (!tiny) {
      diagnostics.report(Code::floatTooLarge, literalExpr.range, sourceText(literalExpr.range))
          .note("the largest float is 3.40282347e38");
      return errorExpr(literalExpr.range);
    }
    diagnostics.report(Code::floatUnderflows, literalExpr.range, sourceText(literalExpr.range))
        .note("the smallest float above zero is 1.4e-45");
    value = 0.0f;
  }
  return literal(types.floatType, literalExpr.range, {{makeFloat(value)}}, literalExpr.spelling);
}

//===----------------------------------------------------------------------===//
// Conversions
//===----------------------------------------------------------------------===//

/// Explains how to convert one type to the other, if that is possible.
void FunctionChecker::explainConversion(Diagnostic &diagnostic, const typed::Expr &expr,
                                        const Type *to) {
  const Type *from = expr.type;
  const std::string text = sourceText(expr.range);
  auto wrap = [&](const std::string &function, bool sure = false) {
    // `(1.0, 0.5, 0.2)` is a comma expression, but was meant as a list of components.
    const bool isList = expr.kind == typed::ExprKind::Comma && !to->isScalar() &&
                        expr.range.begin < cast<typed::CommaExpr>(expr).left->range.begin;
    diagnostic.fix(expr.range, function + (isList ? text : "(" + text + ")"), sure);
  };
  // Conversions that C makes implicitly, and that keep the value.
  const bool isNumeric = from->scalar() && from->scalar()->isNumericScalar() && to->scalar() &&
                         to->scalar()->isNumericScalar();
  if (to->is(TypeKind::Color)) {
    diagnostic.note(
        "the number of components of a color depends on the target, so there are no implicit "
        "conversions to it");
    if (from->isNumericScalar())
      wrap("color");
    else if (from->isVector() && from->count == 3 && from->element->is(TypeKind::Float) &&
             (expr.kind == typed::ExprKind::Variable || expr.kind == typed::ExprKind::Member))
      diagnostic.fix(expr.range, "color(" + text + ".r, " + text + ".g, " + text + ".b)");
    else if (from->isVector())
      diagnostic.note("`color(r, g, b)` constructs a color from three numbers");
  } else if (from->is(TypeKind::Color)) {
    diagnostic.note("the number of components of a color depends on the target");
    if (to->is(TypeKind::Float))
      wrap("luminance");
  } else if (from->isScalar() && to->isScalar()) {
    wrap(toString(to), isNumeric);
  } else if (from->isVector() && to->isVector() && from->count == to->count) {
    wrap(toString(to), isNumeric);
  } else if (from->isVector() && to->isVector() && from->element == to->element &&
             from->count > to->count) {
    diagnostic.fix({expr.range.file, expr.range.end, expr.range.end},
                   to->count == 2 ? ".xy" : ".xyz");
  } else if (from->isScalar() && to->isVector() &&
             implicitConversion(from, to->element) != Conversion::None) {
    wrap(toString(to));
  } else if (from->is(TypeKind::Class) && to->is(TypeKind::Class) && from->classType &&
             to->classType && to->classType->derivesFrom(from->classType)) {
    diagnostic.note("a reference to `" + toString(from) +
                    "` may refer to an object that is not a `" + toString(to) + "`");
  }
}

ExprPtr FunctionChecker::coerce(ExprPtr expr, const Type *to, const Label &label) {
  if (implicitConversion(expr->type, to) != Conversion::None)
    return to->isError() ? errorExpr(expr->range) : convertImplicitly(std::move(expr), to);
  Diagnostic &diagnostic =
      diagnostics.report(Code::noConversion, expr->range, toString(expr->type), toString(to));
  if (!label.text.empty())
    diagnostic.label(label.range, label.text);
  explainConversion(diagnostic, *expr, to);
  return errorExpr(expr->range);
}

ExprPtr FunctionChecker::convertImplicitly(ExprPtr expr, const Type *to) {
  const auto *quotient = dynCast<typed::BinaryExpr>(expr.get());
  // A constant divisor is usually meant: `x / 2` is the middle.
  const auto isOf = [](const Type *type, TypeKind kind) {
    return type->scalar() && type->scalar()->is(kind);
  };
  const bool isWhole = isOf(expr->type, TypeKind::Int) || isOf(expr->type, TypeKind::UInt);
  if (quotient && quotient->op == ast::BinaryOp::Div && isWhole && isOf(to, TypeKind::Float) &&
      !evaluate(*quotient->right)) {
    const typed::Expr &left = *quotient->left;
    const Type *exact = withScalar(left.type, types.floatType, types);
    diagnostics.report(Code::quotientTruncated, expr->range, toString(to))
        .note("if that is meant, write `" + toString(exact) + "(...)` around the quotient")
        .fix(left.range, toString(exact) + "(" + sourceText(left.range) + ")");
  }
  return convertTo(std::move(expr), to);
}

ExprPtr FunctionChecker::checkConditional(const ast::ConditionalExpr &expr) {
  ExprPtr condition = checkCondition(*expr.condition);
  ExprPtr whenTrue = checkValue(*expr.whenTrue);
  ExprPtr whenFalse = checkValue(*expr.whenFalse);
  if (condition->type->isError() || whenTrue->type->isError() || whenFalse->type->isError())
    return errorExpr(expr.range);
  const Type *type = nullptr;
  if (implicitConversion(whenFalse->type, whenTrue->type) != Conversion::None)
    type = whenTrue->type;
  else if (implicitConversion(whenTrue->type, whenFalse->type) != Conversion::None)
    type = whenFalse->type;
  if (!type) {
    diagnostics
        .report(Code::branchesDiffer, expr.range, toString(whenTrue->type),
                toString(whenFalse->type))
        .label(whenTrue->range, "this is `" + toString(whenTrue->type) + "`")
        .label(whenFalse->range, "this is `" + toString(whenFalse->type) + "`");
    return errorExpr(expr.range);
  }
  auto node = makeExpr<typed::ConditionalExpr>(type, expr.range);
  node->condition = std::move(condition);
  node->whenTrue = convertImplicitly(std::move(whenTrue), type);
  node->whenFalse = convertImplicitly(std::move(whenFalse), type);
  return node;
}

bool FunctionChecker::requireConstant(const typed::Expr &init, const std::string &what,
                                      std::unique_ptr<typed::Constant> *value) {
  if (init.type->isError())
    return false;
  const typed::Expr *obstacle = nullptr;
  if (std::optional<typed::Constant> folded = evaluate(init, &obstacle)) {
    if (value)
      *value = std::make_unique<typed::Constant>(std::move(*folded));
    return true;
  }
  // A constant whose value is not known here is sufficient, unless `value` is required.
  const typed::Expr *notConstant = nullptr;
  if (isConstantExpression(init, &notConstant) && value)
    return true;
  if (notConstant)
    obstacle = notConstant;
  if (!obstacle)
    return false;
  Diagnostic &diagnostic = diagnostics.report(Code::notConstant, obstacle->range, what);
  if (const auto *variable = dynCast<typed::VariableExpr>(obstacle))
    diagnostic.label(variable->variable->range,
                     "`" + variable->variable->name + "` is not constant");
  return false;
}

} // namespace rtsl
