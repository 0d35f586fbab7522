//===- Conversion.h - implicit conversions and making nodes ---------------===//
#pragma once

#include "sema/typed/Casting.h"
#include "sema/typed/TypedAst.h"

namespace rtsl {

/// How a value of one type becomes one of another without being asked: int -> uint -> float for
/// scalars and vectors, and a reference to one of a base class.
enum class Conversion : std::uint8_t { None, Exact, Implicit };
Conversion implicitConversion(const Type *from, const Type *to);

/// A new node with type and place.
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

/// The scalar type to which two numeric scalar types are brought: float before uint before int.
const Type *widerScalar(const Type *a, const Type *b);

} // namespace rtsl
