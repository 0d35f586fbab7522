//===- InlineTracing.cpp - calls of functions that trace ------------------===//
//
// A state is a piece of one function, so what a function calls and what may trace becomes part of
// it. A call behind which nothing happens, on the caller's own object, stays: it is marked
// `rtsl.tail` and later a jump from state to state. That is what an entry is that switches over the
// classes of a scene. A call of what may be called by itself, through references, cannot become
// what it calls, and one of a large function that several call should not: `rtsl.framed`, a frame
// of its own (CallFrames.cpp).
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/InlineFunctions.h"
#include "codegen/passes/continuation/Steps.h"

#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/IR/IRMapping.h"
#include "mlir/IR/SymbolTable.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/SetVector.h"

namespace rtsl::continuation {

using mlir::func::CallOp;

llvm::SmallVector<FuncOp> tracingFunctions(mlir::ModuleOp module) {
  llvm::SmallSetVector<mlir::Operation *, 16> tracing;
  mlir::SymbolTable symbols(module);
  bool changed = true;
  while (changed) {
    changed = false;
    for (FuncOp function : module.getOps<FuncOp>()) {
      if (tracing.contains(function))
        continue;
      bool traces = function
                        .walk([&](mlir::Operation *op) {
                          auto call = llvm::dyn_cast<CallOp>(op);
                          bool here =
                              llvm::isa<ir::TraceOp, ir::TracePayloadOp, ir::SuspendOp, ir::SpawnOp,
                                        ir::SpawnPayloadOp>(op) ||
                              (call && (isFramed(call) || tracing.contains(symbols.lookup(call.getCallee()))));
                          return here ? mlir::WalkResult::interrupt() : mlir::WalkResult::advance();
                        })
                        .wasInterrupted();
      if (traces)
        changed |= tracing.insert(function);
    }
  }
  llvm::SmallVector<FuncOp> inOrder;
  for (FuncOp function : module.getOps<FuncOp>())
    if (tracing.contains(function))
      inOrder.push_back(function);
  return inOrder;
}

llvm::SmallVector<FuncOp> functionsThatMayCallThemselves(mlir::ModuleOp module) {
  const llvm::SmallVector<FuncOp> tracing = tracingFunctions(module);
  llvm::DenseMap<mlir::StringAttr, FuncOp> byName;
  for (FuncOp function : tracing)
    byName[function.getSymNameAttr()] = function;
  llvm::DenseMap<mlir::Operation *, llvm::SmallSetVector<mlir::Operation *, 8>> callees;
  for (FuncOp function : tracing)
    function.walk([&, function = function](CallOp call) {
      if (FuncOp callee = byName.lookup(call.getCalleeAttr().getAttr()))
        callees[function].insert(callee);
    });
  llvm::SmallVector<FuncOp> found;
  for (FuncOp function : tracing) {
    llvm::SmallSetVector<mlir::Operation *, 16> reached(callees[function].begin(), callees[function].end());
    for (std::size_t i = 0; i < reached.size(); ++i)
      reached.insert(callees[reached[i]].begin(), callees[reached[i]].end());
    if (reached.contains(function))
      found.push_back(function);
  }
  return found;
}

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
  bool wantsFrame(FuncOp callee);
  FuncOp tracingCallee(CallOp call) {
    auto callee = symbols.lookup<FuncOp>(call.getCallee());
    return callee && tracing.contains(callee) ? callee : FuncOp();
  }
  bool isTail(CallOp call, FuncOp callee);
  void inlineCall(CallOp call, FuncOp callee);

  mlir::ModuleOp module;
  mlir::SymbolTable symbols;
  llvm::SmallSetVector<mlir::Operation *, 16> tracing;
  llvm::DenseMap<mlir::Operation *, Visit> visits;
  llvm::DenseMap<mlir::Operation *, unsigned> callCounts; // before anything was inlined
};

/// Is the caller over when the call is, and is the callee's object the caller's?
bool Inliner::isTail(CallOp call, FuncOp callee) {
  auto caller = call->getParentOfType<FuncOp>();
  mlir::Value object = objectOf(caller);
  if (callee.getNumResults() != 0 || caller.getNumResults() != 0 || call.getNumOperands() != 1 ||
      !object || !objectOf(callee))
    return false;
  mlir::Value passed = call.getOperand(0);
  while (auto cast = passed.getDefiningOp<ir::CastRefOp>())
    passed = cast.getObject();
  if (passed != object)
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
void Inliner::inlineCall(CallOp call, FuncOp callee) {
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
      // Addresses are computed again behind traces, which arguments of blocks cannot be.
      if (block.isEntryBlock() && llvm::isa<ir::PtrType>(argument.getType()))
        mapping.map(argument, call.getOperand(argument.getArgNumber()));
      else
        mapping.map(argument, copy->addArgument(argument.getType(), argument.getLoc()));
    }
  }
  // Blocks need not stand in an order in which definitions come first; clone maps operands when all
  // are there.
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
        clone->removeAttr("rtsl.tail");
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
  mlir::cf::BranchOp::create(builder, call.getLoc(), mapping.lookup(&callee.getBody().front()), passed);
  call.erase();
}

/// One that is marked already may call itself.
bool Inliner::wantsFrame(FuncOp callee) {
  return isFramed(callee) || visits[callee] == Visit::Open ||
         (callCounts[callee] > 1 && codegen::isLargeToInline(callee));
}

void Inliner::visit(FuncOp function) {
  Visit &state = visits[function];
  if (state != Visit::New)
    return;
  state = Visit::Open;
  while (true) {
    CallOp found;
    FuncOp callee;
    function.walk([&](CallOp call) {
      callee = tracingCallee(call);
      if (!callee || call->hasAttr("rtsl.tail") || isFramed(call))
        return mlir::WalkResult::advance();
      found = call;
      return mlir::WalkResult::interrupt();
    });
    if (!found)
      break;
    visit(callee);
    auto mark = mlir::UnitAttr::get(module.getContext());
    if (visits[callee] == Visit::Done && isTail(found, callee)) {
      found->setAttr("rtsl.tail", mark);
    } else if (wantsFrame(callee)) {
      callee->setAttr("rtsl.framed", mark);
      found->setAttr("rtsl.framed", mark);
    } else {
      inlineCall(found, callee);
    }
  }
  visits[function] = Visit::Done;
}

void Inliner::run() {
  module.walk([&](CallOp call) {
    if (FuncOp callee = tracingCallee(call))
      ++callCounts[callee];
  });
  // What has a frame already first: the others of its circle then become part of it.
  for (bool framed : {true, false})
    for (mlir::Operation *function : tracing)
      if (isFramed(function) == framed)
        visit(llvm::cast<FuncOp>(function));
  // What was only called from where it is now inlined has done its work.
  llvm::SmallVector<mlir::Operation *> callersFirst(tracing.begin(), tracing.end());
  bool changed = true;
  while (changed) {
    changed = false;
    for (mlir::Operation *&op : callersFirst) {
      if (!op || !llvm::cast<FuncOp>(op).isPrivate() ||
          !mlir::SymbolTable::symbolKnownUseEmpty(op, module))
        continue;
      op->erase();
      op = nullptr;
      changed = true;
    }
  }
}

} // namespace

void inlineTracingCalls(mlir::ModuleOp module) {
  Inliner(module).run();
}

} // namespace rtsl::continuation
