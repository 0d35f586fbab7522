#include "codegen/passes/ShareCalls.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/MemoryAccesses.h"
#include "codegen/ir/Rays.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/Dominance.h"
#include "mlir/IR/SymbolTable.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "mlir/Pass/Pass.h"
#include "llvm/ADT/DenseSet.h"
#include "llvm/ADT/StringSet.h"

#include <map>

namespace rtsl::codegen {

namespace {

using mlir::Block;
using mlir::func::CallOp;
using mlir::func::FuncOp;
using Kind = ir::MemoryLocation::Kind;

/// What a function does, with its callees.
struct Effects {
  bool isPure = true; // but for what it reads here, and for writes through its arguments
  bool sendsRays = false;
  bool writesAny = false;          // more than `writes`
  bool writesArguments = false;    // through its own; those of its callees count as operands
  llvm::StringSet<> reads, writes; // state variables

  void add(const Effects &callee) {
    isPure &= callee.isPure;
    sendsRays |= callee.sendsRays;
    writesAny |= callee.writesAny;
    for (const auto &entry : callee.reads)
      reads.insert(entry.getKey());
    for (const auto &entry : callee.writes)
      writes.insert(entry.getKey());
  }
};

class EffectsOfFunctions {
public:
  explicit EffectsOfFunctions(mlir::ModuleOp module) : symbols(module) {}

  const Effects &of(FuncOp function) {
    const auto [entry, isNew] = known.try_emplace(function.getOperation());
    if (!isNew) // complete, or that of a function that calls itself
      return entry->second;
    entry->second = unknown();
    Effects effects;
    if (function.isExternal())
      return entry->second;
    function.walk([&](mlir::Operation *op) { add(effects, op); });
    return known[function] = std::move(effects);
  }

  FuncOp calleeOf(CallOp call) const { return symbols.lookup<FuncOp>(call.getCallee()); }
  const Effects &of(CallOp call) { return of(calleeOf(call)); }

private:
  static Effects unknown() {
    Effects effects;
    effects.isPure = false;
    effects.sendsRays = effects.writesAny = true;
    return effects;
  }

  void add(Effects &effects, mlir::Operation *op) {
    if (auto call = llvm::dyn_cast<CallOp>(op)) {
      effects.add(of(call));
      for (const mlir::Value operand : call.getOperands())
        if (llvm::isa<ir::PtrType>(operand.getType()))
          addWrite(effects, ir::locationOf(operand));
      return;
    }
    if (ir::sendsRays(op)) {
      effects.isPure = false;
      effects.sendsRays = true;
      for (const char *name : {"LightDirection", "LightDistance", "LightColor", "PDF"})
        effects.writes.insert(name); // by a light
      return;
    }
    if (llvm::isa<FuncOp, ir::VarOp>(op) || mlir::isMemoryEffectFree(op) ||
        op->hasTrait<mlir::OpTrait::IsTerminator>())
      return;
    if (!llvm::isa<ir::LoadOp, ir::StoreOp, ir::CopyOp, ir::ClearOp>(op)) {
      effects.isPure = false;
      effects.writesAny |= !llvm::isa<ir::RandOp, ir::BufferElementOp, ir::BufferLengthOp>(op);
      return;
    }
    auto load = llvm::dyn_cast<ir::LoadOp>(op);
    auto copy = llvm::dyn_cast<ir::CopyOp>(op);
    effects.isPure &= !(load && ir::isInOutputBuffer(load.getAddress())) &&
                      !(copy && ir::isInOutputBuffer(copy.getSource()));
    const ir::MemoryAccesses accesses = ir::accessesOf(op);
    for (const ir::MemoryLocation &location : accesses.reads)
      addRead(effects, location);
    for (const ir::MemoryLocation &location : accesses.writes)
      addWrite(effects, location);
  }

  static void addRead(Effects &effects, const ir::MemoryLocation &location) {
    if (location.kind == Kind::State)
      effects.reads.insert(location.name);
    effects.isPure &= location.kind == Kind::State || location.kind == Kind::Scene ||
                      location.kind == Kind::Variable;
  }
  /// Nothing is known of an argument; it counts where the function is called.
  static void addWrite(Effects &effects, const ir::MemoryLocation &location) {
    if (location.kind == Kind::State)
      effects.writes.insert(location.name);
    effects.writesAny |= location.kind == Kind::Scene;
    effects.writesArguments |= location.kind == Kind::Unknown;
    effects.isPure &= location.kind == Kind::Variable || location.kind == Kind::Unknown;
  }

  mlir::SymbolTable symbols;
  std::map<mlir::Operation *, Effects> known;
};

/// Calls of one function with the same arguments, of which the first is to remain.
struct Equal {
  llvm::SmallVector<CallOp, 4> calls;
  mlir::Operation *before; // where the one that remains stands
};

class SharedCalls {
public:
  SharedCalls(FuncOp function, EffectsOfFunctions &effects)
      : function(function), effects(effects), dominance(function) {}

  void run() {
    llvm::SmallVector<CallOp> calls;
    function.walk([&](CallOp call) { calls.push_back(call); });
    llvm::erase_if(calls, [&](CallOp call) { return eraseIfUnread(call); });
    std::vector<Equal> all;
    for (CallOp call : calls)
      if (mayBeShared(call) && !joins(call, all))
        all.push_back({{call}, call});
    for (Equal &equal : all)
      if (equal.calls.size() > 1)
        share(equal);
  }

private:
  /// Erases a call that only computes what is not read.
  bool eraseIfUnread(CallOp call) {
    if (!effects.of(call).isPure || !call->use_empty() ||
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

  /// Is the result the same wherever the caller calls it with these arguments?
  bool mayBeShared(CallOp call) {
    const Effects &callee = effects.of(call), &caller = effects.of(function);
    if (!callee.isPure || caller.writesAny ||
        (caller.writesArguments && !callee.reads.empty())) // which may be state of its caller's
      return false;
    for (const auto &entry : callee.reads)
      if (caller.writes.contains(entry.getKey()))
        return false;
    return llvm::all_of(call.getOperands(), [&](mlir::Value operand) {
      return !llvm::isa<ir::PtrType>(operand.getType()) || isResult(operand, call);
    });
  }

  /// Is it a variable that is zero before the call, that only the call writes, and that is read
  /// only after it?
  bool isResult(mlir::Value variable, CallOp call) {
    return llvm::isa_and_nonnull<ir::VarOp>(variable.getDefiningOp()) &&
           llvm::count(call.getOperands(), variable) == 1 && isClearedBetween(variable, call) &&
           llvm::all_of(variable.getUsers(), [&](mlir::Operation *user) {
             return user == call || isReadAfter(user, call) ||
                    (llvm::isa<ir::ClearOp>(user) && dominance.properlyDominates(user, call));
           });
  }
  /// Is the variable cleared on each path from the call to the call? At first it is zero.
  static bool isClearedBetween(mlir::Value variable, CallOp call) {
    llvm::SmallPtrSet<Block *, 16> seen; // and those that clear it
    for (mlir::Operation *user : variable.getUsers())
      if (llvm::isa<ir::ClearOp>(user))
        seen.insert(user->getBlock());
    Block *start = call->getBlock();
    if (seen.contains(start))
      return true;
    llvm::SmallVector<Block *> pending(start->getSuccessors());
    while (!pending.empty()) {
      Block *block = pending.pop_back_val();
      if (block == start)
        return false;
      if (seen.insert(block).second)
        pending.append(block->succ_begin(), block->succ_end());
    }
    return true;
  }
  bool isReadAfter(mlir::Operation *user, CallOp call) {
    if (llvm::isa<ir::LoadOp>(user))
      return dominance.properlyDominates(call, user);
    return llvm::isa<ir::FieldOp, ir::ElementOp>(user) &&
           llvm::all_of(user->getUsers(),
                        [&](mlir::Operation *inner) { return isReadAfter(inner, call); });
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
             return ofA == ofB || (llvm::isa<ir::PtrType>(ofA.getType()) && ofA != ofB);
           });
  }

  /// The operation before which one call can replace these; null: there is none.
  mlir::Operation *placeFor(llvm::ArrayRef<CallOp> calls) {
    Block *common = calls.front()->getBlock();
    for (CallOp call : calls.drop_front())
      common = dominance.findNearestCommonDominator(common, call->getBlock());
    mlir::Operation *place = common->getTerminator();
    for (CallOp call : calls)
      if (call->getBlock() == common && call->isBeforeInBlock(place))
        place = call;
    const bool isAtCall = llvm::is_contained(calls, place);
    if (!isAtCall && !(isAlwaysReached(calls, common) && canStand(calls.front(), place)))
      return nullptr;
    return llvm::any_of(calls, [&](CallOp call) { return sendsRaysBetween(place, call); }) ? nullptr
                                                                                           : place;
  }

  /// Are the arguments known there?
  bool canStand(CallOp call, mlir::Operation *place) {
    return llvm::all_of(call.getOperands(), [&](mlir::Value operand) {
      return llvm::isa<ir::PtrType>(operand.getType()) || dominance.dominates(operand, place);
    });
  }

  /// Does each path from the end of the block come to one of the calls?
  bool isAlwaysReached(llvm::ArrayRef<CallOp> calls, Block *from) {
    llvm::SmallPtrSet<Block *, 16> seen;
    llvm::SmallVector<Block *> pending(from->getSuccessors());
    while (!pending.empty()) {
      Block *block = pending.pop_back_val();
      if (!seen.insert(block).second ||
          llvm::any_of(calls, [&](CallOp call) { return call->getBlock() == block; }))
        continue;
      if (block == from || block->hasNoSuccessors())
        return false;
      pending.append(block->succ_begin(), block->succ_end());
    }
    return true;
  }

  /// Whether rays may be sent after `place`, and then the call comes, without `place` between.
  bool sendsRaysBetween(mlir::Operation *place, CallOp call) {
    Block *from = place->getBlock(), *to = call->getBlock();
    if (from == to)
      return sendsRaysIn(place, call);
    if (sendsRaysIn(place, nullptr) || sendsRaysIn(&to->front(), call))
      return true;
    // Every block on a path back from the call is dominated by `from`.
    llvm::SmallPtrSet<Block *, 16> seen = {from};
    llvm::SmallVector<Block *> pending(to->getPredecessors());
    while (!pending.empty()) {
      Block *block = pending.pop_back_val();
      if (!seen.insert(block).second)
        continue;
      if (sendsRaysIn(&block->front(), nullptr))
        return true;
      pending.append(block->pred_begin(), block->pred_end());
    }
    return false;
  }

  /// In a block, from one operation to another one or the end.
  bool sendsRaysIn(mlir::Operation *first, mlir::Operation *end) {
    for (mlir::Operation *op = first; op && op != end; op = op->getNextNode()) {
      auto call = llvm::dyn_cast<CallOp>(op);
      if (ir::sendsRays(op) || (call && effects.of(call).sendsRays))
        return true;
    }
    return false;
  }

  void share(const Equal &equal) {
    CallOp kept = equal.calls.front();
    for (unsigned index = 0; index < kept.getNumOperands(); ++index)
      if (auto variable = kept.getOperand(index).getDefiningOp<ir::VarOp>())
        shareVariable(variable, index, equal);
    if (equal.before != kept)
      kept->moveBefore(equal.before);
    for (CallOp call : llvm::drop_begin(equal.calls)) {
      call->replaceAllUsesWith(kept);
      call->erase();
    }
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

struct ShareCalls : mlir::PassWrapper<ShareCalls, mlir::OperationPass<mlir::ModuleOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(ShareCalls)
  llvm::StringRef getArgument() const override { return "rtsl-share-calls"; }
  llvm::StringRef getDescription() const override { return "shares equal calls"; }

  void runOnOperation() override {
    EffectsOfFunctions effects(getOperation());
    for (auto function : getOperation().getOps<FuncOp>())
      if (!function.isExternal() && !ir::attr::constructor.isOn(function))
        SharedCalls(function, effects).run();
  }
};

} // namespace

std::unique_ptr<mlir::Pass> createShareCallsPass() {
  return std::make_unique<ShareCalls>();
}

} // namespace rtsl::codegen
