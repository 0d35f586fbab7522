//===- Conversion.h - implicit conversions and making nodes ---------------===//
#pragma once

#include "sema/typed/Casting.h"
#include "sema/typed/TypedAst.h"

namespace rtsl {

/// Implicit conversions: int -> uint -> float for scalars and vectors, and a reference to one of a
/// base class.
enum class Conversion : std::uint8_t { None, Exact, Implicit };
Conversion implicitConversion(const Type *from, const Type *to);

/// A new node with its type and range.
template <typename T>
std::unique_ptr<T> makeExpr(const Type *type, SourceRange range) {
  auto expr = std::make_unique<T>();
  expr->type = type;
  expr->range = range;
  return expr;
}

/// Wraps `expr` in a conversion unless it has the type already.
typed::ExprPtr convertTo(typed::ExprPtr expr, const Type *to, bool isImplicit = true);

/// The type with the shape of `shape` (scalar, vector or matrix) and the scalar type of `scalar`.
const Type *withScalar(const Type *shape, const Type *scalar, TypeContext &types);

/// The common type of two numeric scalar types: float before uint before int.
const Type *widerScalar(const Type *a, const Type *b);

} // namespace rtsl
