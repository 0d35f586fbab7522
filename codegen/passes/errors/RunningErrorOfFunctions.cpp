//===- RunningErrorOfFunctions.cpp - errors of elementary functions -------===//
//
// f is computed once, in single precision, of the rounded argument; where f is smooth, the result
// is corrected by the derivative times the rounding of the argument.
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/errors/RunningError.h"

#include "codegen/ir/Rtsl.h"

#include <limits>

namespace rtsl {

using mlir::Value;

/// The error of an elementary function itself, for an exact argument. The bounds are relative to
/// the smallest normal number if the result is smaller.
Wide RunningError::ownError(ir::Elementary function, Wide result) {
  const Wide size = abs(result);
  if (function != ir::Elementary::Pow || !elementary.powGrows)
    return size * elementary.unit;
  const Wide normal = greater(size, size.like(std::numeric_limits<float>::min()));
  return normal * (1.0 + abs(single(ir::Elementary::Log2, normal))) * elementary.unit;
}

/// The function in single precision, of arguments rounded to it.
Wide RunningError::single(ir::Elementary function, llvm::ArrayRef<Wide> arguments) {
  llvm::SmallVector<Value> rounded;
  for (Wide argument : arguments)
    rounded.push_back(narrowed(argument));
  return widened(
      emitter,
      emitter.make<ir::ElementaryOp>(rounded.front().getType(), function, rounded).getResult());
}

/// A call f(x) of an elementary function with an inexact argument.
struct RunningError::FunctionCall {
  mlir::Operation *op;
  ir::Elementary function;
  llvm::SmallVector<Wide> arguments; // unrounded
  Wide x;                            // the first argument, rounded to single precision
  Wide moved;                        // by that rounding
  Value error;                       // bound of the error of the first argument; null: none
  Wide spread;                       // bound of how far x is off in total
  Wide result;                       // f(x)
  Wide own;                          // bound of the error of f itself
  Wide zero, one, infinite;          // constants
};

/// The single result f(x), x rounded, corrected by the derivative there times the rounding of x. If
/// that is not small compared with the distance of x from a point where f is not smooth, f(x) is
/// not corrected but gets a bound of its possible change.
Unrounded RunningError::ofFunction(mlir::Operation &op) {
  auto call = llvm::cast<ir::ElementaryOp>(op);
  const ir::Elementary function = call.getFunction();
  llvm::SmallVector<Wide> arguments;
  bool isExact = true;
  for (Value operand : call.getOperands()) {
    const Unrounded one = unrounded(operand);
    arguments.push_back({emitter, one.value});
    isExact &= one.isExact && !one.error;
  }
  const Wide result = single(function, arguments);
  const Wide own = ownError(function, result);
  if (isExact)
    return {result, own};

  const Wide x = widened(emitter, narrowed(arguments.front())), one = x.like(1);
  const Wide moved = arguments.front() - x;
  const Value error = unrounded(call.getOperands().front()).error;
  const Wide spread = error ? abs(moved) + Wide(emitter, error) : abs(moved);
  const Wide zero = x.like(0), infinite = x.like(std::numeric_limits<double>::infinity());
  const FunctionCall f = {&op,    function, arguments, x,    moved, error,
                          spread, result,   own,       zero, one,   infinite};
  if (function == ir::Elementary::Pow)
    return ofPow(f);
  if (function == ir::Elementary::Atan2)
    return ofAtan2(f);
  return ofUnaryFunction(f);
}

/// The result for an f that is smooth near x. `own`: bound of the error of f itself. `slope`: of f
/// at x. `room`: if x is off by less than half of this, the slope changes by at most the factor
/// 2 spread / room. `otherwise`: bound of the error if x is off by more.
Unrounded RunningError::alongTangent(const FunctionCall &f, Wide own, Wide slope, Wide room,
                                     Wide otherwise) {
  const Value isNear = isAtMost(2.0 * f.spread, room), isStill = isAtMost(f.spread, f.zero);
  const Wide shift = slope * f.moved, share = 2.0 * f.spread / room;
  const Wide left =
      abs(slope) * f.spread * share + (f.error ? abs(slope) * Wide(emitter, f.error) : f.zero);
  const Wide value = choose(isStill, f.result, choose(isNear, f.result + shift, f.result));
  return {value, own + choose(isStill, f.zero, choose(isNear, left, otherwise))};
}

Unrounded RunningError::ofUnaryFunction(const FunctionCall &f) {
  using F = ir::Elementary;
  const Wide x = f.x, spread = f.spread, result = f.result;
  const Wide none = f.zero, one = f.one, infinite = f.infinite;
  const auto same = [&](F other) { return single(other, x); }; // of the same argument
  const auto along = [&](Wide slope, Wide room, Wide otherwise) {
    return alongTangent(f, f.own, slope, room, otherwise);
  };
  switch (f.function) {
  case F::Sin:
    return along(same(F::Cos), one, spread);
  case F::Cos:
    return along(-same(F::Sin), one, spread);
  case F::SinPi:
    return along(3.141592653589793 * same(F::CosPi), x.like(0.25), 3.1415927 * spread);
  case F::CosPi:
    return along(-(3.141592653589793 * same(F::SinPi)), x.like(0.25), 3.1415927 * spread);
  case F::Atan:
    return along(1.0 / (one + x * x), one, spread);
  case F::Tanh:
    return along(one - result * result, one, spread);
  case F::Asinh:
    return along(1.0 / sqrt(one + x * x), one, spread);
  case F::Tan:
    return along(one + result * result, 1.0 / (one + abs(result)), infinite);
  case F::Sinh:
    return along(same(F::Cosh), one, infinite);
  case F::Cosh:
    return along(same(F::Sinh), one, infinite);
  case F::Asin:
  case F::Acos: { // beyond: at most pi / sqrt(2) times the root of the error of x
    const Wide slope = 1.0 / sqrt(greater(one - x * x, none));
    return along(f.function == F::Asin ? slope : -slope, one - abs(x), 2.2214415 * sqrt(spread));
  }
  case F::Acosh:
    return along(1.0 / sqrt(greater(x * x - one, none)), x - one, infinite);
  case F::Atanh:
    return along(1.0 / (one - x * x), one - abs(x), infinite);
  case F::Exp:
  case F::Expm1:
    return along(f.function == F::Exp ? result : result + one, one, infinite);
  case F::Exp2:
    return along(0.6931471805599453 * result, one, infinite);
  case F::Log:
    return along(1.0 / x, x, infinite);
  case F::Log2:
    return along(1.4426950408889634 / x, x, infinite);
  case F::Log1p:
    return along(1.0 / (one + x), one + x, infinite);
  case F::InverseSqrt:
    return along(-(result / (2.0 * x)), x, infinite);
  default:
    return fail(f.op->getLoc(), "it depends on an operation that the compiler does not analyse");
  }
}

Unrounded RunningError::ofPow(const FunctionCall &f) {
  using F = ir::Elementary;
  const Value exponent = f.op->getOperand(1);
  if (!unrounded(exponent).isExact)
    return fail(f.op->getLoc(), "it depends on an inexact exponent");
  // Beyond: |x^p - y^p| <= |x - y|^p for 0 <= p <= 1.
  const Wide x = f.x, p = f.arguments[1];
  Wide own = f.own;
  if (const Value rounding = unrounded(exponent).error) { // of x^p along p: x^p log x
    const Wide slope = choose(isAtMost(x, f.zero), f.zero, abs(f.result * single(F::Log, x)));
    own = own + slope * Wide(emitter, rounding);
  }
  const Wide root = single(F::Pow, {f.spread, p});
  const Wide far = choose(isAtMost(f.zero, p),
                          choose(isAtMost(p, f.one), 1.0000005 * root, f.infinite), f.infinite);
  return alongTangent(f, own, p * f.result / x, abs(x) / (f.one + abs(p)), far);
}

Unrounded RunningError::ofAtan2(const FunctionCall &f) {
  const Wide y = f.x, across = widened(emitter, narrowed(f.arguments[1]));
  const Unrounded other = unrounded(f.op->getOperand(1));
  const Wide movedAcross = f.arguments[1] - across;
  const Wide all = other.error ? f.spread + abs(movedAcross) + Wide(emitter, other.error)
                               : f.spread + abs(movedAcross);
  const Wide size = abs(y) + abs(across), square = y * y + across * across;
  const Value isNear = isAtMost(4.0 * all, size), isStill = isAtMost(all, f.zero);
  const Wide shift = (across * f.moved - y * movedAcross) / square, share = all / size;
  Wide left = 8.0 * share * share;
  if (f.error || other.error)
    left = left + 2.0 * share;
  return {choose(isStill, f.result, choose(isNear, f.result + shift, f.result)),
          f.own + choose(isStill, f.zero, choose(isNear, left, f.x.like(6.283185307179586)))};
}

} // namespace rtsl
