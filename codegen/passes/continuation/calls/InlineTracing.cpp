//===- InlineTracing.cpp - calls of functions that trace ------------------===//
//
// A state is a piece of one function, so calls that may trace are inlined. A call on the caller's
// own object that nothing follows remains: it is marked `rtsl.tail` and later becomes a jump from
// state to state. Entry points that switch over the classes of a scene consist of such calls. A
// function that may call itself, through references, cannot be inlined, and a large function with
// several callers should not be: these are marked `rtsl.framed` and get a frame of their own
// (CallFrames.cpp).
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/WithoutCasts.h"
#include "codegen/passes/InlineFunctions.h"
#include "codegen/passes/continuation/calls/Steps.h"

#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/IR/IRMapping.h"
#include "mlir/IR/SymbolTable.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/SetVector.h"

#include <algorithm>
#include <vector>

namespace rtsl::continuation {

using mlir::func::CallOp;

namespace {

class Inliner {
public:
  explicit Inliner(mlir::ModuleOp module) : module(module), symbols(module) {
    for (FuncOp function : tracingFunctions(module))
      tracing.insert(function);
  }
  void run();

private:
  enum class Visit { New, Open, Done };
  void visit(FuncOp function);
  bool needsFrame(FuncOp callee);
  FuncOp tracingCallee(CallOp call) {
    auto callee = symbols.lookup<FuncOp>(call.getCallee());
    return callee && tracing.contains(callee) ? callee : FuncOp();
  }
  bool isTail(CallOp call, FuncOp callee);
  /// Returns the calls in the copy.
  llvm::SmallVector<CallOp> inlineCall(CallOp call, FuncOp callee);
  void eraseUncalled();

  mlir::ModuleOp module;
  mlir::SymbolTable symbols;
  llvm::SmallSetVector<mlir::Operation *, 16> tracing;
  llvm::DenseMap<mlir::Operation *, Visit> visits;
  llvm::DenseMap<mlir::Operation *, unsigned> callCounts; // before inlining
};

/// Does the caller return right after the call, and is the callee's object the caller's?
bool Inliner::isTail(CallOp call, FuncOp callee) {
  auto caller = call->getParentOfType<FuncOp>();
  mlir::Value object = objectOf(caller);
  if (callee.getNumResults() != 0 || caller.getNumResults() != 0 || call.getNumOperands() != 1 ||
      !object || !objectOf(callee))
    return false;
  if (ir::withoutCasts(call.getOperand(0)) != object)
    return false;
  mlir::Operation *next = call->getNextNode();
  llvm::SmallPtrSet<mlir::Block *, 4> seen;
  while (auto branch = llvm::dyn_cast<mlir::cf::BranchOp>(next)) {
    if (!seen.insert(branch.getDest()).second)
      return false;
    next = &branch.getDest()->front();
  }
  return llvm::isa<mlir::func::ReturnOp>(next);
}

/// ^a: x; call @f(%v); y      ==>      ^a: x; br ^f(%v)   ^f(%p): ...; br ^b(%results)   ^b(...): y
llvm::SmallVector<CallOp> Inliner::inlineCall(CallOp call, FuncOp callee) {
  mlir::Block *before = call->getBlock();
  mlir::Block *after = before->splitBlock(call);
  mlir::OpBuilder builder(call.getContext());
  for (mlir::Value result : call.getResults())
    result.replaceAllUsesWith(after->addArgument(result.getType(), result.getLoc()));

  mlir::IRMapping mapping;
  for (mlir::Block &block : callee.getBody()) {
    mlir::Block *copy = new mlir::Block;
    before->getParent()->getBlocks().insert(after->getIterator(), copy);
    mapping.map(&block, copy);
    for (mlir::BlockArgument argument : block.getArguments()) {
      // Addresses cannot be block arguments, because they are recomputed after traces.
      if (block.isEntryBlock() && llvm::isa<ir::PtrType>(argument.getType()))
        mapping.map(argument, call.getOperand(argument.getArgNumber()));
      else
        mapping.map(argument, copy->addArgument(argument.getType(), argument.getLoc()));
    }
  }
  // Definitions need not come before uses in the order of blocks; operands are mapped when all
  // operations have been cloned.
  llvm::SmallVector<mlir::Operation *> clones;
  for (mlir::Block &block : callee.getBody()) {
    builder.setInsertionPointToEnd(mapping.lookup(&block));
    for (mlir::Operation &op : block) {
      if (auto returned = llvm::dyn_cast<mlir::func::ReturnOp>(op)) {
        clones.push_back(
            mlir::cf::BranchOp::create(builder, call.getLoc(), after, returned.getOperands()));
      } else {
        mlir::Operation *clone = builder.clone(op, mapping);
        clone->setLoc(mlir::CallSiteLoc::get(op.getLoc(), call.getLoc()));
        ir::attr::tail.removeFrom(clone);
        clones.push_back(clone);
      }
    }
  }
  for (mlir::Operation *clone : clones)
    for (mlir::OpOperand &operand : clone->getOpOperands())
      operand.set(mapping.lookupOrDefault(operand.get()));
  builder.setInsertionPointToEnd(before);
  llvm::SmallVector<mlir::Value> passed;
  llvm::copy_if(call.getOperands(), std::back_inserter(passed),
                [](mlir::Value value) { return !llvm::isa<ir::PtrType>(value.getType()); });
  mlir::cf::BranchOp::create(builder, call.getLoc(), mapping.lookup(&callee.getBody().front()),
                             passed);
  call.erase();
  llvm::SmallVector<CallOp> calls;
  for (mlir::Operation *clone : clones)
    clone->walk([&](CallOp copied) { calls.push_back(copied); });
  return calls;
}

/// A function that is already marked may call itself.
bool Inliner::needsFrame(FuncOp callee) {
  return isFramed(callee) || visits[callee] == Visit::Open ||
         (callCounts[callee] > 1 && codegen::isLargeToInline(callee));
}

void Inliner::visit(FuncOp function) {
  Visit &state = visits[function];
  if (state != Visit::New)
    return;
  state = Visit::Open;
  llvm::SmallVector<CallOp> pending; // in reverse order
  const auto add = [&](llvm::ArrayRef<CallOp> calls) {
    pending.append(calls.rbegin(), calls.rend());
  };
  llvm::SmallVector<CallOp> calls;
  function.walk([&](CallOp call) { calls.push_back(call); });
  add(calls);
  while (!pending.empty()) {
    CallOp call = pending.pop_back_val();
    FuncOp callee = tracingCallee(call);
    if (!callee || ir::attr::tail.isOn(call) || isFramed(call))
      continue;
    visit(callee);
    if (visits[callee] == Visit::Done && isTail(call, callee)) {
      ir::attr::tail.set(call);
    } else if (needsFrame(callee)) {
      ir::attr::framed.set(callee);
      ir::attr::framed.set(call);
    } else {
      add(inlineCall(call, callee));
    }
  }
  visits[function] = Visit::Done;
}

void Inliner::run() {
  module.walk([&](CallOp call) {
    if (FuncOp callee = tracingCallee(call))
      ++callCounts[callee];
  });
  // Functions that already have a frame first: the others of their cycle are then inlined.
  for (bool framed : {true, false})
    for (mlir::Operation *function : tracing)
      if (isFramed(function) == framed)
        visit(llvm::cast<FuncOp>(function));
  eraseUncalled();
}

/// Erases functions whose calls have all been inlined.
void Inliner::eraseUncalled() {
  llvm::DenseMap<mlir::StringAttr, unsigned> uses;
  const auto forEachUse = [](mlir::Region &region, llvm::function_ref<void(mlir::StringAttr)> act) {
    if (auto all = mlir::SymbolTable::getSymbolUses(&region))
      for (const mlir::SymbolTable::SymbolUse &use : *all)
        act(use.getSymbolRef().getRootReference());
  };
  forEachUse(module.getBodyRegion(), [&](mlir::StringAttr name) { ++uses[name]; });
  llvm::SmallVector<FuncOp> idle;
  const auto addIfIdle = [&](mlir::Operation *op) {
    auto function = llvm::dyn_cast_or_null<FuncOp>(op);
    if (function && tracing.contains(function) && function.isPrivate() &&
        uses.lookup(function.getSymNameAttr()) == 0)
      idle.push_back(function);
  };
  for (mlir::Operation *function : tracing)
    addIfIdle(function);
  while (!idle.empty()) {
    FuncOp function = idle.pop_back_val();
    llvm::SmallVector<mlir::StringAttr> called;
    forEachUse(function.getBody(), [&](mlir::StringAttr name) {
      if (--uses[name] == 0)
        called.push_back(name);
    });
    tracing.remove(function);
    symbols.erase(function);
    for (mlir::StringAttr name : called)
      addIfIdle(symbols.lookup(name));
  }
}

} // namespace

void inlineTracingCalls(mlir::ModuleOp module) {
  Inliner(module).run();
}

} // namespace rtsl::continuation
