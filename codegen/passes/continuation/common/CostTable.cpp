//===- CostTable.cpp - costs of saving and recomputing --------------------===//
#include "codegen/passes/continuation/common/CostTable.h"

#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "llvm/ADT/TypeSwitch.h"

#include <algorithm>

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
    return 2;
  return llvm::isa_and_nonnull<ir::BufferElementOp>(base) ? 16 : 4;
}

std::int64_t recomputeCost(mlir::Operation *op) {
  if (op->hasTrait<mlir::OpTrait::ConstantLike>())
    return 0;
  std::int64_t width = op->getNumResults() == 0 ? 1 : components(op->getResult(0).getType());
  return llvm::TypeSwitch<mlir::Operation *, std::int64_t>(op)
      .Case<ir::StateOp, ir::MemberOp, ir::AttributeOp, ir::FieldOp, ir::CastRefOp, ir::NullRefOp,
            ir::FrameObjectOp, ir::PayloadOp, ir::TableOp>([](auto) { return 0; })
      .Case([](ir::ElementOp element) { return element.constantIndex() ? 0 : 2; })
      .Case<ir::CallArgumentOp>([&](auto) { return 4 * width; })
      .Case([&](ir::LoadOp load) { return loadCost(load.getAddress()) * width; })
      .Case<ir::BufferLengthOp, ir::ClassIdOp, ir::LightCountOp>([](auto) { return 2; })
      .Case([](ir::ExpressionOp expression) { return std::int64_t(expression.getCost()); })
      .Case<ir::BufferElementOp>([](auto) { return 6; })
      .Case<ir::AmbientOp>([&](auto) { return 2 * width; })
      .Case([&](ir::ElementaryOp function) {
        bool dear = function.getFunction() == ir::Elementary::Pow ||
                    function.getFunction() == ir::Elementary::Atan2;
        return (dear ? 100 : 40) * width;
      })
      .Case([](ir::HideOp) { return 0; })
      .Case([](ir::RefractOp) { return 60; })
      .Case<ir::ToSintOp, ir::ToUintOp>([&](auto) { return 4 * width; })
      .Case<ir::SDivOp, ir::UDivOp, ir::SRemOp, ir::URemOp>([&](auto) { return 12 * width; })
      .Case<arith::DivFOp, math::SqrtOp>([&](auto) { return 8 * width; })
      .Case<vector::ExtractOp>([](auto extract) { return extract.hasDynamicPosition() ? 4 : 0; })
      .Case<vector::BroadcastOp, vector::FromElementsOp, vector::ShuffleOp>(
          [](auto) { return 0; }) // in registers
      .Default([&](mlir::Operation *) { return width; });
}

std::int64_t loopFrequency(unsigned depth) {
  return std::int64_t(1) << (3 * std::min(depth, 4u));
}

std::int64_t saveCost(mlir::Type type, std::int64_t madeFrequency, std::int64_t traceFrequency) {
  if (type.isInteger(1))
    return boolCost * traceFrequency;
  std::int64_t words = ir::sizeInBytes(type) / 4;
  return words * ((loadWordCost + frameWordCost) * traceFrequency +
                  storeWordCost * std::min(madeFrequency, traceFrequency));
}

} // namespace rtsl::continuation
