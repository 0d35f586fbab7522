//===- TailTraces.cpp - tail traces ---------------------------------------===//
//
//     rtsl.suspend %o, %d, ^resume
//   ^resume:                                     rtsl.spawn %o, %d last
//     %c = rtsl.trace_result              ==>    return {rtsl.last}
//     rtsl.store %c, SampleColor
//     return
//
// The color that the traced ray returns is the color that this ray returns, so it replaces this
// one: there is no frame and no further level, and recursion runs as a loop. The colors are the
// same bits as with recursion, because nothing is computed after the trace.
//
// The same is done for a payload that is the one of this ray, or a copy that is stored back after
// the trace: the copy in the frame was made of its parts, and all of them are stored back to where
// they came from. They are stored there before the trace, and the ray gets that address.
//
//     rtsl.store %a, %copy["x"]                  rtsl.store %a, %own["x"]
//     rtsl.spawn_payload ... carries %copy ==>   rtsl.spawn_payload ... carries %own last
//     rtsl.suspend ^resume                       return {rtsl.last}
//   ^resume:
//     %x = rtsl.load %copy["x"]
//     rtsl.store %x, %own["x"]
//     return
//
// Sums and products after a trace are not moved before it, although that would be possible: it
// would change the order of rounding. Such a ray saves their operands and nothing else.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/passes/continuation/suspend/Steps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "mlir/Dialect/Math/IR/Math.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "mlir/IR/IRMapping.h"
#include "mlir/IR/PatternMatch.h"
#include "mlir/Interfaces/SideEffectInterfaces.h"
#include "mlir/Transforms/RegionUtils.h"
#include "llvm/ADT/DenseSet.h"
#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/SmallPtrSet.h"
#include "llvm/ADT/SmallString.h"

#include <functional>
#include <map>
#include <set>

namespace rtsl::continuation {

using mlir::Value;

namespace {

/// An address as a base and the path to it; no base if an index is not constant.
struct AddressPath {
  mlir::Operation *base = nullptr;
  std::string path;

  explicit AddressPath(Value address) {
    while (mlir::Operation *op = address.getDefiningOp()) {
      if (auto field = llvm::dyn_cast<ir::FieldOp>(op)) {
        path = "." + field.getField().str() + path;
        address = field.getBase();
      } else if (auto element = llvm::dyn_cast<ir::ElementOp>(op)) {
        if (!element.constantIndex())
          return;
        path = "." + std::to_string(*element.constantIndex()) + path;
        address = element.getBase();
      } else {
        base = op;
        return;
      }
    }
  }
  bool isSampleColor() const {
    auto state = llvm::dyn_cast_or_null<ir::StateOp>(base);
    return state && state.getName() == "SampleColor";
  }
};

/// The number of parts of a type that can be stored separately.
std::size_t partsOf(mlir::Type type) {
  std::size_t parts = 0;
  if (auto fields = llvm::dyn_cast<ir::StructType>(type)) {
    for (mlir::Type field : fields.getFieldTypes())
      parts += partsOf(field);
    return parts;
  }
  if (auto array = llvm::dyn_cast<ir::ArrayType>(type))
    return array.getLength() * partsOf(array.getElement());
  return 1;
}

/// Calls `visit` for the operations from `op` to the end of the method, if there is only one path,
/// with the operation and the values of block arguments. False if there are several paths, or if
/// `visit` returns false.
bool walkToTheEnd(mlir::Operation *op,
                  llvm::function_ref<bool(mlir::Operation *, const mlir::IRMapping &)> visit) {
  mlir::IRMapping arguments;
  llvm::SmallPtrSet<mlir::Block *, 4> seen;
  while (true) {
    if (llvm::isa<mlir::func::ReturnOp>(op))
      return true;
    if (auto branch = llvm::dyn_cast<mlir::cf::BranchOp>(op)) {
      if (!seen.insert(branch.getDest()).second)
        return false;
      llvm::SmallVector<Value> passed;
      for (Value value : branch.getDestOperands())
        passed.push_back(arguments.lookupOrDefault(value));
      arguments.map(branch.getDest()->getArguments(), passed);
      op = &branch.getDest()->front();
      continue;
    }
    if (op->hasTrait<mlir::OpTrait::IsTerminator>() || !visit(op, arguments))
      return false;
    op = op->getNextNode();
  }
}

//===----------------------------------------------------------------------===//
// A color
//===----------------------------------------------------------------------===//

/// Is the result of this trace the final value of SampleColor, and does nothing else happen?
bool isTailColor(ir::TraceResultOp result) {
  Value color;
  const bool hasOnePath = walkToTheEnd(result->getNextNode(),
                                       [&](mlir::Operation *op, const mlir::IRMapping &arguments) {
                                         if (auto store = llvm::dyn_cast<ir::StoreOp>(op)) {
                                           color = arguments.lookupOrDefault(store.getValue());
                                           return AddressPath(store.getAddress()).isSampleColor();
                                         }
                                         return mlir::isMemoryEffectFree(op);
                                       });
  return hasOnePath && color == result.getResult();
}

//===----------------------------------------------------------------------===//
// A payload
//===----------------------------------------------------------------------===//

/// A copy of this ray's payload, and its uses.
class TailPayload {
public:
  explicit TailPayload(ir::SpawnPayloadOp spawn) : spawn(spawn) {}

  /// Whether the copy is made part by part right before the ray is sent, and stored back
  /// completely.
  bool find();
  void forward();

private:
  bool findStores();
  bool findReturn();

  ir::SpawnPayloadOp spawn;
  ir::VarOp copy;
  llvm::MapVector<Value, AddressPath> addresses; // in the copy
  std::map<std::string, ir::StoreOp> sent;       // the last store of each part
  llvm::SmallVector<mlir::Operation *> users;    // users of the copy, in order
  llvm::SmallPtrSet<mlir::Operation *, 8> loads; // of the copy, not yet found after the ray
  std::set<std::string> returned;
};

/// All users of the copy are known, and those before the ray only store.
bool TailPayload::findStores() {
  llvm::SmallVector<Value> worklist = {copy.getResult()};
  while (!worklist.empty()) {
    const Value address = worklist.pop_back_val();
    addresses.insert({address, AddressPath(address)});
    for (mlir::Operation *user : address.getUsers()) {
      if (llvm::isa<ir::FieldOp, ir::ElementOp>(user)) {
        if (!AddressPath(user->getResult(0)).base)
          return false;
        worklist.push_back(user->getResult(0));
      } else if (auto store = llvm::dyn_cast<ir::StoreOp>(user);
                 store && store.getAddress() == address) {
        if (store->getBlock() != spawn->getBlock() || !store->isBeforeInBlock(spawn))
          return false;
        ir::StoreOp &last = sent[addresses.find(address)->second.path];
        if (!last || last->isBeforeInBlock(store))
          last = store;
        users.push_back(store);
      } else if (llvm::isa<ir::LoadOp>(user)) {
        loads.insert(user);
      } else if (user != spawn) {
        return false;
      }
    }
  }
  mlir::Type type = llvm::cast<ir::PtrType>(copy.getType()).getPointee();
  return sent.size() == partsOf(type);
}

/// After the ray, each part is stored to the same part of this ray's own payload, and nothing else
/// happens.
bool TailPayload::findReturn() {
  auto suspend = llvm::cast<ir::SuspendOp>(spawn->getBlock()->back());
  const bool hasOnePath =
      walkToTheEnd(suspend.getResume()->front().getNextNode(),
                   [&](mlir::Operation *op, const mlir::IRMapping &arguments) {
                     if (auto load = llvm::dyn_cast<ir::LoadOp>(op))
                       return loads.erase(load);
                     auto store = llvm::dyn_cast<ir::StoreOp>(op);
                     if (!store)
                       return mlir::isMemoryEffectFree(op);
                     const AddressPath target(store.getAddress());
                     auto payload = llvm::dyn_cast_or_null<ir::PayloadOp>(target.base);
                     auto load =
                         arguments.lookupOrDefault(store.getValue()).getDefiningOp<ir::LoadOp>();
                     if (!payload || payload.getType() != copy.getType() || !load)
                       return false;
                     const auto *from = addresses.find(load.getAddress());
                     if (from == addresses.end() || from->second.path != target.path)
                       return false;
                     returned.insert(target.path);
                     return true;
                   });
  return hasOnePath && loads.empty() && returned.size() == sent.size();
}

bool TailPayload::find() {
  copy = spawn.getPayload().getDefiningOp<ir::VarOp>();
  return copy && findStores() && findReturn();
}

/// Redirects the stores to the payload itself, after all loads from it.
void TailPayload::forward() {
  mlir::OpBuilder builder(spawn);
  mlir::IRMapping mapping; // addresses in the payload may be computed only after the ray
  mapping.map(copy.getResult(),
              ir::PayloadOp::create(builder, spawn.getLoc(), copy.getType()).getResult());
  std::function<Value(Value)> inOwn = [&](Value address) {
    if (!mapping.contains(address)) {
      for (Value operand : address.getDefiningOp()->getOperands())
        if (addresses.count(operand))
          inOwn(operand);
      builder.clone(*address.getDefiningOp(), mapping);
    }
    return mapping.lookup(address);
  };
  for (auto &[path, store] : sent)
    ir::StoreOp::create(builder, store.getLoc(), store.getValue(), inOwn(store.getAddress()));
  spawn.getPayloadMutable().assign(mapping.lookup(copy.getResult()));
  for (mlir::Operation *store : users)
    store->erase();
}

//===----------------------------------------------------------------------===//
// Rewriting
//===----------------------------------------------------------------------===//

ir::SpawnPayloadOp spawnBefore(ir::SuspendOp suspend) {
  return llvm::dyn_cast_or_null<ir::SpawnPayloadOp>(suspend->getPrevNode());
}

/// Ends the method at the trace.
void endAt(ir::SuspendOp suspend) {
  mlir::OpBuilder builder(suspend);
  if (suspend.getOrigin())
    ir::SpawnOp::create(builder, suspend.getLoc(), suspend.getOrigin(), suspend.getDirection(),
                        /*last=*/true);
  else
    spawnBefore(suspend).setLast(true);
  auto end = mlir::func::ReturnOp::create(builder, suspend.getLoc());
  ir::attr::last.set(end);
  suspend.erase();
}

} // namespace

llvm::SmallVector<mlir::Location> endAtTailTraces(FuncOp function) {
  llvm::SmallVector<mlir::Location> locations;
  if (function.getNumResults() != 0 || isFramed(function)) // the caller continues
    return locations;
  for (ir::SuspendOp suspend : suspendsOf(function)) {
    if (auto result = llvm::dyn_cast<ir::TraceResultOp>(suspend.getResume()->front())) {
      if (!isTailColor(result))
        continue;
    } else {
      auto spawn = spawnBefore(suspend);
      if (!spawn)
        continue;
      TailPayload payload(spawn);
      if (!payload.find())
        continue;
      payload.forward();
    }
    locations.push_back(suspend.getLoc());
    endAt(suspend);
  }
  if (!locations.empty()) {
    mlir::IRRewriter rewriter(function.getContext());
    (void)mlir::eraseUnreachableBlocks(rewriter, function->getRegions());
    (void)mlir::runRegionDCE(rewriter, function->getRegions());
  }
  return locations;
}

//===----------------------------------------------------------------------===//
// Sums and products
//===----------------------------------------------------------------------===//

namespace {

/// Whether `op` is a sum or product of the trace's result: at most one factor depends on the
/// result, or any number of summands.
bool isAffine(mlir::Operation *op, llvm::function_ref<bool(Value)> isTraced) {
  if (llvm::isa<mlir::arith::AddFOp, mlir::arith::SubFOp, mlir::arith::NegFOp,
                mlir::vector::BroadcastOp, mlir::vector::FromElementsOp, mlir::vector::ShuffleOp>(
          op))
    return true;
  if (auto extract = llvm::dyn_cast<mlir::vector::ExtractOp>(op))
    return !extract.hasDynamicPosition();
  if (llvm::isa<mlir::arith::MulFOp>(op))
    return !isTraced(op->getOperand(0)) || !isTraced(op->getOperand(1));
  if (llvm::isa<mlir::arith::DivFOp>(op))
    return !isTraced(op->getOperand(1));
  if (llvm::isa<mlir::math::FmaOp>(op))
    return !isTraced(op->getOperand(0)) || !isTraced(op->getOperand(1));
  return false;
}

} // namespace

bool onlyScalesAndAdds(ir::SuspendOp suspend) {
  llvm::DenseSet<Value> traced;
  mlir::Operation *first = &suspend.getResume()->front();
  if (llvm::isa<ir::CallReturnedOp>(first))
    return false;
  mlir::Operation *payload = nullptr;
  if (auto result = llvm::dyn_cast<ir::TraceResultOp>(first))
    traced.insert(result.getResult());
  else if (auto spawn = spawnBefore(suspend))
    payload = AddressPath(spawn.getPayload()).base;
  return walkToTheEnd(first->getNextNode(), [&](mlir::Operation *op,
                                                const mlir::IRMapping &arguments) {
    auto isTraced = [&](Value value) { return traced.contains(arguments.lookupOrDefault(value)); };
    if (auto store = llvm::dyn_cast<ir::StoreOp>(op)) {
      const AddressPath target(store.getAddress());
      return target.isSampleColor() || llvm::isa_and_nonnull<ir::PayloadOp>(target.base);
    }
    if (auto load = llvm::dyn_cast<ir::LoadOp>(op);
        load && payload && AddressPath(load.getAddress()).base == payload) {
      traced.insert(load.getResult());
      return true;
    }
    if (llvm::any_of(op->getOperands(), isTraced)) {
      traced.insert(op->result_begin(), op->result_end());
      return isAffine(op, isTraced);
    }
    return mlir::isMemoryEffectFree(op) || llvm::isa<ir::LoadOp>(op);
  });
}

} // namespace rtsl::continuation
