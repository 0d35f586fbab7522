//===- CostTable.cpp - costs of saving and recomputing --------------------===//
#include "codegen/passes/continuation/common/CostTable.h"

#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/Rtsl.h"
#include "language/Costs.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "llvm/ADT/TypeSwitch.h"

#include <algorithm>
#include <optional>

namespace rtsl::continuation {

namespace arith = mlir::arith;
namespace math = mlir::math;
namespace vector = mlir::vector;

static std::int64_t components(mlir::Type type) {
  auto shape = llvm::dyn_cast<mlir::VectorType>(type);
  return shape ? shape.getNumElements() : 1;
}

/// Cost of a load for each word, by the memory it loads from.
static std::int64_t loadCost(mlir::Value address) {
  mlir::Operation *base = ir::baseOperation(address);
  if (llvm::isa_and_nonnull<ir::MemberOp, ir::TableOp>(base))
    return cost::memberLoad;
  return llvm::isa_and_nonnull<ir::BufferElementOp>(base) ? cost::bufferLoad : cost::load;
}

/// The cost for each component of the result; nothing: the operation computes no components.
static std::optional<std::int64_t> componentCost(mlir::Operation *op) {
  using Cost = std::optional<std::int64_t>;
  return llvm::TypeSwitch<mlir::Operation *, Cost>(op)
      .Case([](ir::LoadOp load) { return Cost(loadCost(load.getAddress())); })
      .Case<ir::CallArgumentOp>([](auto) { return Cost(cost::load); })
      .Case<ir::AmbientOp>([](auto) { return Cost(cost::memberLoad); })
      .Case([](ir::ElementaryOp call) {
        return Cost(call.getOperands().size() == 2 ? cost::power : cost::elementary);
      })
      .Case<ir::ToSintOp, ir::ToUintOp>([](auto) { return Cost(cost::conversionToInt); })
      .Case<ir::SDivOp, ir::UDivOp, ir::SRemOp, ir::URemOp>(
          [](auto) { return Cost(cost::integerDivision); })
      .Case<arith::DivFOp>([](auto) { return Cost(cost::division); })
      .Case<math::SqrtOp>([](auto) { return Cost(cost::squareRoot); })
      .Default([](mlir::Operation *) { return std::nullopt; });
}

std::int64_t recomputeCost(mlir::Operation *op) {
  if (op->hasTrait<mlir::OpTrait::ConstantLike>())
    return 0;
  const std::int64_t width = op->getNumResults() == 0 ? 1 : components(op->getResult(0).getType());
  if (auto each = componentCost(op))
    return *each * width;
  return llvm::TypeSwitch<mlir::Operation *, std::int64_t>(op)
      .Case<ir::StateOp, ir::MemberOp, ir::AttributeOp, ir::FieldOp, ir::CastRefOp, ir::NullRefOp,
            ir::FrameObjectOp, ir::PayloadOp, ir::TableOp, ir::HideOp>([](auto) { return 0; })
      .Case<vector::BroadcastOp, vector::FromElementsOp, vector::ShuffleOp>([](auto) { return 0; })
      .Case([](ir::ElementOp op) { return op.constantIndex() ? 0 : cost::elementAddress; })
      .Case<ir::AtomicOp>([](auto) { return cost::atomic; })
      .Case<ir::BufferElementOp>([](auto) { return cost::bufferElementAddress; })
      .Case<ir::BufferLengthOp, ir::ClassIdOp, ir::LightCountOp, ir::LightMayPassOp>(
          [](auto) { return cost::sizeQuery; })
      .Case(
          [](vector::ExtractOp op) { return op.hasDynamicPosition() ? cost::dynamicComponent : 0; })
      .Case([](ir::ExpressionOp op) { return op.getCost(); })
      .Case([](ir::RefractOp) { return cost::refraction; })
      .Default([&](mlir::Operation *) { return cost::arithmetic * width; });
}

std::int64_t loopFrequency(unsigned depth) {
  return std::int64_t(1) << (3 * std::min(depth, 4u));
}

std::int64_t saveCost(mlir::Type type, std::int64_t madeFrequency, std::int64_t traceFrequency) {
  if (type.isInteger(1))
    return cost::frameBool * traceFrequency;
  std::int64_t words = ir::sizeInBytes(type) / 4;
  return words * ((cost::frameLoad + cost::frameWord) * traceFrequency +
                  cost::frameStore * std::min(madeFrequency, traceFrequency));
}

} // namespace rtsl::continuation
