//===- LowerOperators.cpp - unary and binary operators, conversions -------===//
#include "codegen/lower/Lowering.h"
#include "language/formulas/Comparison.h"
#include "language/formulas/Matrices.h"

namespace rtsl::lowering {

using ast::BinaryOp;

Parts FunctionLowering::lowerUnary(const typed::UnaryExpr &expr) {
  Parts result = lower(*expr.operand);
  emitter.setLoc(module.location(expr.range));
  for (Value &part : result)
    switch (expr.op) {
    case typed::UnaryOp::Minus:
      part = -num(part);
      break;
    case typed::UnaryOp::Not:
      part = !num(part);
      break;
    case typed::UnaryOp::BitNot:
      part = num(part) ^ -1;
      break;
    }
  return result;
}

//===----------------------------------------------------------------------===//
// Binary operators
//===----------------------------------------------------------------------===//

static bool isSigned(const Type *type) {
  const Type *scalar = type->scalar();
  return scalar && scalar->is(TypeKind::Int);
}

template <typename Op>
static Num divide(Emitter &emitter, Num left, Num right) {
  if (left.width() != right.width()) {
    unsigned width = std::max(left.width(), right.width());
    left = left.width() ? left : left.splat(width);
    right = right.width() ? right : right.splat(width);
  }
  Value a = left, b = right;
  return {emitter, emitter.fold<Op>(a.getType(), a, b)};
}

Num FunctionLowering::arithmetic(BinaryOp op, Num left, Num right, bool isSigned) {
  switch (op) {
  case BinaryOp::Add:
    return left + right;
  case BinaryOp::Sub:
    return left - right;
  case BinaryOp::Mul:
    return left * right;
  case BinaryOp::Div:
    if (left.isFloat())
      return left / right;
    return isSigned ? divide<ir::SDivOp>(emitter, left, right)
                    : divide<ir::UDivOp>(emitter, left, right);
  case BinaryOp::Mod:
    if (left.isFloat())
      return formulas::mod(left, right);
    return isSigned ? divide<ir::SRemOp>(emitter, left, right)
                    : divide<ir::URemOp>(emitter, left, right);
  case BinaryOp::Shl:
    return shiftLeft(left, right & 31);
  case BinaryOp::Shr:
    return isSigned ? shiftRightSigned(left, right & 31) : shiftRight(left, right & 31);
  case BinaryOp::BitAnd:
    return left & right;
  case BinaryOp::BitXor:
  case BinaryOp::LogicalXor:
    return left ^ right;
  case BinaryOp::BitOr:
    return left | right;
  case BinaryOp::Less:
  case BinaryOp::Greater:
  case BinaryOp::LessEqual:
  case BinaryOp::GreaterEqual: {
    bool swap = op == BinaryOp::Greater || op == BinaryOp::GreaterEqual;
    bool strict = op == BinaryOp::Less || op == BinaryOp::Greater;
    Num low = swap ? right : left, high = swap ? left : right;
    using formulas::IntegerSign;
    const IntegerSign sign =
        low.isFloat() || isSigned ? IntegerSign::Signed : IntegerSign::Unsigned;
    return strict ? formulas::lessThan(low, high, sign) : formulas::lessThanEqual(low, high, sign);
  }
  case BinaryOp::Equal:
  case BinaryOp::NotEqual:
  case BinaryOp::LogicalAnd:
  case BinaryOp::LogicalOr:
    break;
  }
  llvm_unreachable("lowered by another function");
}

Parts FunctionLowering::binary(BinaryOp op, const Parts &left, const Type *leftType,
                               const Parts &right, const Type *rightType) {
  if (op == BinaryOp::Equal || op == BinaryOp::NotEqual) {
    Num equal = equality(left, right, leftType);
    return {op == BinaryOp::Equal ? equal : !equal};
  }
  bool leftMatrix = leftType->isMatrix(), rightMatrix = rightType->isMatrix();
  if (op == BinaryOp::Mul && (leftMatrix || rightMatrix) && !leftType->isScalar() &&
      !rightType->isScalar())
    return multiplyMatrices(left, leftType, right, rightType);
  Parts result;
  for (std::size_t i = 0; i < std::max(left.size(), right.size()); ++i)
    result.push_back(arithmetic(op, num(left[left.size() == 1 ? 0 : i]),
                                num(right[right.size() == 1 ? 0 : i]), isSigned(leftType)));
  return result;
}

Parts FunctionLowering::multiplyMatrices(const Parts &left, const Type *leftType,
                                         const Parts &right, const Type *rightType) {
  if (!rightType->isMatrix())
    return {formulas::multiply(columns(left), num(right.front()))};
  if (!leftType->isMatrix())
    return {formulas::multiply(num(left.front()), columns(right))};
  return parts(formulas::multiply(columns(left), columns(right)));
}

// Equality of whole values: all scalars are equal.
Num FunctionLowering::equality(const Parts &left, const Parts &right, const Type *type) {
  if (type->is(TypeKind::Class))
    return num(emitter.make<ir::EqualRefOp>(emitter.getI1Type(), left.front(), right.front()));
  auto within = [&](auto address, const Type *part) {
    return equality(loadFrom(address(left.front()), part), loadFrom(address(right.front()), part),
                    part);
  };
  if (type->is(TypeKind::Struct)) {
    Num result = num(emitter.boolConstant(true));
    for (const typed::Field &field : type->structure->fields)
      result =
          result & within([&](Value base) { return emitter.field(base, field.name); }, field.type);
    return result;
  }
  if (type->is(TypeKind::Array) && type->count <= 8) {
    Num result = num(emitter.boolConstant(true));
    for (unsigned i = 0; i < type->count; ++i)
      result = result & within([&](Value base) { return emitter.element(base, i); }, type->element);
    return result;
  }
  if (type->is(TypeKind::Array)) {
    // Up to the first element that differs.
    Value index = emitter.variable("index", emitter.getI32Type());
    Value same = emitter.variable("same", emitter.getI1Type());
    emitter.store(emitter.boolConstant(true), same);
    emitter.loop(
        false,
        [&]() -> Value {
          return num(emitter.load(same)) & less(num(emitter.load(index)), type->count);
        },
        [&] {
          Value i = emitter.load(index);
          emitter.store(within([&](Value base) { return emitter.element(base, i); }, type->element),
                        same);
          emitter.store(num(i) + 1.0, index);
        },
        nullptr);
    return num(emitter.load(same));
  }
  Num result = formulas::all(equal(num(left[0]), num(right[0])));
  for (std::size_t i = 1; i < left.size(); ++i)
    result = result & formulas::all(equal(num(left[i]), num(right[i])));
  return result;
}

//===----------------------------------------------------------------------===//
// Conversions
//===----------------------------------------------------------------------===//

Num FunctionLowering::convertScalars(Num number, const Type *from, const Type *to) {
  mlir::Type result = withScalar(number.type(), module.type(to));
  Value input = number;
  auto make = [&](Value value) { return num(value); };
  switch (to->kind) {
  case TypeKind::Float:
    if (from->is(TypeKind::Int))
      return make(emitter.fold<mlir::arith::SIToFPOp>(result, input));
    if (from->is(TypeKind::UInt) || from->is(TypeKind::Bool))
      return make(emitter.fold<mlir::arith::UIToFPOp>(result, input));
    return number;
  case TypeKind::Int:
  case TypeKind::UInt:
    if (from->is(TypeKind::Float))
      return make(to->is(TypeKind::Int) ? emitter.fold<ir::ToSintOp>(result, input)
                                        : emitter.fold<ir::ToUintOp>(result, input));
    if (from->is(TypeKind::Bool))
      return make(emitter.fold<mlir::arith::ExtUIOp>(result, input));
    return number;
  case TypeKind::Bool:
    return from->is(TypeKind::Bool) ? number : notEqual(number, 0.0);
  default:
    return number;
  }
}

Parts FunctionLowering::convert(const Parts &parts, const Type *from, const Type *to) {
  if (to->is(TypeKind::Class)) {
    mlir::Type type = module.type(to);
    if (parts.front().getType() == type)
      return parts;
    return {emitter.make<ir::CastRefOp>(type, parts.front())};
  }
  if (from->is(TypeKind::Class)) // to a bool
    return {!equality(parts, zeroOf(from), from)};
  const Type *fromScalar = from->scalar(), *toScalar = to->scalar();
  if (!fromScalar || !toScalar)
    return parts;
  Parts result;
  for (Value part : parts)
    result.push_back(convertScalars(num(part), fromScalar, toScalar));
  return result;
}

} // namespace rtsl::lowering
