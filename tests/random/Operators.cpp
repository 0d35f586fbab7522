//===- Operators.cpp - unary and binary operators by the type they give ---===//
#include "Generator.h"

#include "sema/typed/TypeProperties.h"

namespace rtsl::random {

/// `op=` whose right side has the type of the left; null if there is none.
const char *Generator::compoundOperator(const Type *type) {
  static const char *const integers[] = {
      "+=", "-=", "*=", "/=", "%=", "<<=", ">>=", "&=", "|=", "^="};
  const Type *scalar = type->scalar();
  if (type->isMatrix())
    return type->columns() == type->rows() && chance(30) ? "*=" : (chance(50) ? "+=" : "-=");
  if (scalar == types.floatType || type == types.color)
    return integers[below(4)];
  if (scalar == types.intType || scalar == types.uintType)
    return integers[below(10)];
  return nullptr;
}

NodePtr Generator::comparison(unsigned depth) {
  switch (below(8)) {
  case 0:
    return make(types.boolType, "(!$)", condition(depth - 1));
  case 1:
  case 2: {
    static const char *const ops[] = {"($ && $)", "($ || $)", "($ ^^ $)"};
    const char *op = ops[below(3)];
    NodePtr a = condition(depth - 1);
    return make(types.boolType, op, std::move(a), condition(depth - 1));
  }
  case 3: { // whole values
    const Type *type = anyType();
    if (hasColor(type))
      return nullptr;
    const char *op = chance(50) ? "($ == $)" : "($ != $)";
    NodePtr a = expression(type, depth - 1);
    return make(types.boolType, op, std::move(a), expression(type, depth - 1));
  }
  default: {
    static const char *const ops[] = {"($ < $)",  "($ <= $)", "($ > $)",
                                      "($ >= $)", "($ == $)", "($ != $)"};
    const Type *left = numericScalar(), *right = chance(80) ? left : numericScalar();
    const char *op = ops[below(6)];
    NodePtr a = expression(left, depth - 1);
    return make(types.boolType, op, std::move(a), expression(right, depth - 1));
  }
  }
}

/// Scalars and vectors of numbers.
NodePtr Generator::vectorOperation(const Type *type, unsigned depth) {
  const Type *scalar = type->scalar();
  const bool isInteger = scalar != types.floatType;
  switch (below(isInteger ? 8 : 5)) {
  case 0: {
    static const char *const ops[] = {"(-$)", "(+$)", "(~$)"};
    const char *op = ops[below(isInteger ? 3 : 2)];
    return make(type, op, expression(type, depth - 1));
  }
  case 1:
    if (type->isVector() && !isInteger) { // linear algebra
      const bool columnOnTheRight = chance(50);
      const unsigned inner = 2 + below(3);
      const Type *matrix =
          columnOnTheRight ? types.matrix(inner, type->count) : types.matrix(type->count, inner);
      const Type *vector = types.vector(types.floatType, inner);
      NodePtr a = expression(columnOnTheRight ? matrix : vector, depth - 1);
      return make(type, "($ * $)", std::move(a),
                  expression(columnOnTheRight ? vector : matrix, depth - 1));
    }
    [[fallthrough]];
  case 2:
  case 3:
  case 4: {
    static const char *const ops[] = {"($ + $)", "($ - $)", "($ * $)", "($ / $)"};
    // One side has the result's type; the other may be a scalar, or of a narrower type.
    const Type *other = type;
    if (type->isVector() && chance(30))
      other = scalar;
    if (chance(10) && scalar != types.intType)
      other = withScalar(other,
                         scalar == types.floatType && chance(50) ? types.uintType : types.intType);
    const bool swap = chance(50);
    const char *op = ops[below(4)];
    NodePtr a = expression(swap ? other : type, depth - 1);
    return make(type, op, std::move(a), expression(swap ? type : other, depth - 1));
  }
  case 5: {
    // The left side alone decides on the type of a shift.
    const Type *shape = chance(70) ? type : scalar;
    const Type *count = withScalar(shape, chance(50) ? types.intType : types.uintType);
    const char *op = chance(50) ? "($ << $)" : "($ >> $)";
    NodePtr a = expression(type, depth - 1);
    return make(type, op, std::move(a), expression(count, depth - 1));
  }
  default: {
    static const char *const ops[] = {"($ % $)", "($ & $)", "($ | $)", "($ ^ $)"};
    const Type *other = type->isVector() && chance(30) ? scalar : type;
    const char *op = ops[below(4)];
    NodePtr a = expression(type, depth - 1);
    return make(type, op, std::move(a), expression(other, depth - 1));
  }
  }
}

NodePtr Generator::matrixOperation(const Type *type, unsigned depth) {
  if (chance(10))
    return make(type, "(-$)", expression(type, depth - 1));
  if (chance(40)) {
    const unsigned inner = 2 + below(3);
    NodePtr a = expression(types.matrix(inner, type->rows()), depth - 1);
    return make(type, "($ * $)", std::move(a),
                expression(types.matrix(type->columns(), inner), depth - 1));
  }
  static const char *const ops[] = {"($ + $)", "($ - $)", "($ / $)", "($ * $)"};
  const unsigned op = below(4);
  const bool withScalar = op == 3 || chance(30);
  const bool swap = withScalar && chance(50);
  NodePtr a = expression(swap ? types.floatType : type, depth - 1);
  return make(type, ops[op], std::move(a),
              expression(withScalar && !swap ? types.floatType : type, depth - 1));
}

NodePtr Generator::colorOperation(unsigned depth) {
  const Type *color = types.color;
  switch (below(4)) {
  case 0:
    return make(color, "(-$)", expression(color, depth - 1));
  case 1: {
    const bool swap = chance(50);
    const char *op = chance(60) ? "($ * $)" : "($ / $)";
    const Type *scalar = numericScalar();
    NodePtr a = expression(swap ? scalar : color, depth - 1);
    return make(color, op, std::move(a), expression(swap ? color : scalar, depth - 1));
  }
  default: {
    static const char *const ops[] = {"($ + $)", "($ - $)", "($ * $)", "($ / $)"};
    const char *op = ops[below(4)];
    NodePtr a = expression(color, depth - 1);
    return make(color, op, std::move(a), expression(color, depth - 1));
  }
  }
}

NodePtr Generator::operation(const Type *type, unsigned depth) {
  if (type == types.boolType)
    return comparison(depth);
  if (type->isMatrix())
    return matrixOperation(type, depth);
  if (type == types.color)
    return colorOperation(depth);
  if (type->scalar() && type->scalar() != types.boolType)
    return vectorOperation(type, depth);
  return nullptr;
}

} // namespace rtsl::random
