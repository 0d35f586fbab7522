//===- CheckOperators.cpp - operators and assignment ----------------------===//
#include "sema/check/FunctionChecker.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/TypeProperties.h"

#include <algorithm>

namespace rtsl {

using ast::BinaryOp;
using typed::ExprPtr;

const char *spelling(BinaryOp op) {
  static const char *const spellings[] = {"*",  "/",  "%",  "+", "-", "<<", ">>", "<",  ">", "<=",
                                          ">=", "==", "!=", "&", "^", "|",  "&&", "^^", "||"};
  return spellings[static_cast<int>(op)];
}

static bool isComparison(BinaryOp op) {
  return op >= BinaryOp::Less && op <= BinaryOp::GreaterEqual;
}
static bool isEquality(BinaryOp op) {
  return op == BinaryOp::Equal || op == BinaryOp::NotEqual;
}
static bool isLogical(BinaryOp op) {
  return op >= BinaryOp::LogicalAnd;
}
static bool isShift(BinaryOp op) {
  return op == BinaryOp::Shl || op == BinaryOp::Shr;
}
static bool isBitwise(BinaryOp op) {
  return op >= BinaryOp::BitAnd && op <= BinaryOp::BitOr;
}
static bool isInteger(const Type *type) {
  return type && (type->is(TypeKind::Int) || type->is(TypeKind::UInt));
}
static bool isNumeric(const Type *type) {
  return type && type->isNumericScalar();
}

//===----------------------------------------------------------------------===//
// Unary operators
//===----------------------------------------------------------------------===//

ExprPtr FunctionChecker::checkUnary(const ast::UnaryExpr &expr) {
  static const char *const spellings[] = {"+", "-", "!", "~"};
  // The smallest int is written as the negation of a number that does not fit into int.
  ExprPtr operand;
  if (const auto *number = dynCast<ast::IntLiteral>(expr.operand);
      number && expr.op == ast::UnaryOp::Minus)
    operand = checkIntLiteral(*number, true);
  else
    operand = checkValue(*expr.operand);
  if (expr.op == ast::UnaryOp::Not)
    operand = testReference(std::move(operand));
  const Type *type = operand->type, *scalar = type->scalar();
  if (type->isError())
    return errorExpr(expr.range);
  bool fits = false;
  switch (expr.op) {
  case ast::UnaryOp::Plus:
  case ast::UnaryOp::Minus:
    fits = isNumeric(scalar) || type->is(TypeKind::Color);
    break;
  case ast::UnaryOp::Not:
    fits = type->is(TypeKind::Bool);
    break;
  default:
    fits = isInteger(scalar);
    break;
  }
  const char *opSpelling = spellings[static_cast<int>(expr.op)];
  if (!fits) {
    Diagnostic &diagnostic =
        diagnostics.report(Code::badOperand, expr.opRange, opSpelling, toString(type));
    diagnostic.label(operand->range, "this is `" + toString(type) + "`");
    if (expr.op == ast::UnaryOp::Not && type->isVector() && scalar->is(TypeKind::Bool))
      diagnostic.note("`not(v)` inverts each component");
    return errorExpr(expr.range);
  }
  if (expr.op == ast::UnaryOp::Plus)
    return operand;
  auto node = makeExpr<typed::UnaryExpr>(type, expr.range);
  node->op = expr.op == ast::UnaryOp::Minus ? typed::UnaryOp::Minus
             : expr.op == ast::UnaryOp::Not ? typed::UnaryOp::Not
                                            : typed::UnaryOp::BitNot;
  node->operand = std::move(operand);
  return node;
}

ExprPtr FunctionChecker::checkIncDec(const ast::UnaryExpr &expr) {
  const bool increment =
      expr.op == ast::UnaryOp::PreIncrement || expr.op == ast::UnaryOp::PostIncrement;
  const bool prefix =
      expr.op == ast::UnaryOp::PreIncrement || expr.op == ast::UnaryOp::PreDecrement;
  ExprPtr target = checkValue(*expr.operand, Access::ReadWrite);
  if (target->type->isError())
    return errorExpr(expr.range);
  const char *opSpelling = increment ? "++" : "--";
  if (!isNumeric(target->type->scalar())) {
    diagnostics.report(Code::badOperand, expr.opRange, opSpelling, toString(target->type))
        .label(target->range, "this is `" + toString(target->type) + "`");
    return errorExpr(expr.range);
  }
  if (!requireTarget(*expr.operand, *target, increment ? "increment" : "decrement"))
    return errorExpr(expr.range);
  auto node = makeExpr<typed::IncDecExpr>(target->type, expr.range);
  node->increment = increment;
  node->prefix = prefix;
  node->target = std::move(target);
  return node;
}

//===----------------------------------------------------------------------===//
// Binary operators
//===----------------------------------------------------------------------===//

/// The tree of `a + b + c + ...` is as deep as the chain is long: its left spine is walked in a
/// loop.
ExprPtr FunctionChecker::checkBinaryChain(const ast::BinaryExpr &expr) {
  std::vector<const ast::BinaryExpr *> spine;
  const ast::Expr *first = &expr;
  for (; first->kind == ast::ExprKind::Binary; first = cast<ast::BinaryExpr>(*first).left.get())
    spine.push_back(static_cast<const ast::BinaryExpr *>(first));
  if (treeDepth + spine.size() > maxTreeDepth) {
    diagnostics.report(Code::expressionTooDeep, expr.range, maxTreeDepth)
        .note("store parts of the expression in variables");
    return errorExpr(expr.range);
  }
  const unsigned outerDepth = treeDepth;
  treeDepth += static_cast<unsigned>(spine.size());
  ExprPtr left = checkValue(*first);
  for (auto op = spine.rbegin(); op != spine.rend(); ++op) {
    --treeDepth;
    ExprPtr right = checkValue(*(*op)->right);
    left = combine(**op, std::move(left), std::move(right));
  }
  treeDepth = outerDepth;
  return left;
}

ExprPtr FunctionChecker::combine(const ast::BinaryExpr &expr, ExprPtr left, ExprPtr right) {
  if (left->type->isError() || right->type->isError())
    return errorExpr(expr.range);
  const Type *type = operandTypes(expr.op, left, right, false);
  if (!type) {
    reportOperands(expr.op, expr.opRange, *left, *right);
    return errorExpr(expr.range);
  }
  warnAboutConstants(expr.op, *right);
  auto node = makeExpr<typed::BinaryExpr>(type, expr.range);
  node->op = expr.op;
  node->left = std::move(left);
  node->right = std::move(right);
  return node;
}

/// `leftFixed`: the left operand is the target of a compound assignment and keeps its type.
const Type *FunctionChecker::operandTypes(BinaryOp op, ExprPtr &left, ExprPtr &right,
                                          bool leftFixed) {
  const Type *l = left->type, *r = right->type;
  if (isLogical(op) && !l->isError() && !r->isError()) {
    left = testReference(std::move(left));
    right = testReference(std::move(right));
    l = left->type;
    r = right->type;
  }
  if (isLogical(op))
    return l->is(TypeKind::Bool) && r->is(TypeKind::Bool) ? types.boolType : nullptr;

  if (isEquality(op)) {
    if (contains(l, TypeKind::Color) || contains(r, TypeKind::Color))
      return nullptr;
    if (implicitConversion(r, l) != Conversion::None)
      right = convertImplicitly(std::move(right), l);
    else if (implicitConversion(l, r) != Conversion::None)
      left = convertImplicitly(std::move(left), r);
    else
      return nullptr;
    return types.boolType;
  }

  const Type *ls = l->scalar(), *rs = r->scalar();
  if (isShift(op)) {
    // The type is that of the left operand; a vector may be shifted by a scalar.
    if (!isInteger(ls) || !isInteger(rs) ||
        (r->isVector() && (!l->isVector() || l->count != r->count)))
      return nullptr;
    return l;
  }
  if (isComparison(op) && (!l->isScalar() || !r->isScalar()))
    return nullptr;
  if ((isBitwise(op) || op == BinaryOp::Mod) && (!isInteger(ls) || !isInteger(rs)))
    return nullptr;
  if (l->is(TypeKind::Color) || r->is(TypeKind::Color))
    return colorTypes(op, left, right);
  const Type *result = arithmeticTypes(op, left, right, leftFixed);
  return result && isComparison(op) ? types.boolType : result;
}

/// Componentwise with a color on both sides; a float may be on either side of `*` and `/`.
const Type *FunctionChecker::colorTypes(BinaryOp op, ExprPtr &left, ExprPtr &right) {
  if (op != BinaryOp::Mul && op != BinaryOp::Div && op != BinaryOp::Add && op != BinaryOp::Sub)
    return nullptr;
  if (left->type == right->type)
    return types.color;
  ExprPtr &other = left->type->is(TypeKind::Color) ? right : left;
  if ((op != BinaryOp::Mul && op != BinaryOp::Div) || !other->type->isNumericScalar())
    return nullptr;
  other = convertImplicitly(std::move(other), types.floatType);
  return types.color;
}

const Type *FunctionChecker::arithmeticTypes(BinaryOp op, ExprPtr &left, ExprPtr &right,
                                             bool leftFixed) {
  const Type *ls = left->type->scalar(), *rs = right->type->scalar();
  if (!isNumeric(ls) || !isNumeric(rs))
    return nullptr;
  const Type *common = widerScalar(ls, rs);
  if (leftFixed && common != ls)
    return nullptr;

  // The shapes.
  const Type *l = withScalar(left->type, common, types),
             *r = withScalar(right->type, common, types);
  const Type *result = nullptr;
  if (op == BinaryOp::Mul && l->isMatrix() && r->isMatrix())
    result = l->columns() == r->rows() ? types.matrix(r->columns(), l->rows()) : nullptr;
  else if (op == BinaryOp::Mul && l->isMatrix() && r->isVector())
    result = l->columns() == r->count ? types.vector(common, l->rows()) : nullptr;
  else if (op == BinaryOp::Mul && l->isVector() && r->isMatrix())
    result = l->count == r->rows() ? types.vector(common, r->columns()) : nullptr;
  else if (l == r || r->isScalar())
    result = l;
  else if (l->isScalar())
    result = r;
  if (!result)
    return nullptr;
  left = convertImplicitly(std::move(left), l);
  right = convertImplicitly(std::move(right), r);
  return result;
}

void FunctionChecker::reportOperands(BinaryOp op, SourceRange opRange, const typed::Expr &left,
                                     const typed::Expr &right) {
  const Type *l = left.type, *r = right.type;
  Diagnostic &diagnostic =
      diagnostics.report(Code::badOperands, opRange, spelling(op), toString(l), toString(r));
  diagnostic.label(left.range, "this is `" + toString(l) + "`");
  diagnostic.label(right.range, "this is `" + toString(r) + "`");

  const bool leftColor = l->is(TypeKind::Color), rightColor = r->is(TypeKind::Color);
  const typed::Expr &other = leftColor ? right : left;
  if (contains(l, TypeKind::Color) || contains(r, TypeKind::Color)) {
    if (isEquality(op) || isComparison(op))
      diagnostic.note("colors cannot be compared: their number of components depends on the "
                      "target; compare their "
                      "`luminance`");
    else if ((leftColor != rightColor) && other.type->isNumericScalar())
      diagnostic.fix(other.range, "color(" + sourceText(other.range) + ")");
    else if (leftColor != rightColor)
      diagnostic.note("the number of components of a color depends on the target; `color(r, g, b)` "
                      "constructs one from three "
                      "numbers");
    return;
  }
  const Type *ls = l->scalar(), *rs = r->scalar();
  if (op == BinaryOp::Mod && isNumeric(ls) && isNumeric(rs))
    diagnostic.note("`%` takes integers; write `mod(x, y)`");
  else if (isLogical(op) && isNumeric(ls))
    diagnostic.note("a number is not a condition: compare it");
  else if (isComparison(op) && l->isVector() && r->isVector()) {
    const char *const functions[] = {"lessThan", "greaterThan", "lessThanEqual",
                                     "greaterThanEqual"};
    diagnostic.note(std::string("`") +
                    functions[static_cast<int>(op) - static_cast<int>(BinaryOp::Less)] +
                    "(a, b)` compares by component");
  } else if (isNumeric(ls) && isNumeric(rs) && l->isVector() && r->isVector() &&
             l->count != r->count)
    diagnostic.note("the vectors have " + std::to_string(l->count) + " and " +
                    std::to_string(r->count) + " components");
  else if (op == BinaryOp::Mul && (l->isMatrix() || r->isMatrix()))
    diagnostic.note("a matrix with n columns takes a vector or matrix with n rows on its right");
  else if ((ls && ls->is(TypeKind::Bool)) != (rs && rs->is(TypeKind::Bool)) && ls && rs)
    diagnostic.note("a `bool` is not a number; `float(b)` and `int(b)` give 0 or 1");
}

/// Division of integers by a constant zero and shifts by too much are defined, but surely mistakes.
void FunctionChecker::warnAboutConstants(BinaryOp op, const typed::Expr &right) {
  const bool isDivision = op == BinaryOp::Div || op == BinaryOp::Mod;
  if ((!isDivision && !isShift(op)) || !isInteger(right.type->scalar()))
    return;
  const std::optional<typed::Constant> value = evaluate(right);
  if (!value)
    return;
  for (typed::Constant::Scalar scalar : value->scalars) {
    if (isDivision && scalar.u == 0) {
      diagnostics.report(Code::divisionByZero, right.range).note("the result is 0");
      return;
    }
    if (isShift(op) && scalar.u > 31) {
      diagnostics.report(Code::shiftTooFar, right.range, toString(right.type))
          .note("only the lowest five bits count");
      return;
    }
  }
}

//===----------------------------------------------------------------------===//
// Assignment
//===----------------------------------------------------------------------===//

ExprPtr FunctionChecker::checkAssign(const ast::AssignExpr &expr) {
  ExprPtr target = checkValue(*expr.target, expr.compound ? Access::ReadWrite : Access::Write);
  ExprPtr value = checkValue(*expr.value);
  if (target->type->isError() || value->type->isError())
    return errorExpr(expr.range);
  if (!requireTarget(*expr.target, *target, "assign to"))
    return errorExpr(expr.range);
  if (expr.compound) {
    const Type *result = operandTypes(expr.op, target, value, true);
    if (!result || result != target->type) {
      // Either the operator does not take such operands at all, or its result cannot be converted
      // to the type of the target.
      ExprPtr left = makeExpr<typed::LiteralExpr>(target->type, target->range);
      ExprPtr right = makeExpr<typed::LiteralExpr>(value->type, value->range);
      const Type *free = result ? result : operandTypes(expr.op, left, right, false);
      if (!free)
        reportOperands(expr.op, expr.opRange, *target, *value);
      else
        diagnostics
            .report(Code::compoundDoesNotFit, expr.opRange, spelling(expr.op), toString(free),
                    toString(target->type))
            .label(target->range, "this is `" + toString(target->type) + "`")
            .label(value->range, "this is `" + toString(value->type) + "`");
      return errorExpr(expr.range);
    }
    warnAboutConstants(expr.op, *value);
  } else {
    value = coerce(std::move(value), target->type,
                   Label{target->range, "this is `" + toString(target->type) + "`"});
    if (value->type->isError())
      return errorExpr(expr.range);
    const auto *from = dynCast<typed::VariableExpr>(value);
    const auto *to = dynCast<typed::VariableExpr>(target);
    if (from && to && from->variable == to->variable) {
      Diagnostic &diagnostic =
          diagnostics.report(Code::selfAssignment, expr.range, to->variable->name);
      if (scope)
        if (const typed::Member *member = program.findMember(scope, to->variable->name))
          diagnostic.label(member->range,
                           "this member is hidden by the parameter or variable of the same name");
    }
  }
  auto node = makeExpr<typed::AssignExpr>(target->type, expr.range);
  node->compound = expr.compound;
  node->op = expr.op;
  node->target = std::move(target);
  node->value = std::move(value);
  return node;
}

} // namespace rtsl
