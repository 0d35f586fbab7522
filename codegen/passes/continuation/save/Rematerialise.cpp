//===- Rematerialise.cpp - recompute instead of saving --------------------===//
//
// A value that is needed after a trace is saved before it and restored after it, or recomputed
// there from other values, which are saved or recomputed in turn:
//
//     %eta = rtsl.load %member                   %eta = rtsl.load %member
//     %w = arith.mulf %x, %eta                   %w = arith.mulf %x, %eta
//     rtsl.suspend ..., ^resume          ==>     rtsl.suspend ..., ^resume   // only %x is live
//   ^resume:                                   ^resume:
//     use %w                                     %eta' = rtsl.load %member
//                                                %w' = arith.mulf %x, %eta'
//                                                use %w'
//
// The choice is a minimum cut at each trace (MinimumCut.h) with the costs of CostTable.h. Restored
// or recomputed, a value has the same bits, so one trace may save a value that another recomputes.
// A value that a trace saves must be available when it suspends, so it is needed after earlier
// traces; therefore plans and liveness are computed alternately until neither changes. Arguments of
// blocks are never recomputed.
//
// The cheapest choice for each trace is not the cheapest for all of them together: a value that is
// cheap to save at one trace may have to be saved at earlier traces only for that. So afterwards
// each saving at one trace is forbidden in turn, and remains so if all plans together are cheaper
// without it.
//
// In strict SSA an operand of a value cannot be redefined while the value is live (its definition
// dominates that of the value, which dominates all uses), so a value recomputed from the operands
// after the trace is the same, in loops too.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Layout.h"
#include "codegen/passes/continuation/common/CostTable.h"
#include "codegen/passes/continuation/common/Liveness.h"
#include "codegen/passes/continuation/common/Names.h"
#include "codegen/passes/continuation/common/Recompute.h"
#include "codegen/passes/continuation/common/SsaRepair.h"
#include "codegen/passes/continuation/save/MinimumCut.h"
#include "codegen/passes/continuation/save/Steps.h"

#include "mlir/Analysis/CFGLoopInfo.h"
#include "mlir/IR/Dominance.h"
#include "mlir/IR/IRMapping.h"

#include <optional>
#include <vector>

namespace rtsl::continuation {

using llvm::BitVector;
using mlir::Value;

namespace {

class Planner {
public:
  Planner(FuncOp function, const RematerialiseOptions &options, const WriteSummary &summary)
      : function(function), options(options), liveness(function), recompute(function, summary),
        dominance(function), loops(dominance.getDomTree(&function.getBody())),
        object(objectOf(function)), operandNumbers(liveness.values().size()),
        costs(liveness.values().size(), -1) {}

  mlir::FailureOr<llvm::SmallVector<SuspendPlan>> run();

private:
  struct Decision {
    BitVector needed, saved, recomputed;
  };
  /// One for each trace.
  using Decisions = llvm::SmallVector<Decision>;
  mlir::LogicalResult decideAll(Decisions &decisions);
  mlir::LogicalResult decide(std::size_t trace, Decision &decision);
  mlir::LogicalResult complain(ir::SuspendOp suspend, llvm::ArrayRef<unsigned> values,
                               llvm::ArrayRef<ValueNode> nodes);
  void improveTogether(Decisions &decisions);
  std::int64_t costOf(const Decisions &decisions);
  llvm::ArrayRef<unsigned> operandsOf(unsigned value);
  std::int64_t costOfSaving(unsigned number, std::size_t trace);
  std::int64_t costOfRecomputing(unsigned number, std::size_t trace);
  std::int64_t frequency(mlir::Block *block) { return loopFrequency(loops.getLoopDepth(block)); }
  void dropUnneeded(Decision &decision, const BitVector &needed);

  FuncOp function;
  RematerialiseOptions options;
  Liveness liveness;
  Recompute recompute;
  mlir::DominanceInfo dominance;
  mlir::CFGLoopInfo loops;
  Value object; // a parameter of every state
  llvm::SmallVector<ir::SuspendOp> suspends = suspendsOf(function);
  // values that may not be saved at each trace, regardless of cost; empty: none
  llvm::SmallVector<BitVector> forbidden;
  std::vector<std::optional<llvm::SmallVector<unsigned, 4>>> operandNumbers; // computed on demand
  std::vector<std::int64_t> costs; // of executing the defining operation once; -1: not computed yet
};

llvm::ArrayRef<unsigned> Planner::operandsOf(unsigned value) {
  std::optional<llvm::SmallVector<unsigned, 4>> &operands = operandNumbers[value];
  if (!operands) {
    operands.emplace();
    for (Value operand : liveness.values()[value].getDefiningOp()->getOperands())
      if (operand != object)
        operands->push_back(liveness.numberOf(operand));
    llvm::sort(*operands);
    operands->erase(llvm::unique(*operands), operands->end());
  }
  return *operands;
}

/// Addresses, and `index` values made of an i32, cannot be saved in a frame.
std::int64_t Planner::costOfSaving(unsigned number, std::size_t trace) {
  Value value = liveness.values()[number];
  if (!ir::isValueType(value.getType()) || (!forbidden.empty() && forbidden[trace].test(number)))
    return impossible;
  return saveCost(value.getType(), frequency(value.getParentBlock()),
                  frequency(suspends[trace]->getBlock()));
}

/// `impossible` unless it is cheaper than saving: then the operands need not be considered.
std::int64_t Planner::costOfRecomputing(unsigned number, std::size_t trace) {
  Value value = liveness.values()[number];
  if (options.onlyAddresses && ir::isValueType(value.getType()))
    return impossible;
  mlir::Operation *op = value.getDefiningOp();
  if (!op)
    return impossible;
  if (costs[number] < 0)
    costs[number] = recomputeCost(op);
  const std::int64_t cost = costs[number] * frequency(suspends[trace]->getBlock());
  if (cost >= costOfSaving(number, trace) || !recompute.isPossible(op, suspends[trace]))
    return impossible;
  return cost;
}

/// The cheapest way to make `decision.needed` available after the suspend.
mlir::LogicalResult Planner::decide(std::size_t trace, Decision &decision) {
  // All values from which a needed one can be recomputed.
  llvm::DenseMap<unsigned, std::int64_t> recomputing;
  BitVector reached = decision.needed;
  llvm::SmallVector<unsigned> worklist(reached.set_bits_begin(), reached.set_bits_end());
  while (!worklist.empty()) {
    unsigned value = worklist.pop_back_val();
    const std::int64_t cost = costOfRecomputing(value, trace);
    if (cost == impossible)
      continue;
    recomputing[value] = cost;
    for (unsigned operand : operandsOf(value))
      if (!reached.test(operand)) {
        reached.set(operand);
        worklist.push_back(operand);
      }
  }

  // Nodes in program order: operands come first.
  llvm::SmallVector<unsigned> values(reached.set_bits_begin(), reached.set_bits_end());
  llvm::DenseMap<unsigned, unsigned> nodeOf;
  std::vector<ValueNode> nodes(values.size());
  for (auto [index, number] : llvm::enumerate(values)) {
    ValueNode &node = nodes[index];
    nodeOf[number] = index;
    node.needed = decision.needed.test(number);
    node.saveCost = costOfSaving(number, trace);
    auto cost = recomputing.find(number);
    if (cost == recomputing.end())
      continue;
    node.recomputeCost = cost->second;
    for (unsigned operand : operandsOf(number))
      node.operands.push_back(nodeOf.lookup(operand));
  }

  Choice choice = chooseSaved(nodes);
  decision.saved = decision.recomputed = liveness.none();
  if (!choice.feasible)
    return forbidden.empty() ? complain(suspends[trace], values, nodes) : mlir::failure();
  for (auto [index, number] : llvm::enumerate(values)) {
    if (choice.saved[index])
      decision.saved.set(number);
    if (choice.recomputed[index])
      decision.recomputed.set(number);
  }
  return mlir::success();
}

mlir::LogicalResult Planner::complain(ir::SuspendOp suspend, llvm::ArrayRef<unsigned> values,
                                      llvm::ArrayRef<ValueNode> nodes) {
  for (auto [number, node] : llvm::zip(values, nodes))
    if (node.saveCost == impossible && node.recomputeCost == impossible)
      return mlir::emitError(suspend.getLoc())
             << "the address `" << sourceName(liveness.values()[number])
             << "` is used after a trace and cannot be recomputed there";
  return mlir::emitError(suspend.getLoc()) << "an address cannot be kept across a trace";
}

/// Keeps the part of a decision that is needed in the end, directly or to recompute other values.
void Planner::dropUnneeded(Decision &decision, const BitVector &needed) {
  BitVector kept = needed;
  llvm::SmallVector<unsigned> worklist(needed.set_bits_begin(), needed.set_bits_end());
  while (!worklist.empty()) {
    unsigned value = worklist.pop_back_val();
    if (!decision.recomputed.test(value))
      continue;
    for (unsigned operand : operandsOf(value))
      if (!kept.test(operand)) {
        kept.set(operand);
        worklist.push_back(operand);
      }
  }
  decision.needed = needed;
  decision.saved &= kept;
  decision.recomputed &= kept;
}

mlir::LogicalResult Planner::decideAll(Decisions &decisions) {
  decisions.resize(suspends.size());
  for (Decision &decision : decisions)
    decision.needed = decision.saved = decision.recomputed = liveness.none();

  auto computeLiveness = [&] {
    Liveness::HandedOn handedOn;
    for (auto [suspend, decision] : llvm::zip(suspends, decisions))
      handedOn[suspend] = decision.saved;
    liveness.compute(&handedOn);
  };
  // The sets of needed values only grow here, so this terminates. Later traces first: a value that
  // they save is needed after earlier ones.
  bool changed = true, isStale = true;
  while (changed) {
    changed = false;
    for (size_t i = suspends.size(); i-- > 0;) {
      if (isStale)
        computeLiveness();
      isStale = false;
      BitVector needed = liveness.into(suspends[i].getResume());
      needed |= decisions[i].needed;
      if (needed == decisions[i].needed)
        continue;
      changed = true;
      decisions[i].needed = needed;
      BitVector lost = decisions[i].saved;
      if (mlir::failed(decide(i, decisions[i])))
        return mlir::failure();
      lost.reset(decisions[i].saved);
      isStale = lost.any();
      if (!isStale)
        liveness.extend(suspends[i], decisions[i].saved);
    }
  }
  // Here they only shrink: intermediate plans may have needed values that the final ones do not.
  changed = true;
  while (changed) {
    changed = false;
    computeLiveness();
    for (auto [suspend, decision] : llvm::zip(suspends, decisions)) {
      BitVector saved = decision.saved;
      dropUnneeded(decision, liveness.into(suspend.getResume()));
      changed |= saved != decision.saved;
    }
  }
  return mlir::success();
}

std::int64_t Planner::costOf(const Decisions &decisions) {
  std::int64_t cost = 0;
  for (auto [trace, decision] : llvm::enumerate(decisions)) {
    for (unsigned number : decision.saved.set_bits())
      cost += costOfSaving(number, trace);
    for (unsigned number : decision.recomputed.set_bits())
      cost += costs[number] * frequency(suspends[trace]->getBlock());
  }
  return cost;
}

/// Limit of the search for plans that are cheaper together: values times traces for each attempt.
static constexpr std::size_t mostTried = 20000;

void Planner::improveTogether(Decisions &decisions) {
  std::size_t triesLeft = mostTried / (liveness.values().size() * suspends.size());
  std::int64_t best = costOf(decisions);
  forbidden.assign(suspends.size(), liveness.none());
  const auto isNeededElsewhere = [&](unsigned number, std::size_t trace) {
    for (auto [other, decision] : llvm::enumerate(decisions))
      if (other != trace && decision.needed.test(number))
        return true;
    return false;
  };
  bool improved = true;
  while (improved) { // forbidding one saving may make another attempt succeed
    improved = false;
    for (std::size_t trace = suspends.size(); trace-- > 0;) {
      const BitVector candidates = decisions[trace].saved;
      for (unsigned number : candidates.set_bits()) {
        if (!decisions[trace].saved.test(number) || !isNeededElsewhere(number, trace))
          continue;
        // The values that are then saved instead are forbidden in turn.
        const BitVector before = forbidden[trace];
        BitVector next = liveness.none();
        next.set(number);
        bool isBetter = false;
        while (!isBetter && next.any()) {
          if (triesLeft-- == 0) {
            forbidden[trace] = before;
            return;
          }
          forbidden[trace] |= next;
          Decisions without;
          if (mlir::failed(decideAll(without)))
            break;
          next = without[trace].saved;
          next.reset(decisions[trace].saved);
          if (const std::int64_t cost = costOf(without); cost < best) {
            isBetter = improved = true;
            best = cost;
            decisions = std::move(without);
          }
        }
        if (!isBetter)
          forbidden[trace] = before;
      }
    }
  }
}

mlir::FailureOr<llvm::SmallVector<SuspendPlan>> Planner::run() {
  Decisions decisions;
  if (mlir::failed(decideAll(decisions)))
    return mlir::failure();
  if (suspends.size() > 1 && !options.onlyAddresses)
    improveTogether(decisions);

  llvm::SmallVector<SuspendPlan> plans;
  for (auto [suspend, decision] : llvm::zip(suspends, decisions))
    plans.push_back(
        {suspend, liveness.valuesOf(decision.saved), liveness.valuesOf(decision.recomputed)});
  return plans;
}

} // namespace

mlir::FailureOr<llvm::SmallVector<SuspendPlan>>
planContinuations(FuncOp function, const RematerialiseOptions &options,
                  const WriteSummary &summary) {
  if (suspendsOf(function).empty())
    return llvm::SmallVector<SuspendPlan>();
  return Planner(function, options, summary).run();
}

mlir::FailureOr<llvm::SmallVector<SuspendPlan>>
planContinuations(FuncOp function, const RematerialiseOptions &options) {
  return planContinuations(function, options,
                           WriteSummary(function->getParentOfType<mlir::ModuleOp>()));
}

void rematerialise(FuncOp function, llvm::ArrayRef<SuspendPlan> plans) {
  llvm::MapVector<Value, Redefinitions> redefinitions;
  for (const SuspendPlan &plan : plans) {
    mlir::Block *resume = ir::SuspendOp(plan.suspend).getResume();
    mlir::OpBuilder builder(function.getContext());
    builder.setInsertionPointAfter(&resume->front());
    mlir::IRMapping mapping;
    llvm::DenseMap<mlir::Operation *, mlir::Operation *> clones;
    for (Value value : plan.recomputed) {
      mlir::Operation *&clone = clones[value.getDefiningOp()];
      if (!clone)
        clone = builder.clone(*value.getDefiningOp(), mapping);
      Value again = clone->getResult(llvm::cast<mlir::OpResult>(value).getResultNumber());
      redefinitions[value][resume] = again;
    }
  }
  const BlockOrder order(function.getBody());
  for (auto &[value, ofValue] : redefinitions)
    repairSsa(value, ofValue, order);
}

} // namespace rtsl::continuation
