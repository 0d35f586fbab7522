#include "codegen/passes/errors/RunningError.h"

#include "codegen/ir/IncomingEdges.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/passes/Components.h"

#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/IRMapping.h"
#include "mlir/IR/Matchers.h"
#include "llvm/ADT/TypeSwitch.h"

#include <cmath>
#include <limits>

namespace rtsl {

using lowering::Emitter;
using lowering::scalarType;
using mlir::Value;
namespace arith = mlir::arith;
namespace math = mlir::math;
namespace vector = mlir::vector;

static bool isFloats(Value value) {
  return scalarType(value.getType()).isF32();
}

/// Operations that only split and combine vectors.
static bool onlyMoves(mlir::Operation &op) {
  return llvm::isa<vector::ExtractOp, vector::InsertOp, vector::FromElementsOp, vector::BroadcastOp,
                   vector::ShuffleOp>(op);
}

//===----------------------------------------------------------------------===//
// Propagation of errors
//===----------------------------------------------------------------------===//

/// Nothing: exact.
using Error = std::optional<Wide>;

static Error plus(Error a, Error b) {
  if (!a || !b)
    return a ? a : b;
  return *a + *b;
}
static Error times(Error error, Wide factor) {
  if (!error)
    return error;
  return *error * abs(factor);
}
static Error timesBoth(Error a, Error b) {
  if (!a || !b)
    return std::nullopt;
  return *a * *b;
}
static Value valueOf(Error error) {
  return error ? Value(*error) : Value();
}

/// The largest rounding of a literal to single precision, half a unit; 0 for whole numbers,
/// including 1e30, which is used as infinity, and for numbers with few binary digits, such as
/// 0.375.
static double roundingOf(const llvm::APFloat &literal) {
  const double value = literal.convertToDouble();
  const bool isWhole = value == std::trunc(value);
  const bool isShort = (literal.bitcastToAPInt().getZExtValue() & 0xff) == 0;
  return isWhole || isShort || !literal.isFinite() ? 0 : std::abs(value) * 0x1p-24;
}

/// The roundings of a constant's components.
static llvm::SmallVector<double> roundingsOf(mlir::Operation &constant) {
  mlir::Attribute value;
  mlir::matchPattern(&constant, mlir::m_Constant(&value));
  llvm::SmallVector<double> roundings;
  if (auto scalar = llvm::dyn_cast_or_null<mlir::FloatAttr>(value))
    roundings.push_back(roundingOf(scalar.getValue()));
  else if (auto vector = llvm::dyn_cast_or_null<mlir::DenseFPElementsAttr>(value))
    for (const llvm::APFloat &component : vector.getValues<llvm::APFloat>())
      roundings.push_back(roundingOf(component));
  return roundings;
}

static bool bringsError(mlir::Operation *op) {
  if (!op)
    return false;
  return llvm::isa<ir::ElementaryOp>(op) ||
         (op->hasTrait<mlir::OpTrait::ConstantLike>() && isFloats(op->getResult(0)) &&
          llvm::any_of(roundingsOf(*op), [](double rounding) { return rounding != 0; }));
}

//===----------------------------------------------------------------------===//
// The function
//===----------------------------------------------------------------------===//

/// Calls `visit` for the values that flow into a float: operands, or those passed by branches.
static void forEachSource(Value value, llvm::function_ref<void(Value)> visit) {
  if (auto argument = llvm::dyn_cast<mlir::BlockArgument>(value)) {
    mlir::Block *block = argument.getOwner();
    if (block->isEntryBlock())
      return;
    ir::forEachEdgeInto(*block, [&](ir::Edge edge) { visit(edge.passedTo(argument)); });
    return;
  }
  for (Value operand : value.getDefiningOp()->getOperands())
    if (isFloats(operand))
      visit(operand);
}

RunningError::RunningError(mlir::func::FuncOp function, ElementaryErrors elementary)
    : function(function), elementary(elementary), emitter(function.getContext()) {}

std::optional<Unrounded> RunningError::of(Value value) {
  obstacle.reset();
  if (isIterated(value))
    return std::nullopt;
  const Unrounded found = unrounded(value);
  if (!obstacle)
    return found;
  known.clear(); // some of it is incomplete
  return std::nullopt;
}

Unrounded RunningError::fail(mlir::Location place, std::string reason) {
  if (!obstacle)
    obstacle = {place, std::move(reason)};
  return {};
}

/// The same value in double, converted at the insertion point.
Unrounded RunningError::exact(Value value) {
  return {widened(emitter, value), {}, true};
}

Unrounded RunningError::unrounded(Value value) {
  if (obstacle)
    return {};
  if (auto found = known.find(value); found != known.end())
    return found->second;
  if (auto argument = llvm::dyn_cast<mlir::BlockArgument>(value))
    return ofArgument(argument);
  const Unrounded made = ofResult(*value.getDefiningOp());
  known[value] = made;
  return made;
}

/// Adds parallel block arguments for the double value and its error.
Unrounded RunningError::ofArgument(mlir::BlockArgument argument) {
  mlir::Block *block = argument.getOwner();
  emitter.setLoc(argument.getLoc());
  emitter.setInsertionPointToStart(&function.getBody().front());
  if (block->isEntryBlock())
    return known[argument] = exact(argument);
  mlir::Type type = wideType(argument.getType());
  const Value zero = emitter.make<arith::ConstantOp>(emitter.getZeroAttr(type));
  Unrounded made = {block->addArgument(type, argument.getLoc()), {}, false};
  const unsigned index = block->getNumArguments() - 1;
  if (hasErrors)
    made.error = block->addArgument(type, argument.getLoc());
  known[argument] = made;

  llvm::SmallVector<ir::Edge> edges;
  ir::forEachEdgeInto(*block, [&](ir::Edge edge) {
    edge.operands().append(zero); // until the value is known
    if (hasErrors)
      edge.operands().append(zero);
    edges.push_back(edge);
  });
  for (ir::Edge edge : edges) {
    const Unrounded incoming = unrounded(edge.passedTo(argument));
    if (obstacle)
      return {};
    if (incoming.error && !made.error) // no float that isIterated has followed leads here
      return fail(argument.getLoc(), "it depends on a whole number, which changes in steps");
    edge.operands().getMutableForwardedOperands().slice(index, 1).assign(incoming.value);
    if (incoming.error)
      edge.operands().getMutableForwardedOperands().slice(index + 1, 1).assign(incoming.error);
  }
  return made;
}

Unrounded RunningError::ofResult(mlir::Operation &op) {
  // Operands first: their code comes right after their definitions.
  for (Value operand : op.getOperands())
    if (isFloats(operand))
      (void)unrounded(operand);
  if (obstacle)
    return {};
  emitter.setLoc(op.getLoc());
  emitter.setInsertionPointAfter(&op);
  if (op.hasTrait<mlir::OpTrait::ConstantLike>())
    return ofConstant(op);
  if (llvm::isa<ir::HideOp>(op)) // --fp=double: the same number
    return unrounded(op.getOperand(0));
  return llvm::TypeSwitch<mlir::Operation *, Unrounded>(&op)
      .Case<arith::AddFOp, arith::SubFOp, arith::MulFOp, math::FmaOp, arith::DivFOp, math::SqrtOp,
            arith::NegFOp, math::AbsFOp>([&](auto) { return ofArithmetic(op); })
      .Case([&](arith::SelectOp) { return ofChoice(op); })
      .Case([&](ir::ElementaryOp) { return ofFunction(op); })
      .Case([&](ir::LoadOp) { return ofLoad(op); })
      .Case<arith::SIToFPOp, arith::UIToFPOp, arith::BitcastOp>(
          [&](auto) { return ofConversion(op); })
      .Case<math::FloorOp, math::CeilOp, math::TruncOp, math::RoundEvenOp>([&](auto) -> Unrounded {
        if (unrounded(op.getOperand(0)).isExact)
          return exact(op.getResult(0));
        return fail(op.getLoc(), "it depends on a whole number, which changes in steps");
      })
      .Case([&](ir::HideOp) { return unrounded(op.getOperand(0)); })
      .Case([&](ir::RandOp) { return fail(op.getLoc(), "it depends on `rand`"); })
      .Default([&](mlir::Operation *) {
        return onlyMoves(op)
                   ? ofParts(op)
                   : fail(op.getLoc(),
                          "it depends on an operation that the compiler does not analyse");
      });
}

//===----------------------------------------------------------------------===//
// Operations
//===----------------------------------------------------------------------===//

Unrounded RunningError::ofArithmetic(mlir::Operation &op) {
  const auto wide = [&](unsigned index) {
    return Wide(emitter, unrounded(op.getOperand(index)).value);
  };
  const auto error = [&](unsigned index) {
    const Value found = unrounded(op.getOperand(index)).error;
    return found ? Error(Wide(emitter, found)) : std::nullopt;
  };
  const auto product = [&] {
    return plus(plus(times(error(0), wide(1)), times(error(1), wide(0))),
                timesBoth(error(0), error(1)));
  };
  return llvm::TypeSwitch<mlir::Operation *, Unrounded>(&op)
      .Case([&](arith::AddFOp) -> Unrounded {
        return {wide(0) + wide(1), valueOf(plus(error(0), error(1)))};
      })
      .Case([&](arith::SubFOp) -> Unrounded {
        return {wide(0) - wide(1), valueOf(plus(error(0), error(1)))};
      })
      .Case([&](arith::MulFOp) -> Unrounded { return {wide(0) * wide(1), valueOf(product())}; })
      .Case([&](math::FmaOp) -> Unrounded {
        return {wide(0).apply<math::FmaOp>(wide(1), wide(2)), valueOf(plus(product(), error(2)))};
      })
      .Case([&](arith::DivFOp) -> Unrounded {
        const Wide quotient = wide(0) / wide(1);
        if (!error(0) && !error(1))
          return {quotient, {}};
        Wide least = abs(wide(1)); // the smallest possible divisor
        if (error(1))
          least = greater(least - *error(1), least.like(0));
        return {quotient, *plus(error(0), times(error(1), quotient)) / least};
      })
      .Case([&](math::SqrtOp) -> Unrounded {
        const Wide root = sqrt(greater(wide(0), wide(0).like(0)));
        if (!error(0))
          return {root, {}};
        // |sqrt(x) - sqrt(y)| with |x - y| <= e is at most e / sqrt(x), and at most sqrt(e).
        const Wide most = sqrt(*error(0));
        const Value none = isAtMost(most, most.like(0));
        return {root, choose(none, most, *error(0) / greater(root, most))};
      })
      .Case([&](arith::NegFOp) -> Unrounded {
        return {-wide(0), valueOf(error(0)), unrounded(op.getOperand(0)).isExact};
      })
      .Case([&](math::AbsFOp) -> Unrounded {
        return {abs(wide(0)), valueOf(error(0)), unrounded(op.getOperand(0)).isExact};
      })
      .Default(
          [&](mlir::Operation *) -> Unrounded { llvm_unreachable("no arithmetic operation"); });
}

/// Integers and bit patterns as floats.
Unrounded RunningError::ofConversion(mlir::Operation &op) {
  const Value whole = op.getOperand(0);
  llvm::DenseMap<Value, bool> seen;
  if (!isExactWhole(whole, seen))
    return fail(op.getLoc(), "it depends on a whole number, which changes in steps");
  emitter.setInsertionPointAfter(&op);
  if (llvm::isa<arith::BitcastOp>(op))
    return exact(op.getResult(0));
  const mlir::Type type = wideType(op.getResult(0).getType());
  return {llvm::isa<arith::SIToFPOp>(op) ? emitter.fold<arith::SIToFPOp>(type, whole)
                                         : emitter.fold<arith::UIToFPOp>(type, whole),
          {}};
}

Unrounded RunningError::ofConstant(mlir::Operation &op) {
  Unrounded made = exact(op.getResult(0));
  if (!bringsError(&op))
    return made;
  mlir::Type type = wideType(op.getResult(0).getType());
  const llvm::SmallVector<double> roundings = roundingsOf(op);
  mlir::TypedAttr error = emitter.getF64FloatAttr(roundings.front());
  if (auto vector = llvm::dyn_cast<mlir::VectorType>(type))
    error = mlir::DenseElementsAttr::get(vector, llvm::ArrayRef(roundings));
  made.error = emitter.make<arith::ConstantOp>(error);
  return made;
}

Unrounded RunningError::ofLoad(mlir::Operation &op) {
  mlir::Operation *from = llvm::cast<ir::LoadOp>(op).getAddress().getDefiningOp();
  while (llvm::isa_and_nonnull<ir::FieldOp, ir::ElementOp, ir::BufferElementOp>(from))
    from = from->getOperand(0).getDefiningOp();
  if (llvm::isa_and_nonnull<ir::StateOp, ir::MemberOp, ir::TableOp>(from))
    return exact(op.getResult(0));
  return fail(op.getLoc(), "it depends on an array element with an index known only at run time");
}

/// For operations on a vector's components.
Unrounded RunningError::ofParts(mlir::Operation &op) {
  mlir::IRMapping values, errors;
  bool isExact = true, hasError = false;
  for (Value operand : op.getOperands()) {
    if (!isFloats(operand))
      continue;
    const Unrounded one = unrounded(operand);
    isExact &= one.isExact;
    hasError |= static_cast<bool>(one.error);
    values.map(operand, one.value);
    errors.map(operand, one.error ? one.error : Value(Wide(emitter, one.value).like(0)));
  }
  const auto copy = [&](mlir::IRMapping &operands) {
    mlir::Operation *made = op.cloneWithoutRegions(operands);
    made->getResult(0).setType(wideType(op.getResult(0).getType()));
    return emitter.OpBuilder::insert(made)->getResult(0);
  };
  Unrounded made = {copy(values), {}, isExact};
  if (hasError)
    made.error = copy(errors);
  return made;
}

/// `min` and `max` choose by the unrounded values; other choices are made by the condition
/// (compareUnrounded).
Unrounded RunningError::ofChoice(mlir::Operation &op) {
  auto choice = llvm::cast<arith::SelectOp>(op);
  const Unrounded a = unrounded(choice.getTrueValue()), b = unrounded(choice.getFalseValue());
  const Wide first(emitter, a.value), second(emitter, b.value);
  const auto errorOf = [&](const Unrounded &one) {
    return one.error ? Wide(emitter, one.error) : first.like(0);
  };
  const bool hasError = a.error || b.error;
  auto comparison = choice.getCondition().getDefiningOp<arith::CmpFOp>();
  const auto compares = [&](Value left, Value right) {
    return comparison && comparison.getLhs() == left && comparison.getRhs() == right;
  };
  const bool isInOrder = compares(choice.getTrueValue(), choice.getFalseValue());
  if (isInOrder || compares(choice.getFalseValue(), choice.getTrueValue())) {
    const Value condition = emitter.fold<arith::CmpFOp>(
        comparison.getPredicate(), isInOrder ? first : second, isInOrder ? second : first);
    return {choose(condition, first, second),
            hasError ? Value(greater(errorOf(a), errorOf(b))) : Value(), a.isExact && b.isExact};
  }
  return {choose(choice.getCondition(), first, second),
          hasError ? Value(choose(choice.getCondition(), errorOf(a), errorOf(b))) : Value(),
          a.isExact && b.isExact};
}

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

//===----------------------------------------------------------------------===//
// Values without a known error
//===----------------------------------------------------------------------===//

/// Does a loop compute the value, or an operand of it, from its previous value? The error of an
/// iteration is not due to rounding alone. A loop that chooses among values, such as the least of
/// several roots, is no iteration.
bool RunningError::isIterated(Value value) {
  llvm::SmallSetVector<Value, 16> reached;
  reached.insert(value);
  hasErrors = false;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    hasErrors |= bringsError(reached[i].getDefiningOp());
    forEachSource(reached[i], [&](Value source) { reached.insert(source); });
  }
  for (const auto &component : Components<Value>::of(reached, forEachSource)) {
    if (component.size() == 1)
      continue; // an operation does not use its own result
    for (Value part : component)
      if (mlir::Operation *op = part.getDefiningOp();
          op && !onlyMoves(*op) && !llvm::isa<arith::SelectOp, ir::HideOp>(op)) {
        (void)fail(op->getLoc(), "a loop computes it from its previous value");
        return true;
      }
  }
  return false;
}

/// Is every float exact that an integer or a condition depends on?
bool RunningError::isExactWhole(Value value, llvm::DenseMap<Value, bool> &seen) {
  if (isFloats(value))
    return unrounded(value).isExact && !obstacle;
  if (const auto [found, isNew] = seen.try_emplace(value, true); !isNew)
    return found->second;
  bool result = true;
  if (llvm::isa<mlir::BlockArgument>(value)) {
    forEachSource(value, [&](Value source) { result &= isExactWhole(source, seen); });
  } else {
    for (Value operand : value.getDefiningOp()->getOperands())
      if (!llvm::isa<ir::PtrType, ir::RefType>(operand.getType()))
        result &= isExactWhole(operand, seen);
  }
  return seen[value] = result;
}

} // namespace rtsl
