#include "codegen/passes/errors/BoundHitError.h"

#include "codegen/formulas/Emitter.h"
#include "codegen/formulas/Library.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/passes/errors/HitBranches.h"
#include "runtime/device/ray/HitError.h"

#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/Pass/Pass.h"

#include <limits>

namespace rtsl {

using namespace lowering;
namespace arith = mlir::arith;

/// Erases what `intersect` does beside computing t.
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

/// Makes `intersect` see no earlier hit.
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

/// Makes comparisons of floats use unrounded values, so that the branches are the correct ones, not
/// those that `intersect` has taken because of rounding. Where errors of elementary functions leave
/// the result of a comparison uncertain, `otherwise` decides whether it is inverted. Returns
/// whether there is such a comparison.
static bool compareUnrounded(llvm::ArrayRef<arith::CmpFOp> comparisons, RunningError &errors,
                             Value otherwise) {
  bool mayBeInDoubt = false;
  for (arith::CmpFOp comparison : comparisons) {
    const std::optional<Unrounded> left = errors.of(comparison.getLhs()),
                                   right = errors.of(comparison.getRhs());
    if (!left || !right)
      continue;
    Emitter emitter(comparison.getContext());
    emitter.setLoc(comparison.getLoc());
    emitter.setInsertionPointAfter(comparison);
    const Wide a(emitter, left->value), b(emitter, right->value);
    Num answer(emitter, emitter.fold<arith::CmpFOp>(comparison.getPredicate(), a, b));
    if (left->error || right->error) {
      const auto errorOf = [&](const Unrounded &one) {
        return one.error ? Wide(emitter, one.error) : a.like(0);
      };
      const Num isInDoubt(emitter, isAtMost(abs(a - b), errorOf(*left) + errorOf(*right)));
      answer = answer ^ (isInDoubt & Num(emitter, emitter.load(otherwise)));
      mayBeInDoubt = true;
    }
    comparison.replaceAllUsesWith(Value(answer));
  }
  return mayBeInDoubt;
}

/// Runs the code from `start` on once more, with `otherwise`, unless it has found the hit. `bound`
/// is the result.
static void tryOtherwise(mlir::Block *start, Value bound, Value otherwise) {
  mlir::Region &body = *start->getParent();
  llvm::SmallVector<mlir::Operation *> returns;
  for (mlir::Block &block : body)
    if (auto end = llvm::dyn_cast<mlir::func::ReturnOp>(block.getTerminator()))
      returns.push_back(end);
  mlir::Block *finish = new mlir::Block, *again = new mlir::Block, *done = new mlir::Block;
  for (mlir::Block *block : {finish, again, done})
    body.push_back(block);

  Emitter emitter(start->getParentOp()->getContext());
  emitter.setLoc(start->getParentOp()->getLoc());
  for (mlir::Operation *end : returns) {
    emitter.setInsertionPoint(end);
    emitter.make<mlir::cf::BranchOp>(finish);
    end->erase();
  }
  emitter.setInsertionPointToStart(finish);
  const Num isFound =
      !equal({emitter, emitter.load(bound)}, {emitter, emitter.floatConstant(device::hitNotFound)});
  emitter.make<mlir::cf::CondBranchOp>(isFound | Num(emitter, emitter.load(otherwise)), done,
                                       again);
  emitter.setInsertionPointToStart(again);
  emitter.store(emitter.boolConstant(true), otherwise);
  emitter.make<mlir::cf::BranchOp>(start);
  emitter.setInsertionPointToStart(done);
  emitter.make<mlir::func::ReturnOp>();
}

bool boundHitError(mlir::func::FuncOp intersect, ElementaryErrors elementary,
                   std::vector<UnboundHit> &unbound) {
  takeBranchesToHits(intersect);
  llvm::SmallVector<ir::HitOp> hits;
  intersect.walk([&](ir::HitOp hit) { hits.push_back(hit); });
  llvm::SmallVector<arith::CmpFOp> comparisons;
  intersect.walk([&](arith::CmpFOp comparison) { comparisons.push_back(comparison); });
  dropEffects(intersect);
  forgetOtherHits(intersect);

  RunningError errors(intersect, elementary);
  Emitter emitter(intersect.getContext());
  emitter.setLoc(intersect.getLoc());
  emitter.setInsertionPointToStart(&intersect.getBody().front());
  const Num distance = stateOf(emitter, "HitDistance");
  const Value bound = emitter.variable("bound", emitter.getF32Type());
  const Value atFirst = emitter.floatConstant(device::errorNotStated);
  emitter.store(atFirst, bound);
  const Wide found = widened(emitter, distance);
  const Value nearest = emitter.variable("nearest", emitter.getF32Type());
  emitter.store(emitter.floatConstant(std::numeric_limits<float>::infinity()), nearest);
  const Value otherwise = emitter.variable("otherwise", emitter.getI1Type());
  emitter.store(emitter.boolConstant(false), otherwise);
  mlir::Block *start = intersect.getBody().front().splitBlock(emitter.getInsertionPoint());
  emitter.setInsertionPointToEnd(&intersect.getBody().front());
  emitter.make<mlir::cf::BranchOp>(start);
  bool hasBound = false, allHaveBounds = true;
  for (ir::HitOp hit : hits) {
    const std::optional<Unrounded> exact = hit.getError() ? std::nullopt : errors.of(hit.getT());
    if (!exact && !hit.getError())
      unbound.push_back({hit.getLoc(), errors.whyUnknown().reason});
    emitter.setLoc(hit.getLoc());
    emitter.setInsertionPoint(hit);
    const Num t(emitter, hit.getT());
    if (exact) {
      // The hit nearest to T.
      const Num before(emitter, emitter.load(bound)), least(emitter, emitter.load(nearest));
      const Wide difference = abs(found - Wide(emitter, exact->value));
      const Wide error = exact->error ? difference + Wide(emitter, exact->error) : difference;
      const Num away(emitter, narrowed(difference)),
          isThis = less(away, least) & lessEqual(away, abs(distance) * 0x1p-6);
      emitter.store(select(isThis, {emitter, narrowed(error)}, before), bound);
      emitter.store(select(isThis, away, least), nearest);
      hasBound = true;
    } else {
      allHaveBounds = false;
    }
    // A nearer hit is known to have been rejected; a further one would have been accepted.
    hit.replaceAllUsesWith(Value(less(distance, t)));
    hit.erase();
  }
  if (hasBound && compareUnrounded(comparisons, errors, otherwise))
    tryOtherwise(start, bound, otherwise);
  if (allHaveBounds) // if no hit is within its bound, this one was there only because of rounding
    llvm::cast<arith::ConstantOp>(atFirst.getDefiningOp())
        .setValueAttr(emitter.getF32FloatAttr(device::hitNotFound));
  for (mlir::Block &block : intersect.getBody())
    if (llvm::isa<mlir::func::ReturnOp>(block.getTerminator())) {
      emitter.setInsertionPoint(block.getTerminator());
      emitter.store(emitter.load(bound),
                    emitter.make<ir::StateOp>("hitError", emitter.getF32Type()));
    }
  bool draws = false;
  intersect.walk([&](ir::RandOp) { draws = true; });
  return hasBound && !draws;
}

namespace {

struct BoundHitErrorPass
    : mlir::PassWrapper<BoundHitErrorPass, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(BoundHitErrorPass)
  llvm::StringRef getArgument() const override { return "rtsl-bound-hit-error"; }
  llvm::StringRef getDescription() const override {
    return "turns `intersect` into a function that bounds the error of its t";
  }
  void getDependentDialects(mlir::DialectRegistry &registry) const override {
    registry.insert<ir::RtslDialect, mlir::arith::ArithDialect, mlir::math::MathDialect,
                    mlir::vector::VectorDialect>();
  }
  void runOnOperation() override {
    std::vector<UnboundHit> unbound;
    boundHitError(getOperation(), strictErrors, unbound);
    for (const UnboundHit &hit : unbound)
      mlir::emitRemark(hit.place) << "no bound: " << hit.reason;
  }
};

} // namespace

void registerBoundHitErrorPass() {
  mlir::PassRegistration<BoundHitErrorPass>();
}

} // namespace rtsl
