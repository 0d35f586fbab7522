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

/// Operations that take vectors apart and put them together, and touch no number.
static bool onlyMoves(mlir::Operation &op) {
  return llvm::isa<vector::ExtractOp, vector::InsertOp, vector::FromElementsOp, vector::BroadcastOp,
                   vector::ShuffleOp>(op);
}

//===----------------------------------------------------------------------===//
// Errors that travel
//===----------------------------------------------------------------------===//

/// Nothing: none.
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

/// Half a unit of a literal that was rounded to single precision; 0 of whole numbers, 1e30 among
/// them, which only stands for what is far away, and of those with few digits in binary, such as
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
// The whole
//===----------------------------------------------------------------------===//

/// Calls `visit` for the values that flow into a float: operands, or what the branches pass.
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
  known.clear(); // some of it is not finished
  return std::nullopt;
}

Unrounded RunningError::fail(mlir::Location place, std::string reason) {
  if (!obstacle)
    obstacle = {place, std::move(reason)};
  return {};
}

/// What is the same in double, made where the emitter stands.
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

/// A block argument gets others beside it, for what flows in.
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
    edge.operands().append(zero); // until it is known
    if (hasErrors)
      edge.operands().append(zero);
    edges.push_back(edge);
  });
  for (ir::Edge edge : edges) {
    const Unrounded incoming = unrounded(edge.passedTo(argument));
    if (obstacle)
      return {};
    if (incoming.error && !made.error) // no float that isIterated has followed leads here
      return fail(argument.getLoc(), "it goes through a whole number, which may jump");
    edge.operands().getMutableForwardedOperands().slice(index, 1).assign(incoming.value);
    if (incoming.error)
      edge.operands().getMutableForwardedOperands().slice(index + 1, 1).assign(incoming.error);
  }
  return made;
}

Unrounded RunningError::ofResult(mlir::Operation &op) {
  // What operands are comes first: it stands right behind what made them.
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
        Wide least = abs(wide(1)); // that the divisor may be
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
      .Case([&](arith::SelectOp) { return ofChoice(op); })
      .Case([&](ir::ElementaryOp) { return ofFunction(op); })
      .Case([&](ir::LoadOp) { return ofLoad(op); })
      .Case<arith::SIToFPOp, arith::UIToFPOp, arith::BitcastOp>([&](auto conversion) -> Unrounded {
        llvm::DenseMap<Value, bool> seen;
        if (!isExactWhole(conversion->getOperand(0), seen))
          return fail(op.getLoc(), "it goes through a whole number, which may jump");
        emitter.setInsertionPointAfter(&op);
        if (llvm::isa<arith::BitcastOp>(op))
          return exact(op.getResult(0));
        using Op = decltype(conversion);
        if constexpr (std::is_same_v<Op, arith::BitcastOp>)
          return {};
        else
          return {emitter.fold<Op>(wideType(op.getResult(0).getType()), conversion->getOperand(0)),
                  {}};
      })
      .Case<math::FloorOp, math::CeilOp, math::TruncOp, math::RoundEvenOp>([&](auto) -> Unrounded {
        if (unrounded(op.getOperand(0)).isExact)
          return exact(op.getResult(0));
        return fail(op.getLoc(), "it goes through a whole number, which may jump");
      })
      .Case([&](ir::HideOp) { return unrounded(op.getOperand(0)); })
      .Case([&](ir::RandOp) { return fail(op.getLoc(), "it depends on `rand`"); })
      .Default([&](mlir::Operation *) {
        return onlyMoves(op)
                   ? ofParts(op)
                   : fail(op.getLoc(), "it goes through what the compiler does not follow");
      });
}

//===----------------------------------------------------------------------===//
// Operations
//===----------------------------------------------------------------------===//

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
  return fail(op.getLoc(), "it goes through an array whose index is known at run time only");
}

/// Of a vector's parts.
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

/// Of `min` and `max` it is known what they choose without roundings; of others the condition
/// decides (compareUnrounded).
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

/// How far a result is off from the function of the very argument. The bounds are relative to the
/// smallest normal number where the result is smaller.
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

/// The single result f(x), x rounded, moved by the slope there times what the rounding took. Where
/// that is not small beside the distance of x from where the function bends, f(x) is left as it is,
/// with a bound of how far it may change.
Unrounded RunningError::ofFunction(mlir::Operation &op) {
  using F = ir::Elementary;
  auto call = llvm::cast<ir::ElementaryOp>(op);
  const F function = call.getFunction();
  llvm::SmallVector<Wide> arguments;
  bool isExact = true;
  for (Value operand : call.getOperands()) {
    const Unrounded one = unrounded(operand);
    arguments.push_back({emitter, one.value});
    isExact &= one.isExact && !one.error;
  }
  const Wide result = single(function, arguments);
  Wide own = ownError(function, result);
  if (isExact)
    return {result, own};

  const Wide x = widened(emitter, narrowed(arguments.front())), one = x.like(1);
  const Wide moved = arguments.front() - x;
  const Value found = unrounded(call.getOperands().front()).error;
  // that x may be off by
  const Wide spread = found ? abs(moved) + Wide(emitter, found) : abs(moved);
  const Wide none = x.like(0), infinite = x.like(std::numeric_limits<double>::infinity());
  const auto same = [&](F other) { return single(other, x); }; // of the same argument
  /// `room`: within half of this the tangent is off by at most twice the share of it that x is off
  /// by. `otherwise`: how far f may be off beyond.
  const auto alongTangent = [&](Wide slope, Wide room, Wide otherwise) -> Unrounded {
    const Value isNear = isAtMost(2.0 * spread, room), isStill = isAtMost(spread, none);
    const Wide shift = slope * moved, share = 2.0 * spread / room;
    const Wide left =
        abs(slope) * spread * share + (found ? abs(slope) * Wide(emitter, found) : none);
    const Wide value = choose(isStill, result, choose(isNear, result + shift, result));
    return {value, own + choose(isStill, none, choose(isNear, left, otherwise))};
  };

  switch (function) {
  case F::Sin:
    return alongTangent(same(F::Cos), one, spread);
  case F::Cos:
    return alongTangent(-same(F::Sin), one, spread);
  case F::SinPi:
    return alongTangent(3.141592653589793 * same(F::CosPi), x.like(0.25), 3.1415927 * spread);
  case F::CosPi:
    return alongTangent(-(3.141592653589793 * same(F::SinPi)), x.like(0.25), 3.1415927 * spread);
  case F::Atan:
    return alongTangent(1.0 / (one + x * x), one, spread);
  case F::Tanh:
    return alongTangent(one - result * result, one, spread);
  case F::Asinh:
    return alongTangent(1.0 / sqrt(one + x * x), one, spread);
  case F::Tan:
    return alongTangent(one + result * result, 1.0 / (one + abs(result)), infinite);
  case F::Sinh:
    return alongTangent(same(F::Cosh), one, infinite);
  case F::Cosh:
    return alongTangent(same(F::Sinh), one, infinite);
  case F::Asin:
  case F::Acos: { // beyond: at most pi / sqrt(2) times the root of the error of x
    const Wide slope = 1.0 / sqrt(greater(one - x * x, none));
    return alongTangent(function == F::Asin ? slope : -slope, one - abs(x),
                        2.2214415 * sqrt(spread));
  }
  case F::Acosh:
    return alongTangent(1.0 / sqrt(greater(x * x - one, none)), x - one, infinite);
  case F::Atanh:
    return alongTangent(1.0 / (one - x * x), one - abs(x), infinite);
  case F::Exp:
  case F::Expm1:
    return alongTangent(function == F::Exp ? result : result + one, one, infinite);
  case F::Exp2:
    return alongTangent(0.6931471805599453 * result, one, infinite);
  case F::Log:
    return alongTangent(1.0 / x, x, infinite);
  case F::Log2:
    return alongTangent(1.4426950408889634 / x, x, infinite);
  case F::Log1p:
    return alongTangent(1.0 / (one + x), one + x, infinite);
  case F::InverseSqrt:
    return alongTangent(-(result / (2.0 * x)), x, infinite);
  case F::Pow: {
    const Value exponent = call.getOperands()[1];
    if (!unrounded(exponent).isExact)
      return fail(op.getLoc(), "it depends on an exponent that is not exact");
    // Beyond: |x^p - y^p| <= |x - y|^p for 0 <= p <= 1.
    const Wide p = arguments[1];
    if (const Value rounding = unrounded(exponent).error) { // of x^p along p: x^p log x
      const Wide slope = choose(isAtMost(x, none), none, abs(result * same(F::Log)));
      own = own + slope * Wide(emitter, rounding);
    }
    const Wide root = single(F::Pow, {spread, p});
    const Wide far =
        choose(isAtMost(none, p), choose(isAtMost(p, one), 1.0000005 * root, infinite), infinite);
    return alongTangent(p * result / x, abs(x) / (one + abs(p)), far);
  }
  case F::Atan2: {
    const Wide y = x, across = widened(emitter, narrowed(arguments[1]));
    const Unrounded other = unrounded(call.getOperands()[1]);
    const Wide movedAcross = arguments[1] - across;
    const Wide all = other.error ? spread + abs(movedAcross) + Wide(emitter, other.error)
                                 : spread + abs(movedAcross);
    const Wide size = abs(y) + abs(across), square = y * y + across * across;
    const Value isNear = isAtMost(4.0 * all, size), isStill = isAtMost(all, none);
    const Wide shift = (across * moved - y * movedAcross) / square, share = all / size;
    Wide left = 8.0 * share * share;
    if (found || other.error)
      left = left + 2.0 * share;
    return {choose(isStill, result, choose(isNear, result + shift, result)),
            own + choose(isStill, none, choose(isNear, left, x.like(6.283185307179586)))};
  }
  }
  return fail(op.getLoc(), "it goes through what the compiler does not follow");
}

//===----------------------------------------------------------------------===//
// What has no error that could be given
//===----------------------------------------------------------------------===//

/// Does a loop compute the value, or what it depends on, from itself? How far an iteration is from
/// where it leads to is no rounding. That a loop chooses among values, as the least of several
/// roots, is no iteration.
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
        (void)fail(op->getLoc(), "a loop computes it from what it was before");
        return true;
      }
  }
  return false;
}

/// Is every float exact that a whole number or a condition depends on?
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
