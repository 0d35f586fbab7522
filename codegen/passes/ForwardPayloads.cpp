#include "codegen/passes/ForwardPayloads.h"

#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "mlir/Pass/Pass.h"
#include "llvm/ADT/SmallPtrSet.h"
#include "llvm/ADT/StringMap.h"

#include <optional>
#include <string>

namespace rtsl::codegen {

namespace {

using mlir::Operation;
using mlir::Value;

/// The path from an address's base to it; none if an index is not constant.
std::optional<std::string> pathOf(Value address) {
  std::string path;
  for (Operation *op = address.getDefiningOp(); op; op = address.getDefiningOp()) {
    if (auto field = llvm::dyn_cast<ir::FieldOp>(op)) {
      path = "." + field.getField().str() + path;
    } else if (auto element = llvm::dyn_cast<ir::ElementOp>(op)) {
      if (!element.constantIndex())
        return std::nullopt;
      path = "." + std::to_string(*element.constantIndex()) + path;
    } else {
      break;
    }
    address = op->getOperand(0);
  }
  return path;
}

/// A trace whose payload is a variable, which may be a copy of the ray's own payload.
class CopiedPayload {
public:
  explicit CopiedPayload(ir::TracePayloadOp trace) : trace(trace) {}

  /// Whether all of it is copied from the ray's own payload right before the trace and back right
  /// after it, and nothing else reads it. Where it is set before, as a variable is that is declared
  /// without a value, no load could tell.
  bool find() {
    copy = trace.getPayload().getDefiningOp<ir::VarOp>();
    if (!copy || !findUsers(copy.getResult()))
      return false;
    leaves = ir::leafCount(ir::pointee(copy.getResult()));
    return findCopyTo() && findCopyBack() && returned.size() == leaves && loads.empty();
  }

  void forward() {
    mlir::OpBuilder builder(trace);
    trace.getPayloadMutable().assign(
        ir::PayloadOp::create(builder, trace.getLoc(), copy.getType()).getResult());
    for (Operation *op : erased)
      op->erase();
    for (Operation *op : stores) // of what is overwritten
      op->erase();
  }

private:
  /// Loads and stores of the copy and its parts, and nothing else.
  bool findUsers(Value address) {
    if (!pathOf(address))
      return false;
    return llvm::all_of(address.getUsers(), [&](Operation *user) {
      if (llvm::isa<ir::FieldOp, ir::ElementOp>(user))
        return findUsers(user->getResult(0));
      if (user != trace && ir::leafCount(ir::pointee(address)) != 1)
        return false; // more than one part at once
      if (llvm::isa<ir::LoadOp>(user))
        return loads.insert(user).second;
      auto store = llvm::dyn_cast<ir::StoreOp>(user);
      if (store && store.getAddress() == address)
        return stores.insert(user).second;
      return user == trace;
    });
  }

  /// Is it part `path` of the ray's own payload?
  bool isOwn(Value address, llvm::StringRef path) {
    auto own = llvm::dyn_cast_or_null<ir::PayloadOp>(ir::baseOperation(address));
    const std::optional<std::string> other = pathOf(address);
    return own && own.getType() == copy.getType() && other && *other == path;
  }

  /// From the trace back until all parts are found: the last store of each part is of the same part
  /// of the own payload, which nothing between may change.
  bool findCopyTo() {
    llvm::SmallPtrSet<Operation *, 8> awaited; // loads of what is stored later
    for (Operation *op = trace->getPrevNode(); op && !(sent.size() == leaves && awaited.empty());
         op = op->getPrevNode()) {
      if (awaited.erase(op) || mlir::isMemoryEffectFree(op) || llvm::isa<ir::LoadOp>(op))
        continue;
      if (!stores.erase(op))
        return false;
      erased.push_back(op);
      auto store = llvm::cast<ir::StoreOp>(op);
      const std::string path = *pathOf(store.getAddress());
      if (!sent.insert({path, true}).second)
        continue; // it is overwritten
      auto load = store.getValue().getDefiningOp<ir::LoadOp>();
      if (!load || !isOwn(load.getAddress(), path) || load->getBlock() != trace->getBlock())
        return false;
      awaited.insert(load);
    }
    return sent.size() == leaves && awaited.empty();
  }

  bool findCopyBack() {
    for (Operation *op = trace->getNextNode(); op && !loads.empty(); op = op->getNextNode()) {
      if (mlir::isMemoryEffectFree(op))
        continue;
      if (llvm::isa<ir::LoadOp>(op) && loads.contains(op)) {
        if (!op->hasOneUse())
          return false;
        continue;
      }
      auto store = llvm::dyn_cast<ir::StoreOp>(op);
      auto load = store ? store.getValue().getDefiningOp<ir::LoadOp>() : ir::LoadOp();
      if (!load || !loads.contains(load))
        return false;
      const std::string path = *pathOf(load.getAddress());
      if (!isOwn(store.getAddress(), path) || !returned.insert({path, true}).second)
        return false;
      loads.erase(load);
      erased.push_back(store);
      erased.push_back(load);
    }
    return true;
  }

  ir::TracePayloadOp trace;
  ir::VarOp copy;
  unsigned leaves = 0;                              // parts that are not structs or arrays
  llvm::SmallPtrSet<Operation *, 16> loads, stores; // of the copy, not yet in `erased`
  llvm::StringMap<bool> sent, returned;             // paths
  llvm::SmallVector<Operation *, 32> erased;        // users before what they use
};

struct ForwardPayloads
    : mlir::PassWrapper<ForwardPayloads, mlir::OperationPass<mlir::func::FuncOp>> {
  MLIR_DEFINE_EXPLICIT_INTERNAL_INLINE_TYPE_ID(ForwardPayloads)
  llvm::StringRef getArgument() const override { return "rtsl-forward-payloads"; }
  llvm::StringRef getDescription() const override {
    return "passes a ray's own payload to rays that carry a copy of it";
  }

  void runOnOperation() override {
    llvm::SmallVector<ir::TracePayloadOp> traces;
    getOperation().walk([&](ir::TracePayloadOp trace) { traces.push_back(trace); });
    for (ir::TracePayloadOp trace : traces)
      if (CopiedPayload payload(trace); payload.find())
        payload.forward();
  }
};

} // namespace

std::unique_ptr<mlir::Pass> createForwardPayloadsPass() {
  return std::make_unique<ForwardPayloads>();
}

} // namespace rtsl::codegen
