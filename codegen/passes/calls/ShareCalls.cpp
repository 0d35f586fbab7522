#include "codegen/passes/calls/ShareCalls.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/passes/Components.h"
#include "codegen/passes/calls/FunctionEffects.h"
#include "codegen/passes/calls/LiftCalls.h"
#include "codegen/passes/calls/Operands.h"
#include "codegen/passes/calls/Parts.h"
#include "codegen/passes/calls/PassParts.h"
#include "codegen/passes/calls/Places.h"
#include "codegen/passes/calls/ResultVariables.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/Dominance.h"
#include "mlir/Pass/Pass.h"

#include <vector>

namespace rtsl::codegen {

namespace {

using mlir::Block;
using mlir::func::CallOp;
using mlir::func::FuncOp;

/// So many blocks above all calls are tried for the one that remains.
constexpr unsigned mostBlocksAbove = 8;

/// Calls of one function with the same arguments, of which one is to remain.
struct Equal {
  llvm::SmallVector<CallOp, 4> calls;
  mlir::Operation *before; // where the one that remains stands
};

class SharedCalls {
public:
  SharedCalls(FuncOp function, EffectsOfFunctions &effects)
      : function(function), effects(effects), dominance(function) {}

  /// Calls whose arguments are results of others may be equal after those are shared.
  void run() {
    while (runOnce()) {
    }
  }

private:
  bool runOnce() {
    llvm::SmallVector<CallOp> calls;
    function.walk([&](CallOp call) { calls.push_back(call); });
    llvm::erase_if(calls, [&](CallOp call) { return eraseIfUnread(call); });
    std::vector<Equal> all;
    for (CallOp call : calls)
      if (mayBeShared(call) && !joins(call, all))
        all.push_back({{call}, call});
    llvm::erase_if(all, [](const Equal &equal) { return equal.calls.size() == 1; });
    for (const Equal &equal : all)
      share(equal);
    return !all.empty();
  }

  /// Erases a call that only computes what is not read.
  bool eraseIfUnread(CallOp call) {
    if (!effects.of(call).onlyReads() || !call->use_empty() ||
        !llvm::all_of(call.getOperands(), [&](mlir::Value operand) {
          return !llvm::isa<ir::PtrType>(operand.getType()) || isUnread(operand, call);
        }))
      return false;
    call.erase();
    return true;
  }
  /// Is it in a variable that only the call may read?
  static bool isUnread(mlir::Value address, CallOp call) {
    auto variable = llvm::dyn_cast_or_null<ir::VarOp>(ir::baseOperation(address));
    return variable && isOnlyWritten(variable, call);
  }
  static bool isOnlyWritten(mlir::Value address, CallOp call) {
    return llvm::all_of(address.getUsers(), [&](mlir::Operation *user) {
      return user == call || llvm::isa<ir::ClearOp, ir::StoreOp>(user) ||
             (llvm::isa<ir::FieldOp, ir::ElementOp>(user) &&
              isOnlyWritten(user->getResult(0), call));
    });
  }

  bool mayBeShared(CallOp call) {
    return isSameWhereverCalled(call, function, effects) &&
           llvm::all_of(call.getOperands(), [&](mlir::Value operand) {
             return !llvm::isa<ir::PtrType>(operand.getType()) ||
                    isResult(operand, call, dominance);
           });
  }

  /// Adds the call to equal ones, if one of them can remain in place of all.
  bool joins(CallOp call, std::vector<Equal> &all) {
    return llvm::any_of(all, [&](Equal &equal) {
      if (!isEqual(call, equal.calls.front()))
        return false;
      llvm::SmallVector<CallOp, 4> calls = equal.calls;
      calls.push_back(call);
      mlir::Operation *place = placeFor(calls);
      if (!place)
        return false;
      equal = {std::move(calls), place};
      return true;
    });
  }

  static bool isEqual(CallOp a, CallOp b) {
    return a.getCallee() == b.getCallee() &&
           llvm::all_of(llvm::zip(a.getOperands(), b.getOperands()), [](const auto &both) {
             const auto [ofA, ofB] = both;
             return llvm::isa<ir::PtrType>(ofA.getType()) ? ofA != ofB : isSame(ofA, ofB);
           });
  }

  /// The operation before which one call can replace these; null: there is none. In front of a loop
  /// that has some of them, if it is followed by others.
  mlir::Operation *placeFor(llvm::ArrayRef<CallOp> calls) {
    Block *common = calls.front()->getBlock();
    for (CallOp call : calls.drop_front())
      common = dominance.findNearestCommonDominator(common, call->getBlock());
    CallOp first;
    for (CallOp call : calls)
      if (call->getBlock() == common && (!first || call->isBeforeInBlock(first)))
        first = call;
    if (first)
      return sendsRaysBetween(first, calls) ? nullptr : first.getOperation();
    for (unsigned above = 0; above < mostBlocksAbove; ++above) {
      mlir::Operation *place = common->getTerminator();
      if (sendsRaysBetween(place, calls))
        return nullptr;
      if (isAlwaysReached(calls, common) && canStand(calls.front(), place))
        return place;
      const auto *node = dominance.getNode(common);
      if (!node || !node->getIDom())
        return nullptr;
      common = node->getIDom()->getBlock();
    }
    return nullptr;
  }
  bool sendsRaysBetween(mlir::Operation *place, llvm::ArrayRef<CallOp> calls) {
    return llvm::any_of(
        calls, [&](CallOp call) { return codegen::sendsRaysBetween(place, call, effects); });
  }

  /// Are the arguments known there?
  bool canStand(CallOp call, mlir::Operation *place) {
    return llvm::all_of(call.getOperands(), [&](mlir::Value operand) {
      return llvm::isa<ir::PtrType>(operand.getType()) ||
             canCompute(operand,
                        [&](mlir::Value value) { return dominance.dominates(value, place); });
    });
  }

  void moveTo(mlir::Operation *place, CallOp call) {
    mlir::OpBuilder builder(place);
    for (mlir::OpOperand &operand : call->getOpOperands())
      if (!llvm::isa<ir::PtrType>(operand.get().getType()))
        operand.set(compute(builder, operand.get(), [&](mlir::Value value) {
          return dominance.dominates(value, place) ? value : mlir::Value();
        }));
    call->moveBefore(place);
  }

  void share(const Equal &equal) {
    auto atPlace = llvm::find(equal.calls, equal.before);
    CallOp kept = atPlace != equal.calls.end() ? *atPlace : equal.calls.front();
    for (unsigned index = 0; index < kept.getNumOperands(); ++index)
      if (auto variable = kept.getOperand(index).getDefiningOp<ir::VarOp>())
        shareVariable(variable, index, equal);
    if (equal.before != kept)
      moveTo(equal.before, kept);
    for (CallOp call : equal.calls)
      if (call != kept) {
        call->replaceAllUsesWith(kept);
        call->erase();
      }
    for (const mlir::Value operand : kept.getOperands())
      if (llvm::isa<ir::PtrType>(operand.getType()))
        loadOnce(operand, kept);
  }

  /// Each part of the result is loaded once, after the call.
  static void loadOnce(mlir::Value variable, CallOp call) {
    const auto parts = partsOfResult(variable, call);
    if (!parts)
      return;
    mlir::OpBuilder builder(call);
    builder.setInsertionPointAfter(call);
    for (const Part &part : *parts)
      replaceLoads(part, loadPart(builder, call.getLoc(), variable, part));
  }

  /// Puts one variable in place of those that the calls have as this operand: it lives from the
  /// entry on, and if one of them was cleared, it is cleared where the call writes it.
  void shareVariable(ir::VarOp variable, unsigned index, const Equal &equal) {
    bool isCleared = false;
    for (CallOp call : equal.calls) {
      mlir::Value ofCall = call.getOperand(index);
      isCleared |= eraseClears(ofCall);
      if (ofCall != variable.getResult())
        ofCall.replaceAllUsesExcept(variable.getResult(), call);
    }
    variable->moveBefore(&function.getBody().front(), function.getBody().front().begin());
    if (isCleared) {
      mlir::OpBuilder builder(equal.before);
      ir::ClearOp::create(builder, variable.getLoc(), variable.getResult());
    }
  }
  static bool eraseClears(mlir::Value variable) {
    bool any = false;
    for (mlir::Operation *user : llvm::make_early_inc_range(variable.getUsers()))
      if (llvm::isa<ir::ClearOp>(user)) {
        user->erase();
        any = true;
      }
    return any;
  }

  FuncOp function;
  EffectsOfFunctions &effects;
  mlir::DominanceInfo dominance;
};

/// Shares the calls of functions after those of functions that they call.
void shareInOrder(mlir::ModuleOp module, EffectsOfFunctions &effects) {
  llvm::DenseMap<mlir::Operation *, llvm::SmallVector<CallOp>> callers;
  module.walk([&](CallOp call) { callers[effects.calleeOf(call)].push_back(call); });
  Components<mlir::Operation *>::Part functions;
  for (auto function : module.getOps<FuncOp>())
    if (!function.isExternal())
      functions.insert(function);
  const auto forEachCallee = [&](mlir::Operation *function,
                                 llvm::function_ref<void(mlir::Operation *)> visit) {
    function->walk([&](CallOp call) { visit(effects.calleeOf(call)); });
  };

  for (const auto &component : Components<mlir::Operation *>::of(functions, forEachCallee))
    for (mlir::Operation *op : component) {
      auto function = llvm::cast<FuncOp>(op);
      const llvm::SmallVector<CallOp> &calls = callers[function];
      // Those of a function that calls itself change when its own calls, or theirs, are shared.
      const bool areKnown =
          component.size() == 1 && function.isPrivate() && llvm::none_of(calls, [&](CallOp call) {
            auto caller = call->getParentOfType<FuncOp>();
            return caller == function || ir::attr::constructor.isOn(caller);
          });
      if (!ir::attr::constructor.isOn(function))
        SharedCalls(function, effects).run();
      if (!areKnown)
        continue;
      passParts(function, calls, effects.of(function));
      if (calls.size() > 1 && !effects.of(function).traces)
        liftCalls(function, calls, effects);
    }
}

struct ShareCalls : mlir::PassWrapper<ShareCalls, mlir::OperationPass<mlir::ModuleOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(ShareCalls)
  llvm::StringRef getArgument() const override { return "rtsl-share-calls"; }
  llvm::StringRef getDescription() const override { return "shares equal calls"; }

  void runOnOperation() override {
    EffectsOfFunctions effects(getOperation());
    shareInOrder(getOperation(), effects);
  }
};

} // namespace

std::unique_ptr<mlir::Pass> createShareCallsPass() {
  return std::make_unique<ShareCalls>();
}

} // namespace rtsl::codegen
