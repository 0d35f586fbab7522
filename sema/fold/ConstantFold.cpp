//===- ConstantFold.cpp - the value of a constant expression --------------===//
#include "sema/fold/ConstantFold.h"

#include "language/formulas/Matrices.h"
#include "sema/fold/Number.h"
#include "sema/typed/Casting.h"
#include "sema/typed/TypeProperties.h"

#include <algorithm>
#include <limits>

namespace rtsl {

using typed::Constant;
using Scalar = Constant::Scalar;
using ast::BinaryOp;

/// Larger values than this are not folded: a table of a million entries should be a buffer.
static constexpr std::uint64_t maxFoldedScalars = 1u << 16;

//===----------------------------------------------------------------------===//
// Scalars
//===----------------------------------------------------------------------===//

Scalar convertScalar(Scalar value, TypeKind from, TypeKind to) {
  if (from == to)
    return value;
  switch (to) {
  case TypeKind::Bool:
    return makeBool(from == TypeKind::Float ? value.f != 0.0f : value.u != 0);
  case TypeKind::Float:
    if (from == TypeKind::Bool)
      return makeFloat(value.b ? 1.0f : 0.0f);
    return makeFloat(from == TypeKind::Int ? static_cast<float>(value.i)
                                           : static_cast<float>(value.u));
  case TypeKind::Int:
    if (from == TypeKind::Bool)
      return makeInt(value.b ? 1 : 0);
    if (from == TypeKind::UInt)
      return makeInt(static_cast<std::int32_t>(value.u));
    if (std::isnan(value.f))
      return makeInt(0);
    if (value.f >= 2147483648.0f)
      return makeInt(std::numeric_limits<std::int32_t>::max());
    if (value.f <= -2147483648.0f)
      return makeInt(std::numeric_limits<std::int32_t>::min());
    return makeInt(static_cast<std::int32_t>(value.f));
  case TypeKind::UInt:
    if (from == TypeKind::Bool)
      return makeUInt(value.b ? 1 : 0);
    if (from == TypeKind::Int)
      return makeUInt(static_cast<std::uint32_t>(value.i));
    if (std::isnan(value.f) || value.f <= 0.0f)
      return makeUInt(0);
    if (value.f >= 4294967296.0f)
      return makeUInt(std::numeric_limits<std::uint32_t>::max());
    return makeUInt(static_cast<std::uint32_t>(value.f));
  default:
    return value;
  }
}

static Scalar foldFloat(BinaryOp op, float a, float b) {
  switch (op) {
  case BinaryOp::Add:
    return makeFloat(a + b);
  case BinaryOp::Sub:
    return makeFloat(a - b);
  case BinaryOp::Mul:
    return makeFloat(a * b);
  case BinaryOp::Div:
    return makeFloat(a / b);
  case BinaryOp::Less:
    return makeBool(a < b);
  case BinaryOp::Greater:
    return makeBool(a > b);
  case BinaryOp::LessEqual:
    return makeBool(a <= b);
  case BinaryOp::GreaterEqual:
    return makeBool(a >= b);
  case BinaryOp::NotEqual:
    return makeBool(a != b);
  default:
    return makeBool(a == b);
  }
}

static Scalar foldInteger(BinaryOp op, TypeKind kind, Scalar left, Scalar right) {
  const std::uint32_t a = left.u, b = right.u;
  const bool isSigned = kind == TypeKind::Int;
  switch (op) {
  case BinaryOp::Add:
    return makeUInt(a + b);
  case BinaryOp::Sub:
    return makeUInt(a - b);
  case BinaryOp::Mul:
    return makeUInt(a * b);
  case BinaryOp::Div:
    if (b == 0)
      return makeUInt(0);
    if (isSigned) // in 64 bits: the quotient of the smallest int and -1 wraps
      return makeUInt(static_cast<std::uint32_t>(std::int64_t(left.i) / right.i));
    return makeUInt(a / b);
  case BinaryOp::Mod:
    if (b == 0)
      return makeUInt(0);
    if (isSigned)
      return makeUInt(static_cast<std::uint32_t>(std::int64_t(left.i) % right.i));
    return makeUInt(a % b);
  case BinaryOp::Shl:
    return makeUInt(a << (b & 31));
  case BinaryOp::Shr:
    return isSigned ? makeInt(left.i >> (b & 31)) : makeUInt(a >> (b & 31));
  case BinaryOp::BitAnd:
    return makeUInt(a & b);
  case BinaryOp::BitOr:
    return makeUInt(a | b);
  case BinaryOp::BitXor:
    return makeUInt(a ^ b);
  case BinaryOp::Less:
    return makeBool(isSigned ? left.i < right.i : a < b);
  case BinaryOp::Greater:
    return makeBool(isSigned ? left.i > right.i : a > b);
  case BinaryOp::LessEqual:
    return makeBool(isSigned ? left.i <= right.i : a <= b);
  case BinaryOp::GreaterEqual:
    return makeBool(isSigned ? left.i >= right.i : a >= b);
  case BinaryOp::NotEqual:
    return makeBool(a != b);
  default:
    return makeBool(a == b);
  }
}

static Scalar foldScalar(BinaryOp op, TypeKind kind, Scalar left, Scalar right) {
  if (kind == TypeKind::Float)
    return foldFloat(op, left.f, right.f);
  if (kind != TypeKind::Bool)
    return foldInteger(op, kind, left, right);
  switch (op) {
  case BinaryOp::LogicalAnd:
    return makeBool(left.b && right.b);
  case BinaryOp::LogicalOr:
    return makeBool(left.b || right.b);
  case BinaryOp::LogicalXor:
  case BinaryOp::NotEqual:
    return makeBool(left.b != right.b);
  default:
    return makeBool(left.b == right.b);
  }
}

//===----------------------------------------------------------------------===//
// Whole values
//===----------------------------------------------------------------------===//

/// Equal in every scalar; `kinds` of the scalars follow from the type.
static bool equalValues(const Type *type, const Scalar *a, const Scalar *b) {
  if (type->is(TypeKind::Array)) {
    const std::uint64_t stride = scalarCount(type->element);
    for (std::uint32_t i = 0; i != type->count; ++i)
      if (!equalValues(type->element, a + i * stride, b + i * stride))
        return false;
    return true;
  }
  if (type->is(TypeKind::Struct)) {
    for (const typed::Field &field : type->structure->fields) {
      if (!equalValues(field.type, a, b))
        return false;
      a += scalarCount(field.type);
      b += scalarCount(field.type);
    }
    return true;
  }
  for (std::uint32_t i = 0; i != type->componentCount(); ++i)
    if (!foldScalar(BinaryOp::Equal, type->scalar()->kind, a[i], b[i]).b)
      return false;
  return true;
}

/// The products of linear algebra.
static Constant foldMatrixProduct(const Type *leftType, const Constant &left, const Type *rightType,
                                  const Constant &right) {
  const fold::Columns a = fold::columnsOf(*leftType, left), b = fold::columnsOf(*rightType, right);
  if (!rightType->isMatrix())
    return fold::toConstant({formulas::multiply(a, b.front())});
  if (!leftType->isMatrix())
    return fold::toConstant({formulas::multiply(a.front(), b)});
  return fold::toConstant(formulas::multiply(a, b));
}

static bool isLinearAlgebra(BinaryOp op, const Type *left, const Type *right) {
  return op == BinaryOp::Mul && ((left->isMatrix() && (right->isMatrix() || right->isVector())) ||
                                 (left->isVector() && right->isMatrix()));
}

/// Colors are folded only if the result does not depend, to the last bit, on the number of
/// components of the target: grey with grey or with a number. The components of other colors are
/// rounded after the conversion.
static std::optional<Constant> foldColor(BinaryOp op, const Constant &left, const Constant &right) {
  if (left.scalars.size() != 1 || right.scalars.size() != 1)
    return std::nullopt;
  return Constant{{foldFloat(op, left.scalars[0].f, right.scalars[0].f)}};
}

static std::optional<Constant> foldBinary(const typed::BinaryExpr &expr, const Constant &left,
                                          const Constant &right) {
  const Type *leftType = expr.left->type, *rightType = expr.right->type;
  if (leftType->is(TypeKind::Color) || rightType->is(TypeKind::Color))
    return foldColor(expr.op, left, right);
  if (expr.op == BinaryOp::Equal || expr.op == BinaryOp::NotEqual) {
    const bool equal = equalValues(leftType, left.scalars.data(), right.scalars.data());
    return Constant{{makeBool(equal == (expr.op == BinaryOp::Equal))}};
  }
  if (isLinearAlgebra(expr.op, leftType, rightType))
    return foldMatrixProduct(leftType, left, rightType, right);
  Constant result;
  const TypeKind kind = leftType->scalar()->kind;
  const std::size_t count = std::max(left.scalars.size(), right.scalars.size());
  for (std::size_t i = 0; i != count; ++i)
    result.scalars.push_back(foldScalar(expr.op, kind,
                                        left.scalars[left.scalars.size() == 1 ? 0 : i],
                                        right.scalars[right.scalars.size() == 1 ? 0 : i]));
  return result;
}

static std::optional<Constant> foldConstruct(const Type *type, const typed::ConstructExpr &expr,
                                             const std::vector<Constant> &args) {
  Constant result;
  if (type->isMatrix() && args.size() == 1 && !expr.args[0]->type->isVector()) {
    const bool fromMatrix = expr.args[0]->type->isMatrix();
    const Type *source = expr.args[0]->type;
    for (std::uint32_t c = 0; c != type->columns(); ++c)
      for (std::uint32_t r = 0; r != type->rows(); ++r) {
        if (!fromMatrix)
          result.scalars.push_back(c == r ? args[0].scalars[0] : makeFloat(0.0f));
        else if (c < source->columns() && r < source->rows())
          result.scalars.push_back(args[0].scalars[c * source->rows() + r]);
        else
          result.scalars.push_back(makeFloat(c == r ? 1.0f : 0.0f));
      }
    return result;
  }
  for (const Constant &arg : args)
    result.scalars.insert(result.scalars.end(), arg.scalars.begin(), arg.scalars.end());
  if (type->isVector() && result.scalars.size() == 1)
    result.scalars.assign(type->count, result.scalars[0]);
  else if (type->componentCount() != 0) // the last piece may have more components than needed
    result.scalars.resize(type->componentCount());
  return result;
}

static Constant foldUnary(typed::UnaryOp op, const Type *type, const Constant &operand) {
  Constant result;
  const TypeKind kind = type->is(TypeKind::Color) ? TypeKind::Float : type->scalar()->kind;
  for (Scalar scalar : operand.scalars) {
    if (op == typed::UnaryOp::Not)
      result.scalars.push_back(makeBool(!scalar.b));
    else if (op == typed::UnaryOp::BitNot)
      result.scalars.push_back(makeUInt(~scalar.u));
    else if (kind == TypeKind::Float)
      result.scalars.push_back(makeFloat(-scalar.f));
    else
      result.scalars.push_back(makeUInt(0u - scalar.u));
  }
  return result;
}

static Constant slice(const Constant &value, std::uint64_t first, std::uint64_t count) {
  Constant result;
  result.scalars.assign(value.scalars.begin() + static_cast<std::ptrdiff_t>(first),
                        value.scalars.begin() + static_cast<std::ptrdiff_t>(first + count));
  return result;
}

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

namespace {

class Evaluator {
public:
  using Parts = std::map<const typed::Expr *, Constant>;
  explicit Evaluator(const typed::Expr **obstacle, const Parts *parts = nullptr)
      : obstacle(obstacle), parts(parts) {}

  std::optional<Constant> evaluate(const typed::Expr &expr);

private:
  std::optional<Constant> evaluateField(const typed::FieldExpr &expr);
  std::optional<Constant> evaluateSwizzle(const typed::SwizzleExpr &expr);
  std::optional<Constant> evaluateIndex(const typed::IndexExpr &expr);
  std::optional<Constant> evaluateUnary(const typed::UnaryExpr &expr);
  std::optional<Constant> evaluateBinary(const typed::BinaryExpr &expr);
  std::optional<Constant> evaluateConditional(const typed::ConditionalExpr &expr);
  std::optional<Constant> evaluateConvert(const typed::ConvertExpr &expr);
  std::optional<Constant> evaluateConstruct(const typed::ConstructExpr &expr);
  std::optional<Constant> evaluateCall(const typed::BuiltinExpr &expr);
  bool evaluateAll(const std::vector<typed::ExprPtr> &exprs, std::vector<Constant> &values);

  std::nullopt_t notConstant(const typed::Expr &expr) {
    if (obstacle && !*obstacle)
      *obstacle = &expr;
    return std::nullopt;
  }

  const typed::Expr **obstacle;
  const Parts *parts; // values that are known already; null: none
};

} // namespace

bool Evaluator::evaluateAll(const std::vector<typed::ExprPtr> &exprs,
                            std::vector<Constant> &values) {
  for (const typed::ExprPtr &expr : exprs) {
    std::optional<Constant> value = evaluate(*expr);
    if (!value)
      return false;
    values.push_back(std::move(*value));
  }
  return true;
}

std::optional<Constant> Evaluator::evaluateIndex(const typed::IndexExpr &expr) {
  std::optional<Constant> base = evaluate(*expr.base);
  if (!base)
    return std::nullopt;
  std::optional<Constant> index = evaluate(*expr.index);
  if (!index)
    return std::nullopt;
  const Type *type = expr.base->type;
  if (type->count == 0 || type->is(TypeKind::Buffer))
    return notConstant(expr);
  // An index out of range is clamped, as at run time.
  std::int64_t at =
      expr.index->type->is(TypeKind::Int) ? index->scalars[0].i : std::int64_t(index->scalars[0].u);
  at = std::max<std::int64_t>(0, std::min<std::int64_t>(at, std::int64_t(type->count) - 1));
  const std::uint64_t stride = scalarCount(type->element);
  return slice(*base, static_cast<std::uint64_t>(at) * stride, stride);
}

std::optional<Constant> Evaluator::evaluateField(const typed::FieldExpr &expr) {
  std::optional<Constant> base = evaluate(*expr.base);
  if (!base)
    return std::nullopt;
  std::uint64_t first = 0;
  const typed::Struct &structure = *expr.base->type->structure;
  for (std::uint32_t i = 0; i != expr.field; ++i)
    first += scalarCount(structure.fields[i].type);
  return slice(*base, first, scalarCount(expr.type));
}

std::optional<Constant> Evaluator::evaluateSwizzle(const typed::SwizzleExpr &expr) {
  std::optional<Constant> base = evaluate(*expr.base);
  if (!base)
    return std::nullopt;
  Constant result;
  for (std::uint8_t component : expr.components)
    result.scalars.push_back(base->scalars[component]);
  return result;
}

std::optional<Constant> Evaluator::evaluateUnary(const typed::UnaryExpr &expr) {
  std::optional<Constant> operand = evaluate(*expr.operand);
  if (!operand)
    return std::nullopt;
  if (expr.type->is(TypeKind::Color) && operand->scalars.size() != 1) // see foldColor
    return std::nullopt;
  return foldUnary(expr.op, expr.type, *operand);
}

std::optional<Constant> Evaluator::evaluateBinary(const typed::BinaryExpr &expr) {
  std::optional<Constant> left = evaluate(*expr.left);
  if (!left)
    return std::nullopt;
  std::optional<Constant> right = evaluate(*expr.right);
  if (!right)
    return std::nullopt;
  if (std::optional<Constant> result = foldBinary(expr, *left, *right))
    return result;
  return notConstant(expr);
}

std::optional<Constant> Evaluator::evaluateConditional(const typed::ConditionalExpr &expr) {
  std::optional<Constant> condition = evaluate(*expr.condition);
  if (!condition)
    return std::nullopt;
  return evaluate(condition->scalars[0].b ? *expr.whenTrue : *expr.whenFalse);
}

std::optional<Constant> Evaluator::evaluateConvert(const typed::ConvertExpr &expr) {
  std::optional<Constant> operand = evaluate(*expr.operand);
  if (!operand)
    return std::nullopt;
  if (!expr.type->scalar())
    return notConstant(expr);
  for (Scalar &scalar : operand->scalars)
    scalar = convertScalar(scalar, expr.operand->type->scalar()->kind, expr.type->scalar()->kind);
  return operand;
}

std::optional<Constant> Evaluator::evaluateConstruct(const typed::ConstructExpr &expr) {
  // A color inside an aggregate has no fixed number of scalars.
  const bool isAggregate = expr.type->is(TypeKind::Array) || expr.type->is(TypeKind::Struct);
  if (isAggregate &&
      (contains(expr.type, TypeKind::Color) || scalarCount(expr.type) > maxFoldedScalars))
    return notConstant(expr);
  std::vector<Constant> args;
  if (!evaluateAll(expr.args, args))
    return std::nullopt;
  return foldConstruct(expr.type, expr, args);
}

std::optional<Constant> Evaluator::evaluateCall(const typed::BuiltinExpr &expr) {
  std::vector<Constant> args;
  if (!evaluateAll(expr.args, args))
    return std::nullopt;
  if (std::optional<Constant> result = evaluateBuiltin(expr, args))
    return result;
  return notConstant(expr);
}

std::optional<Constant> Evaluator::evaluate(const typed::Expr &expr) {
  if (expr.type->isError())
    return std::nullopt;
  if (parts)
    if (auto known = parts->find(&expr); known != parts->end())
      return known->second;
  switch (expr.kind) {
  case typed::ExprKind::Literal:
    return cast<typed::LiteralExpr>(expr).value;
  case typed::ExprKind::Variable:
    if (const auto &constant = cast<typed::VariableExpr>(expr).variable->constant)
      return *constant;
    return notConstant(expr);
  case typed::ExprKind::Member:
    if (const auto &constant = cast<typed::MemberExpr>(expr).member->constant)
      return *constant;
    return notConstant(expr);
  case typed::ExprKind::Field:
    return evaluateField(cast<typed::FieldExpr>(expr));
  case typed::ExprKind::Swizzle:
    return evaluateSwizzle(cast<typed::SwizzleExpr>(expr));
  case typed::ExprKind::Index:
    return evaluateIndex(cast<typed::IndexExpr>(expr));
  case typed::ExprKind::Unary:
    return evaluateUnary(cast<typed::UnaryExpr>(expr));
  case typed::ExprKind::Binary:
    return evaluateBinary(cast<typed::BinaryExpr>(expr));
  case typed::ExprKind::Conditional:
    return evaluateConditional(cast<typed::ConditionalExpr>(expr));
  case typed::ExprKind::Convert:
    return evaluateConvert(cast<typed::ConvertExpr>(expr));
  case typed::ExprKind::Construct:
    return evaluateConstruct(cast<typed::ConstructExpr>(expr));
  case typed::ExprKind::Builtin:
    return evaluateCall(cast<typed::BuiltinExpr>(expr));
  default:
    return notConstant(expr);
  }
}

std::optional<Constant> evaluate(const typed::Expr &expr, const typed::Expr **obstacle) {
  if (obstacle)
    *obstacle = nullptr;
  return Evaluator(obstacle).evaluate(expr);
}

std::optional<Constant> evaluate(const typed::Expr &expr,
                                 const std::map<const typed::Expr *, Constant> &parts) {
  return Evaluator(nullptr, &parts).evaluate(expr);
}

std::optional<std::int64_t> evaluateInteger(const typed::Expr &expr, const typed::Expr **obstacle) {
  std::optional<Constant> value = evaluate(expr, obstacle);
  if (!value || (!expr.type->is(TypeKind::Int) && !expr.type->is(TypeKind::UInt)))
    return std::nullopt;
  return expr.type->is(TypeKind::Int) ? std::int64_t(value->scalars[0].i)
                                      : std::int64_t(value->scalars[0].u);
}

bool isConstantExpression(const typed::Expr &expr, const typed::Expr **obstacle) {
  auto all = [&](const std::vector<typed::ExprPtr> &exprs) {
    return std::all_of(exprs.begin(), exprs.end(), [&](const typed::ExprPtr &each) {
      return isConstantExpression(*each, obstacle);
    });
  };
  auto both = [&](const typed::ExprPtr &a, const typed::ExprPtr &b) {
    return isConstantExpression(*a, obstacle) && isConstantExpression(*b, obstacle);
  };
  switch (expr.kind) {
  case typed::ExprKind::Literal:
    return true;
  case typed::ExprKind::Variable: {
    const typed::Variable &variable = *cast<typed::VariableExpr>(expr).variable;
    if (variable.constant || variable.kind == typed::Variable::Kind::Global)
      return true;
    break;
  }
  case typed::ExprKind::Member:
    if (cast<typed::MemberExpr>(expr).member->isConst)
      return true;
    break;
  case typed::ExprKind::Field:
    return isConstantExpression(*cast<typed::FieldExpr>(expr).base, obstacle);
  case typed::ExprKind::Swizzle:
    return isConstantExpression(*cast<typed::SwizzleExpr>(expr).base, obstacle);
  case typed::ExprKind::Index:
    return both(cast<typed::IndexExpr>(expr).base, cast<typed::IndexExpr>(expr).index);
  case typed::ExprKind::Unary:
    return isConstantExpression(*cast<typed::UnaryExpr>(expr).operand, obstacle);
  case typed::ExprKind::Binary:
    return both(cast<typed::BinaryExpr>(expr).left, cast<typed::BinaryExpr>(expr).right);
  case typed::ExprKind::Conditional: {
    const auto &conditional = cast<typed::ConditionalExpr>(expr);
    return isConstantExpression(*conditional.condition, obstacle) &&
           both(conditional.whenTrue, conditional.whenFalse);
  }
  case typed::ExprKind::Convert:
    return isConstantExpression(*cast<typed::ConvertExpr>(expr).operand, obstacle);
  case typed::ExprKind::Construct:
    return all(cast<typed::ConstructExpr>(expr).args);
  case typed::ExprKind::Builtin: {
    const auto &call = cast<typed::BuiltinExpr>(expr);
    if (typed::isFoldable(call.builtin))
      return all(call.args);
    break;
  }
  default:
    break;
  }
  *obstacle = &expr;
  return false;
}

} // namespace rtsl
