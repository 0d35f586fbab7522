#include "codegen/passes/errors/BoundHitError.h"

#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/lower/Emitter.h"
#include "codegen/lower/Library.h"
#include "codegen/passes/errors/Wide.h"
#include "runtime/device/HitError.h"

#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/Pass/Pass.h"

#include <limits>

namespace rtsl {

using namespace lowering;

/// What `intersect` does beside computing t.
static void dropEffects(mlir::func::FuncOp function) {
  function.walk([](mlir::Operation *op) {
    auto store = llvm::dyn_cast<ir::StoreOp>(op);
    auto copy = llvm::dyn_cast<ir::CopyOp>(op);
    const Value target = store ? store.getAddress() : copy ? copy.getTarget() : Value();
    mlir::Operation *into = target ? ir::baseOperation(target) : nullptr;
    if (llvm::isa<ir::PrintOp, ir::RaiseOp>(op) || llvm::isa_and_nonnull<ir::AttributeOp>(into))
      op->erase();
  });
}

/// Nothing was hit yet that `intersect` could see.
static void forgetOtherHits(mlir::func::FuncOp function) {
  function.walk([](ir::LoadOp load) {
    auto state = load.getAddress().getDefiningOp<ir::StateOp>();
    if (!state || state.getName() != "HitDistance")
      return;
    Emitter emitter(load.getContext());
    emitter.setLoc(load.getLoc());
    emitter.setInsertionPoint(load);
    load.replaceAllUsesWith(emitter.floatConstant(std::numeric_limits<float>::infinity()));
    load.erase();
  });
}

static Num stateOf(Emitter &emitter, llvm::StringRef name) {
  return {emitter, emitter.load(emitter.make<ir::StateOp>(name, emitter.getF32Type()))};
}

bool boundHitError(mlir::func::FuncOp intersect, double unit, std::vector<UnboundHit> &unbound) {
  llvm::SmallVector<ir::HitOp> hits;
  intersect.walk([&](ir::HitOp hit) { hits.push_back(hit); });
  dropEffects(intersect);
  forgetOtherHits(intersect);

  RunningError errors(intersect, unit);
  Emitter emitter(intersect.getContext());
  emitter.setLoc(intersect.getLoc());
  emitter.setInsertionPointToStart(&intersect.getBody().front());
  const Num distance = stateOf(emitter, "HitDistance");
  const Value bound = emitter.variable("bound", emitter.getF32Type());
  const Value atFirst = emitter.floatConstant(device::errorNotStated);
  emitter.store(atFirst, bound);
  const Value nearest = emitter.variable("nearest", emitter.getF32Type());
  emitter.store(emitter.floatConstant(std::numeric_limits<float>::infinity()), nearest);
  bool hasBound = false, allHaveBounds = true;
  for (ir::HitOp hit : hits) {
    const std::optional<Unrounded> exact = hit.getError() ? std::nullopt : errors.of(hit.getT());
    if (!exact && !hit.getError())
      unbound.push_back({hit.getLoc(), errors.whyUnknown().reason});
    emitter.setLoc(hit.getLoc());
    emitter.setInsertionPoint(hit);
    const Num t(emitter, hit.getT());
    if (exact) {
      // The hit that is nearest to T; where arithmetic is not strict, its t is not the very same again.
      const Num before(emitter, emitter.load(bound)), least(emitter, emitter.load(nearest));
      const Num away = abs(t - distance), isThis = less(away, least) & lessEqual(away, abs(distance) * 0x1p-6);
      Wide error = abs(widened(emitter, distance) - Wide(emitter, exact->value));
      if (exact->error)
        error = error + Wide(emitter, exact->error);
      emitter.store(select(isThis, {emitter, narrowed(error)}, before), bound);
      emitter.store(select(isThis, away, least), nearest);
      hasBound = true;
    } else {
      allHaveBounds = false;
    }
    // Of a hit that is nearer it is known that it did not count; of one that is further away, that it would have.
    hit.replaceAllUsesWith(Value(less(distance, t)));
    hit.erase();
  }
  if (allHaveBounds) // a hit that none of them is was there by rounding alone
    llvm::cast<mlir::arith::ConstantOp>(atFirst.getDefiningOp())
        .setValueAttr(emitter.getF32FloatAttr(device::hitNotFound));
  for (mlir::Block &block : intersect.getBody())
    if (llvm::isa<mlir::func::ReturnOp>(block.getTerminator())) {
      emitter.setInsertionPoint(block.getTerminator());
      emitter.store(emitter.load(bound), emitter.make<ir::StateOp>("hitError", emitter.getF32Type()));
    }
  bool draws = false;
  intersect.walk([&](ir::RandOp) { draws = true; });
  return hasBound && !draws;
}

namespace {

struct BoundHitErrorPass : mlir::PassWrapper<BoundHitErrorPass, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(BoundHitErrorPass)
  llvm::StringRef getArgument() const override { return "rtsl-bound-hit-error"; }
  llvm::StringRef getDescription() const override {
    return "`intersect` becomes a function that bounds the error of its t";
  }
  void getDependentDialects(mlir::DialectRegistry &registry) const override {
    registry.insert<ir::RtslDialect, mlir::arith::ArithDialect, mlir::math::MathDialect, mlir::vector::VectorDialect>();
  }
  void runOnOperation() override {
    std::vector<UnboundHit> unbound;
    boundHitError(getOperation(), strictUnit, unbound);
    for (const UnboundHit &hit : unbound)
      mlir::emitRemark(hit.place) << "no bound: " << hit.reason;
  }
};

} // namespace

void registerBoundHitErrorPass() { mlir::PassRegistration<BoundHitErrorPass>(); }

} // namespace rtsl
