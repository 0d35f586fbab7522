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
