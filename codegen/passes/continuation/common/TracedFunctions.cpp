//===- TracedFunctions.cpp - the functions of a module that trace ---------===//
#include "codegen/passes/continuation/common/TracedFunctions.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Slots.h"

#include "llvm/ADT/DenseMap.h"

#include <algorithm>
#include <vector>

namespace rtsl::continuation {

llvm::SmallVector<ir::SuspendOp> suspendsOf(FuncOp function) {
  llvm::SmallVector<ir::SuspendOp> suspends;
  for (mlir::Block &block : function.getBody())
    if (!block.empty())
      if (auto suspend = llvm::dyn_cast<ir::SuspendOp>(block.back()))
        suspends.push_back(suspend);
  return suspends;
}

mlir::Value objectOf(FuncOp function) {
  if (function.isExternal() || function.getNumArguments() == 0)
    return {};
  mlir::Value first = function.getArgument(0);
  return llvm::isa<ir::RefType>(first.getType()) ? first : mlir::Value();
}

bool isFramed(mlir::Operation *op) {
  return ir::attr::framed.isOn(op);
}

llvm::ArrayRef<llvm::StringLiteral> machineSlots() {
  static constexpr llvm::StringLiteral slots[] = {ir::slot::shade, ir::slot::miss,
                                                  ir::slot::closestHitForPayload,
                                                  ir::slot::missForPayload, ir::slot::generate};
  return slots;
}

namespace {

/// The call graph of a module.
struct Calls {
  explicit Calls(mlir::ModuleOp module);

  struct Function {
    FuncOp op;
    bool traces = false; // itself
    llvm::SmallVector<unsigned> callees, callers;
  };
  std::vector<Function> functions; // in the order of the module
  /// For each function: does it trace, or call one that does?
  std::vector<bool> tracing() const;
  /// For each function: is it in a cycle?
  std::vector<bool> inCycles() const;
};

Calls::Calls(mlir::ModuleOp module) {
  llvm::DenseMap<mlir::StringAttr, unsigned> numbers;
  for (FuncOp function : module.getOps<FuncOp>()) {
    numbers[function.getSymNameAttr()] = functions.size();
    functions.push_back({function, false, {}, {}});
  }
  for (auto [number, function] : llvm::enumerate(functions))
    function.op.walk([&, number = number, &function = function](mlir::Operation *op) {
      function.traces |=
          ir::isTrace(op) || llvm::isa<ir::SuspendOp, ir::SpawnOp, ir::SpawnPayloadOp>(op);
      if (auto call = llvm::dyn_cast<mlir::func::CallOp>(op)) {
        function.traces |= isFramed(call);
        if (auto callee = numbers.find(call.getCalleeAttr().getAttr()); callee != numbers.end()) {
          function.callees.push_back(callee->second);
          functions[callee->second].callers.push_back(number);
        }
      }
    });
}

std::vector<bool> Calls::tracing() const {
  std::vector<bool> found(functions.size());
  llvm::SmallVector<unsigned> pending;
  const auto add = [&](unsigned number) {
    if (!found[number])
      pending.push_back(number);
    found[number] = true;
  };
  for (unsigned number = 0; number != functions.size(); ++number)
    if (functions[number].traces)
      add(number);
  while (!pending.empty())
    for (unsigned caller : functions[pending.pop_back_val()].callers)
      add(caller);
  return found;
}

/// Strongly connected components (Tarjan, "Depth-first search and linear graph algorithms", 1972),
/// without recursion.
std::vector<bool> Calls::inCycles() const {
  constexpr unsigned none = ~0u;
  std::vector<bool> found(functions.size()), isOpen(functions.size());
  std::vector<unsigned> index(functions.size(), none), low(functions.size()),
      next(functions.size());
  llvm::SmallVector<unsigned> path, open;
  unsigned count = 0;
  for (unsigned start = 0; start != functions.size(); ++start) {
    if (index[start] != none)
      continue;
    path.push_back(start);
    while (!path.empty()) {
      const unsigned at = path.back();
      if (index[at] == none) {
        index[at] = low[at] = count++;
        open.push_back(at);
        isOpen[at] = true;
      }
      if (next[at] != functions[at].callees.size()) {
        const unsigned callee = functions[at].callees[next[at]++];
        if (index[callee] == none)
          path.push_back(callee);
        else if (isOpen[callee])
          low[at] = std::min(low[at], index[callee]);
        found[at] = found[at] || callee == at;
        continue;
      }
      path.pop_back();
      if (!path.empty())
        low[path.back()] = std::min(low[path.back()], low[at]);
      if (low[at] != index[at])
        continue;
      const bool isAlone = open.back() == at;
      unsigned member;
      do {
        member = open.pop_back_val();
        isOpen[member] = false;
        found[member] = found[member] || !isAlone;
      } while (member != at);
    }
  }
  return found;
}

} // namespace

llvm::SmallVector<FuncOp> tracingFunctions(mlir::ModuleOp module) {
  const Calls calls(module);
  llvm::SmallVector<FuncOp> found;
  for (auto [function, traces] : llvm::zip(calls.functions, calls.tracing()))
    if (traces)
      found.push_back(function.op);
  return found;
}

llvm::SmallVector<FuncOp> functionsThatMayCallThemselves(mlir::ModuleOp module) {
  const Calls calls(module);
  llvm::SmallVector<FuncOp> found;
  for (auto [function, traces, isInCycle] :
       llvm::zip(calls.functions, calls.tracing(), calls.inCycles()))
    if (traces && isInCycle) // cycles of these trace as a whole
      found.push_back(function.op);
  return found;
}

} // namespace rtsl::continuation
