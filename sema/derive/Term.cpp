//===- Term.cpp - formulas over typed expressions -------------------------===//
#include "sema/derive/Term.h"

#include "sema/derive/Copy.h"
#include "sema/model/Conversion.h"

#include <algorithm>

namespace rtsl::derive {

using namespace typed;
using ast::BinaryOp;

Term::Term(const Term &other)
    : owned(other.owned ? Copier().copy(*other.owned) : nullptr), context(other.context) {}

Term &Term::operator=(const Term &other) {
  return *this = Term(other);
}

/// The numbers of a value, in the order of Constant::scalars.
static std::size_t numbersOf(const Type *type) {
  if (type->is(TypeKind::Struct)) {
    std::size_t sum = 0;
    for (const Field &field : type->structure->fields)
      sum += numbersOf(field.type);
    return sum;
  }
  return type->is(TypeKind::Array) ? type->count * numbersOf(type->element)
                                   : type->componentCount();
}

ExprPtr zero(const Type *type, SourceRange range) {
  auto node = makeExpr<LiteralExpr>(type, range);
  node->value.scalars.assign(numbersOf(type), Constant::Scalar{0.0f});
  return node;
}

/// Numbers and bools, and aggregates of them.
static bool isOfNumbers(const Type *type) {
  if (type->is(TypeKind::Struct))
    return std::all_of(type->structure->fields.begin(), type->structure->fields.end(),
                       [](const Field &field) { return isOfNumbers(field.type); });
  return type->is(TypeKind::Array) ? isOfNumbers(type->element) : type->scalar() != nullptr;
}

static bool hasFloat(const Type *type) {
  if (type->is(TypeKind::Struct))
    return std::any_of(type->structure->fields.begin(), type->structure->fields.end(),
                       [](const Field &field) { return hasFloat(field.type); });
  if (type->is(TypeKind::Array))
    return hasFloat(type->element);
  return type->scalar() && type->scalar()->is(TypeKind::Float);
}

bool isDifferentiable(const Type *type) {
  return isOfNumbers(type) && hasFloat(type);
}

Term constant(float value, const Term &at) {
  auto node = makeExpr<LiteralExpr>(at.types().floatType, at.expr().range);
  node->value.scalars = {Constant::Scalar{value}};
  return {std::move(node), at.types()};
}

static Term binary(BinaryOp op, const Type *type, Term a, Term b) {
  auto node = makeExpr<BinaryExpr>(type, a.expr().range);
  TypeContext &types = a.types();
  node->op = op;
  node->left = a.take();
  node->right = b.take();
  return {std::move(node), types};
}

/// The type of a sum, difference, quotient, or product of terms.
static const Type *typeOf(BinaryOp op, const Term &a, const Term &b) {
  const Type *left = a.type(), *right = b.type();
  if (op == BinaryOp::Mul && left->isMatrix() && right->isMatrix())
    return a.types().matrix(right->columns(), left->rows());
  if (op == BinaryOp::Mul && left->isMatrix() && right->isVector())
    return left->element;
  if (op == BinaryOp::Mul && left->isVector() && right->isMatrix())
    return a.types().vector(a.types().floatType, right->columns());
  return left->isScalar() ? right : left;
}

static Term combined(BinaryOp op, const Term &a, const Term &b) {
  return binary(op, typeOf(op, a, b), a, b);
}

Term fitted(Term term, const Type *type) {
  if (term.isZero() || term.type() == type || !term.type()->isScalar())
    return term;
  TypeContext &types = term.types();
  if (type->isMatrix()) // a matrix of one scalar is diagonal
    return binary(BinaryOp::Add, type, Term(zero(type, term.expr().range), types), term);
  if (!type->isVector())
    return term;
  auto node = makeExpr<ConstructExpr>(type, term.expr().range);
  node->args.push_back(term.take());
  return {std::move(node), types};
}

Term operator-(const Term &a) {
  if (a.isZero())
    return a;
  auto node = makeExpr<UnaryExpr>(a.type(), a.expr().range);
  node->op = UnaryOp::Minus;
  node->operand = Term(a).take();
  return {std::move(node), a.types()};
}
Term operator+(const Term &a, const Term &b) {
  return a.isZero() ? b : b.isZero() ? a : combined(BinaryOp::Add, a, b);
}
Term operator-(const Term &a, const Term &b) {
  return b.isZero() ? a : a.isZero() ? -b : combined(BinaryOp::Sub, a, b);
}
Term operator*(const Term &a, const Term &b) {
  return a.isZero() || b.isZero() ? Term() : combined(BinaryOp::Mul, a, b);
}
Term operator/(const Term &a, const Term &b) {
  return a.isZero() ? Term() : combined(BinaryOp::Div, a, b);
}
Term operator+(const Term &a, float b) {
  return a + constant(b, a);
}
Term operator-(const Term &a, float b) {
  return a - constant(b, a);
}
Term operator-(float a, const Term &b) {
  return constant(a, b) - b;
}
Term operator*(float a, const Term &b) {
  return b.isZero() ? Term() : constant(a, b) * b;
}

Term call(Builtin function, const std::vector<Term> &args, const Type *type) {
  for (const Term &arg : args)
    if (arg.isZero())
      return {};
  auto node = makeExpr<BuiltinExpr>(type, args.front().expr().range);
  node->builtin = function;
  for (const Term &arg : args)
    node->args.push_back(Term(arg).take());
  return {std::move(node), args.front().types()};
}

Term call(Builtin function, const std::vector<Term> &args) {
  return args.front().isZero() ? Term() : call(function, args, args.front().type());
}

Term component(const Term &vector, std::uint32_t index) {
  if (vector.isZero())
    return {};
  auto node = makeExpr<SwizzleExpr>(vector.type()->scalar(), vector.expr().range);
  node->base = Term(vector).take();
  node->components = {static_cast<std::uint8_t>(index)};
  return {std::move(node), vector.types()};
}

Term select(const Term &condition, const Term &a, const Term &b, const Type *type) {
  if (a.isZero() && b.isZero())
    return {};
  TypeContext &types = condition.types();
  const SourceRange range = condition.expr().range;
  const auto value = [&](const Term &term) {
    return term.isZero() ? Term(zero(type, range), types) : fitted(term, type);
  };
  if (condition.type()->isVector())
    return call(Builtin::MixSelect, {value(b), value(a), condition}, type);
  auto node = makeExpr<ConditionalExpr>(type, range);
  node->condition = Term(condition).take();
  node->whenTrue = value(a).take();
  node->whenFalse = value(b).take();
  return {std::move(node), types};
}

Term less(const Term &a, const Term &b) {
  TypeContext &types = a.types();
  if (!a.type()->isVector())
    return binary(BinaryOp::Less, types.boolType, a, b);
  return call(Builtin::LessThan, {a, b}, types.vector(types.boolType, a.type()->count));
}

Term toFloat(const Term &a) {
  return {convertTo(Term(a).take(), a.types().floatType), a.types()};
}

} // namespace rtsl::derive
