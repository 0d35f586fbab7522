//===- LastTraces.cpp - tail traces ---------------------------------------===//
//
//     rtsl.suspend %o, %d, ^resume
//   ^resume:                                     rtsl.spawn %o, %d last
//     %c = rtsl.trace_result              ==>    return {rtsl.last}
//     rtsl.store %c, SampleColor
//     return
//
// What the ray brings back is what this one brings back, so it takes its place: no frame, no level
// more, and recursion runs as a loop. The colors are those of recursion bit for bit, for nothing is
// computed on the way back.
//
// The same for a payload that is the one that this ray was given, or becomes it when the ray is
// back: the copy in the frame was made of these parts, and all of them return to where they came
// from. They are put there before, and the ray gets that address.
//
//     rtsl.store %a, %copy["x"]                  rtsl.store %a, %own["x"]
//     rtsl.spawn_payload ... carries %copy ==>   rtsl.spawn_payload ... carries %own last
//     rtsl.suspend ^resume                       return {rtsl.last}
//   ^resume:
//     %x = rtsl.load %copy["x"]
//     rtsl.store %x, %own["x"]
//     return
//
// Sums and products behind a trace are not moved in front of it, although they could be collected
// there: that is another order of rounding. Such a ray keeps what they need and nothing else.
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

/// An address as the variable that it lies in and the way to it; no variable if an index is not
/// constant.
struct Place {
  mlir::Operation *base = nullptr;
  std::string path;

  explicit Place(Value address) {
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

/// How many parts of a type can be stored one by one.
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

/// Calls `visit` for what runs from `op` on until the method is over, where that is one way; it
/// gives the operation and what stands for arguments of blocks. False if there are several ways, or
/// if `visit` says so.
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

/// Is the result of this trace what is left in SampleColor, and does nothing else happen?
bool isLastColor(ir::TraceResultOp result) {
  Value color;
  const bool isOneWay = walkToTheEnd(result->getNextNode(),
                                     [&](mlir::Operation *op, const mlir::IRMapping &arguments) {
                                       if (auto store = llvm::dyn_cast<ir::StoreOp>(op)) {
                                         color = arguments.lookupOrDefault(store.getValue());
                                         return Place(store.getAddress()).isSampleColor();
                                       }
                                       return mlir::isMemoryEffectFree(op);
                                     });
  return isOneWay && color == result.getResult();
}

//===----------------------------------------------------------------------===//
// A payload
//===----------------------------------------------------------------------===//

/// A copy of the payload that this ray was given, and what becomes of it.
class LastPayload {
public:
  explicit LastPayload(ir::SpawnPayloadOp spawn) : spawn(spawn) {}

  /// Whether the copy is made part by part right before the ray is sent, and goes back whole.
  bool find();
  void forward();

private:
  bool findStores();
  bool findReturn();

  ir::SpawnPayloadOp spawn;
  ir::VarOp copy;
  llvm::MapVector<Value, Place> addresses;       // in the copy
  std::map<std::string, ir::StoreOp> sent;       // the last store of each part
  llvm::SmallVector<mlir::Operation *> gone;     // the copy's users, as they stand
  llvm::SmallPtrSet<mlir::Operation *, 8> loads; // of the copy, that were not met behind the ray
  std::set<std::string> returned;
};

/// All users of the copy are known, and those before the ray only store.
bool LastPayload::findStores() {
  llvm::SmallVector<Value> worklist = {copy.getResult()};
  while (!worklist.empty()) {
    const Value address = worklist.pop_back_val();
    addresses.insert({address, Place(address)});
    for (mlir::Operation *user : address.getUsers()) {
      if (llvm::isa<ir::FieldOp, ir::ElementOp>(user)) {
        if (!Place(user->getResult(0)).base)
          return false;
        worklist.push_back(user->getResult(0));
      } else if (auto store = llvm::dyn_cast<ir::StoreOp>(user);
                 store && store.getAddress() == address) {
        if (store->getBlock() != spawn->getBlock() || !store->isBeforeInBlock(spawn))
          return false;
        ir::StoreOp &last = sent[addresses.find(address)->second.path];
        if (!last || last->isBeforeInBlock(store))
          last = store;
        gone.push_back(store);
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

/// Behind the ray each part goes to the same place of the payload of its own, and nothing else
/// happens.
bool LastPayload::findReturn() {
  auto suspend = llvm::cast<ir::SuspendOp>(spawn->getBlock()->back());
  const bool isOneWay =
      walkToTheEnd(suspend.getResume()->front().getNextNode(),
                   [&](mlir::Operation *op, const mlir::IRMapping &arguments) {
                     if (auto load = llvm::dyn_cast<ir::LoadOp>(op))
                       return loads.erase(load);
                     auto store = llvm::dyn_cast<ir::StoreOp>(op);
                     if (!store)
                       return mlir::isMemoryEffectFree(op);
                     const Place place(store.getAddress());
                     auto payload = llvm::dyn_cast_or_null<ir::PayloadOp>(place.base);
                     auto load =
                         arguments.lookupOrDefault(store.getValue()).getDefiningOp<ir::LoadOp>();
                     if (!payload || payload.getType() != copy.getType() || !load)
                       return false;
                     const auto *from = addresses.find(load.getAddress());
                     if (from == addresses.end() || from->second.path != place.path)
                       return false;
                     returned.insert(place.path);
                     return true;
                   });
  return isOneWay && loads.empty() && returned.size() == sent.size();
}

bool LastPayload::find() {
  copy = spawn.getPayload().getDefiningOp<ir::VarOp>();
  return copy && findStores() && findReturn();
}

/// The stores go to the payload itself, once all that is read of it has been read.
void LastPayload::forward() {
  mlir::OpBuilder builder(spawn);
  mlir::IRMapping mapping; // addresses in the payload may be computed behind the ray only
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
  for (mlir::Operation *store : gone)
    store->erase();
}

//===----------------------------------------------------------------------===//
// The change
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

llvm::SmallVector<mlir::Location> endAtLastTraces(FuncOp function) {
  llvm::SmallVector<mlir::Location> places;
  if (function.getNumResults() != 0 || isFramed(function)) // the caller is not over
    return places;
  for (ir::SuspendOp suspend : suspendsOf(function)) {
    if (auto result = llvm::dyn_cast<ir::TraceResultOp>(suspend.getResume()->front())) {
      if (!isLastColor(result))
        continue;
    } else {
      auto spawn = spawnBefore(suspend);
      if (!spawn)
        continue;
      LastPayload payload(spawn);
      if (!payload.find())
        continue;
      payload.forward();
    }
    places.push_back(suspend.getLoc());
    endAt(suspend);
  }
  if (!places.empty()) {
    mlir::IRRewriter rewriter(function.getContext());
    (void)mlir::eraseUnreachableBlocks(rewriter, function->getRegions());
    (void)mlir::runRegionDCE(rewriter, function->getRegions());
  }
  return places;
}

//===----------------------------------------------------------------------===//
// Sums and products
//===----------------------------------------------------------------------===//

namespace {

/// Whether `op` is a sum or product of what the trace brought back: of one operand at most, or,
/// where it adds, of any.
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
    payload = Place(spawn.getPayload()).base;
  return walkToTheEnd(first->getNextNode(), [&](mlir::Operation *op,
                                                const mlir::IRMapping &arguments) {
    auto isTraced = [&](Value value) { return traced.contains(arguments.lookupOrDefault(value)); };
    if (auto store = llvm::dyn_cast<ir::StoreOp>(op)) {
      const Place place(store.getAddress());
      return place.isSampleColor() || llvm::isa_and_nonnull<ir::PayloadOp>(place.base);
    }
    if (auto load = llvm::dyn_cast<ir::LoadOp>(op);
        load && payload && Place(load.getAddress()).base == payload) {
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
