//===- LowerBuiltins.cpp - built-in functions of floats and vectors -------===//
//
// The formulas are those of GLSL 4.60, chapter 8, in the order in which it writes them; Library.h
// states where more care is taken. `round` rounds halves to even, as `roundEven` does (GLSL leaves
// it open).
//
//===----------------------------------------------------------------------===//
#include "codegen/formulas/Color.h"
#include "codegen/lower/Lowering.h"

namespace rtsl::lowering {

using typed::Builtin;

Num FunctionLowering::elementary(ir::Elementary function, llvm::ArrayRef<Num> operands) {
  llvm::SmallVector<Value, 2> values(operands.begin(), operands.end());
  // `pow(color, float)`: a scalar operand goes to every component.
  for (Value &value : values)
    if (vectorWidth(value.getType()) == 0 && operands.front().width() != 0)
      value = emitter.splat(value, operands.front().width());
  return num(emitter.make<ir::ElementaryOp>(operands.front().type(), function, values));
}

Parts FunctionLowering::lowerBuiltin(const typed::BuiltinExpr &expr) {
  if (auto result = lowerRayBuiltin(expr))
    return *result;
  if (auto result = lowerNumericBuiltin(expr))
    return *result;
  if (auto result = lowerGeometricBuiltin(expr))
    return *result;
  if (auto result = lowerIntegerBuiltin(expr))
    return *result;
  if (auto result = lowerPackingBuiltin(expr))
    return *result;
  unsupported(expr.range, std::string("`") + typed::name(expr.builtin) + "`");
  return zeroOf(expr.type);
}

static std::optional<ir::Elementary> elementaryOf(Builtin builtin) {
  switch (builtin) {
  case Builtin::Sin:
    return ir::Elementary::Sin;
  case Builtin::Cos:
    return ir::Elementary::Cos;
  case Builtin::Tan:
    return ir::Elementary::Tan;
  case Builtin::SinPi:
    return ir::Elementary::SinPi;
  case Builtin::CosPi:
    return ir::Elementary::CosPi;
  case Builtin::Asin:
    return ir::Elementary::Asin;
  case Builtin::Acos:
    return ir::Elementary::Acos;
  case Builtin::Atan:
    return ir::Elementary::Atan;
  case Builtin::Atan2:
    return ir::Elementary::Atan2;
  case Builtin::Sinh:
    return ir::Elementary::Sinh;
  case Builtin::Cosh:
    return ir::Elementary::Cosh;
  case Builtin::Tanh:
    return ir::Elementary::Tanh;
  case Builtin::Asinh:
    return ir::Elementary::Asinh;
  case Builtin::Acosh:
    return ir::Elementary::Acosh;
  case Builtin::Atanh:
    return ir::Elementary::Atanh;
  case Builtin::Pow:
    return ir::Elementary::Pow;
  case Builtin::Exp:
    return ir::Elementary::Exp;
  case Builtin::Log:
    return ir::Elementary::Log;
  case Builtin::Exp2:
    return ir::Elementary::Exp2;
  case Builtin::Log2:
    return ir::Elementary::Log2;
  case Builtin::Expm1:
    return ir::Elementary::Expm1;
  case Builtin::Log1p:
    return ir::Elementary::Log1p;
  case Builtin::InverseSqrt:
    return ir::Elementary::InverseSqrt;
  default:
    return std::nullopt;
  }
}

static bool isUnsigned(const typed::Expr &expr) {
  const Type *scalar = expr.type->scalar();
  return scalar && scalar->is(TypeKind::UInt);
}

std::optional<Parts> FunctionLowering::lowerNumericBuiltin(const typed::BuiltinExpr &expr) {
  // Operands in order; those behind an out parameter's do not exist among these functions.
  llvm::SmallVector<Num, 4> operands;
  auto evaluate = [&](std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      operands.push_back(number(*expr.args[i]));
    emitter.setLoc(module.location(expr.range));
  };
  auto result = [](Num value) { return Parts{value}; };

  if (std::optional<ir::Elementary> function = elementaryOf(expr.builtin)) {
    evaluate(expr.args.size());
    return result(elementary(*function, operands));
  }
  // Results of out parameters.
  if (expr.builtin == Builtin::Modf || expr.builtin == Builtin::Frexp) {
    Num x = number(*expr.args[0]);
    Place target = place(*expr.args[1]);
    emitter.setLoc(module.location(expr.range));
    Num second;
    Num first = expr.builtin == Builtin::Modf ? modf(x, second) : module.library.frexp(x, second);
    store({second}, target);
    return result(first);
  }

  constexpr double pi = 3.14159265358979323846;
  switch (expr.builtin) {
  case Builtin::Radians:
    evaluate(1);
    return result(operands[0] * (pi / 180));
  case Builtin::Degrees:
    evaluate(1);
    return result(operands[0] * (180 / pi));
  case Builtin::PowInt:
    evaluate(2);
    return result(module.library.powInt(operands[0], operands[1]));
  case Builtin::Sqrt:
    evaluate(1);
    return result(sqrt(operands[0]));
  case Builtin::Abs:
    evaluate(1);
    return result(abs(operands[0]));
  case Builtin::Sign:
    evaluate(1);
    return result(sign(operands[0]));
  case Builtin::Floor:
    evaluate(1);
    return result(floor(operands[0]));
  case Builtin::Trunc:
    evaluate(1);
    return result(trunc(operands[0]));
  case Builtin::Round:
  case Builtin::RoundEven:
    evaluate(1);
    return result(roundEven(operands[0]));
  case Builtin::Ceil:
    evaluate(1);
    return result(ceil(operands[0]));
  case Builtin::Fract:
    evaluate(1);
    return result(fract(operands[0]));
  case Builtin::Mod:
    evaluate(2);
    return result(mod(operands[0], operands[1]));
  case Builtin::Min:
    evaluate(2);
    return result(isUnsigned(expr) ? minimumUnsigned(operands[0], operands[1])
                                   : minimum(operands[0], operands[1]));
  case Builtin::Max:
    evaluate(2);
    return result(isUnsigned(expr) ? maximumUnsigned(operands[0], operands[1])
                                   : maximum(operands[0], operands[1]));
  case Builtin::Clamp:
    evaluate(3);
    return result(isUnsigned(expr)
                      ? minimumUnsigned(maximumUnsigned(operands[0], operands[1]), operands[2])
                      : clamp(operands[0], operands[1], operands[2]));
  case Builtin::Mix:
    evaluate(3);
    return result(mix(operands[0], operands[1], operands[2]));
  case Builtin::MixSelect:
    evaluate(3);
    return result(select(operands[2], operands[1], operands[0]));
  case Builtin::Step:
    evaluate(2);
    return result(step(operands[0], operands[1]));
  case Builtin::SmoothStep:
    evaluate(3);
    return result(smoothstep(operands[0], operands[1], operands[2]));
  case Builtin::IsNan:
    evaluate(1);
    return result(isNan(operands[0]));
  case Builtin::IsInf:
    evaluate(1);
    return result(isInf(operands[0]));
  case Builtin::FloatBitsToInt:
  case Builtin::FloatBitsToUint:
    evaluate(1);
    // The bits of a NaN differ from machine to machine, so there is one NaN to see.
    return result(select(isNan(operands[0]), 0x7fc00000, operands[0].bits()));
  case Builtin::IntBitsToFloat:
  case Builtin::UintBitsToFloat:
    evaluate(1);
    return result(operands[0].asFloat());
  case Builtin::Fma:
    evaluate(3);
    return result(fma(operands[0], operands[1], operands[2]));
  case Builtin::Ldexp:
    evaluate(2);
    return result(module.library.ldexp(operands[0], operands[1]));
  case Builtin::Luminance:
    evaluate(1);
    return result(luminance(operands[0]));
  default:
    return std::nullopt;
  }
}

std::optional<Parts> FunctionLowering::lowerGeometricBuiltin(const typed::BuiltinExpr &expr) {
  llvm::SmallVector<Parts, 3> args;
  auto evaluate = [&] {
    for (const typed::ExprPtr &arg : expr.args)
      args.push_back(lower(*arg));
    emitter.setLoc(module.location(expr.range));
  };
  auto operand = [&](std::size_t i) { return num(args[i].front()); };
  auto matrix = [&](std::size_t i) { return columns(args[i]); };
  auto result = [](Num value) { return Parts{value}; };

  switch (expr.builtin) {
  case Builtin::Length:
    evaluate();
    return result(module.library.length(operand(0)));
  case Builtin::Distance:
    evaluate();
    return result(module.library.length(operand(0) - operand(1)));
  case Builtin::Dot:
    evaluate();
    return result(dot(operand(0), operand(1)));
  case Builtin::Cross:
    evaluate();
    return result(cross(operand(0), operand(1)));
  case Builtin::Normalize:
    evaluate();
    return result(module.library.normalize(operand(0)));
  case Builtin::FaceForward:
    evaluate();
    return result(faceforward(operand(0), operand(1), operand(2)));
  case Builtin::Reflect:
    evaluate();
    return result(reflect(operand(0), operand(1)));
  case Builtin::Refract:
    evaluate();
    return result(
        num(emitter.fold<ir::RefractOp>(operand(0).type(), operand(0), operand(1), operand(2))));
  case Builtin::PerpendicularTo:
    evaluate();
    return result(module.library.perpendicularTo(operand(0)));
  case Builtin::DominantAxis:
    evaluate();
    return result(dominantAxis(operand(0)));
  case Builtin::MinComponent:
  case Builtin::MaxComponent: {
    evaluate();
    bool isMinimum = expr.builtin == Builtin::MinComponent;
    if (!isUnsigned(expr))
      return result(isMinimum ? minComponent(operand(0)) : maxComponent(operand(0)));
    Num extreme = operand(0)[0];
    for (unsigned i = 1; i < operand(0).count(); ++i)
      extreme = isMinimum ? minimumUnsigned(extreme, operand(0)[i])
                          : maximumUnsigned(extreme, operand(0)[i]);
    return result(extreme);
  }
  case Builtin::Inside:
    evaluate();
    if (isUnsigned(*expr.args[0]))
      return result(all(!lessUnsigned(operand(0), operand(1))) &
                    all(!lessUnsigned(operand(2), operand(0))));
    return result(inside(operand(0), operand(1), operand(2)));

  case Builtin::MatrixCompMult: {
    evaluate();
    Parts products;
    for (std::size_t i = 0; i < args[0].size(); ++i)
      products.push_back(num(args[0][i]) * num(args[1][i]));
    return products;
  }
  case Builtin::OuterProduct:
    evaluate();
    return parts(outerProduct(operand(0), operand(1)));
  case Builtin::Transpose:
    evaluate();
    return parts(transpose(matrix(0)));
  case Builtin::Determinant:
    evaluate();
    return result(module.library.determinant(matrix(0)));
  case Builtin::Inverse:
    evaluate();
    return parts(module.library.inverse(matrix(0)));
  default:
    return std::nullopt;
  }
}

} // namespace rtsl::lowering
