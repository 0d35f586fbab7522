//===- Conversion.cpp - implicit conversions ------------------------------===//
#include "sema/model/Conversion.h"

#include "sema/model/ClassModel.h"

namespace rtsl {

static bool widens(TypeKind from, TypeKind to) {
  return (from == TypeKind::Int && (to == TypeKind::UInt || to == TypeKind::Float)) ||
         (from == TypeKind::UInt && to == TypeKind::Float);
}

Conversion implicitConversion(const Type *from, const Type *to) {
  if (from == to || from->isError() || to->isError())
    return Conversion::Exact;
  if (from->isScalar() && to->isScalar())
    return widens(from->kind, to->kind) ? Conversion::Implicit : Conversion::None;
  if (from->isVector() && to->isVector() && from->count == to->count)
    return widens(from->element->kind, to->element->kind) ? Conversion::Implicit : Conversion::None;
  if (from->is(TypeKind::Class) && to->is(TypeKind::Class)) {
    if (!from->classType)
      return Conversion::None;
    const bool derives = to->classType ? from->classType->derivesFrom(to->classType)
                                       : from->classType->root == to->builtinClass;
    return derives ? Conversion::Implicit : Conversion::None;
  }
  return Conversion::None;
}

typed::ExprPtr convertTo(typed::ExprPtr expr, const Type *to, bool isImplicit) {
  if (expr->type == to || expr->type->isError())
    return expr;
  auto conversion = makeExpr<typed::ConvertExpr>(to, expr->range);
  conversion->isImplicit = isImplicit;
  conversion->operand = std::move(expr);
  return conversion;
}

const Type *withScalar(const Type *shape, const Type *scalar, TypeContext &types) {
  if (shape->isVector())
    return types.vector(scalar, shape->count);
  if (shape->isMatrix())
    return shape;
  return scalar;
}

const Type *widerScalar(const Type *a, const Type *b) {
  return widens(a->kind, b->kind) ? b : a;
}

} // namespace rtsl
