//===- Dispatch.cpp - from states to a state machine ----------------------===//
//
// Makes the frame a parameter and numbers the states, and adds what
// runtime/device/engines/Machine.h calls:
//
//   func @rtsl_run_state(%state: i32, %object, %frame) -> i32   runs a state, returns the next transition
//   func @rtsl_frame_size(%chain: i32) -> i32                   bytes of the largest frame
//   func @rtsl_calls() -> i32                                   whether some state calls a function on its own frame
//   func @rtsl_rt_Material_shade_first() -> i32                 the first state of an entry point
//   func @rtsl_rays_sent(%kind: i32) -> i32                     the data that bounds the stack (RayGraph.h)
//   func @rtsl_rays_kept(%part: i32) -> i32                     the state that waiting rays read later (KeptState.h)
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Separate.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/states/KeptState.h"
#include "codegen/passes/continuation/states/RayGraph.h"
#include "codegen/passes/continuation/states/Steps.h"
#include "runtime/device/ray/Abi.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"
#include "llvm/ADT/StringMap.h"

#include <algorithm>
#include <map>

namespace rtsl::continuation {

namespace arith = mlir::arith;

namespace {

/// Whether rays carry a payload: 1, some do not; 2, some do (runtime/device/engines/KeptState.h).
std::uint32_t payloadsOf(const RayGraph &rays) {
  const std::size_t generate = rays.hasGenerate ? rays.kinds.size() - 1 : rays.kinds.size();
  std::uint32_t sent = rays.hasGenerate ? 0 : 1; // the camera's
  for (const RayGraph::Kind &kind : rays.kinds)
    sent |= kind.sent | kind.sentLast;
  if (rays.kinds.size() == 1 || generate == 0) // only rays without payloads, or unknown ones
    return rays.kinds.front().name == "color" ? 1 : 3;
  return (sent & 1 ? 1u : 0u) | (sent & ~1u ? 2u : 0u);
}

class Dispatcher {
public:
  explicit Dispatcher(mlir::ModuleOp module) : module(module), builder(module.getContext()) {}
  mlir::LogicalResult run();

private:
  void dropUncalled();
  mlir::LogicalResult passFrame(FuncOp state);
  mlir::Value address(mlir::Location location, mlir::Value frame, std::uint32_t offset,
                      mlir::Type type);
  void expand(ir::FrameLoadOp load, mlir::Value frame);
  void expand(ir::FrameStoreOp store, mlir::Value frame);
  mlir::LogicalResult expand(ir::EnterOp call, mlir::Value frame, std::uint32_t frameSize);
  void expand(ir::CallReturnedOp returned, mlir::Value frame, std::uint32_t frameSize);
  void expand(ir::LeaveOp leave, mlir::Value frame);
  void keep(mlir::Value value, mlir::Value frame, std::uint32_t offset);
  mlir::Value loadFrom(mlir::Location location, mlir::Value frame, std::uint32_t offset,
                       mlir::Type type);
  mlir::LogicalResult number(ir::NextOp next);
  FuncOp makeFunction(llvm::StringRef name, llvm::ArrayRef<mlir::Type> inputs);
  FuncOp makeConstant(llvm::StringRef name, std::int32_t value);
  FuncOp makeTable(llvm::StringRef name, llvm::ArrayRef<std::uint32_t> values);
  void makeFrameSize();
  void makeRunState();

  mlir::Value constant(mlir::Location location, std::int32_t value) {
    return arith::ConstantOp::create(builder, location, builder.getI32IntegerAttr(value));
  }

  mlir::ModuleOp module;
  mlir::OpBuilder builder;
  std::vector<FuncOp> states;
  llvm::StringMap<std::int32_t> numbers;
  std::vector<std::uint32_t> areas; // of frames, by the longest chain of references
  bool hasCalls = false;
};

mlir::Value Dispatcher::address(mlir::Location location, mlir::Value frame, std::uint32_t offset,
                                mlir::Type type) {
  return ir::FrameSlotOp::create(builder, location, ir::PtrType::get(type), frame, offset);
}

/// A bool is bit `bit` of its word.
void Dispatcher::expand(ir::FrameLoadOp load, mlir::Value frame) {
  builder.setInsertionPoint(load);
  mlir::Location location = load.getLoc();
  mlir::Type type = load.getResult().getType();
  bool isBit = load.getBit().has_value();
  mlir::Value slot =
      address(location, frame, load.getOffset(), isBit ? builder.getI32Type() : type);
  mlir::Value value = ir::LoadOp::create(builder, location, slot);
  if (isBit) {
    mlir::Value mask = constant(location, static_cast<std::int32_t>(1u << *load.getBit()));
    mlir::Value masked = arith::AndIOp::create(builder, location, value, mask);
    value = arith::CmpIOp::create(builder, location, arith::CmpIPredicate::ne, masked,
                                  constant(location, 0));
  }
  load.getResult().replaceAllUsesWith(value);
  load.erase();
}

void Dispatcher::expand(ir::FrameStoreOp store, mlir::Value frame) {
  builder.setInsertionPoint(store);
  mlir::Location location = store.getLoc();
  mlir::Value value = store.getValue();
  bool isBit = store.getBit().has_value();
  mlir::Value slot =
      address(location, frame, store.getOffset(), isBit ? builder.getI32Type() : value.getType());
  if (isBit) {
    std::int32_t mask = static_cast<std::int32_t>(1u << *store.getBit());
    mlir::Value word = ir::LoadOp::create(builder, location, slot);
    mlir::Value set = arith::OrIOp::create(builder, location, word, constant(location, mask));
    mlir::Value cleared = arith::AndIOp::create(builder, location, word, constant(location, ~mask));
    value = arith::SelectOp::create(builder, location, value, set, cleared);
  }
  ir::StoreOp::create(builder, location, value, slot);
  store.erase();
}

//===----------------------------------------------------------------------===//
// Calls with a frame of their own
//===----------------------------------------------------------------------===//

void Dispatcher::keep(mlir::Value value, mlir::Value frame, std::uint32_t offset) {
  mlir::Location location = value.getLoc();
  if (llvm::isa<ir::PtrType>(value.getType()))
    ir::KeepAddressOp::create(builder, location, value,
                              address(location, frame, offset, builder.getI32Type()));
  else
    ir::StoreOp::create(builder, location, value,
                        address(location, frame, offset, value.getType()));
}

mlir::Value Dispatcher::loadFrom(mlir::Location location, mlir::Value frame, std::uint32_t offset,
                                 mlir::Type type) {
  if (llvm::isa<ir::PtrType>(type))
    return ir::KeptAddressOp::create(builder, location, type,
                                     address(location, frame, offset, builder.getI32Type()));
  return ir::LoadOp::create(builder, location, address(location, frame, offset, type));
}

/// The callee's frame begins at the end of this one.
mlir::LogicalResult Dispatcher::expand(ir::EnterOp call, mlir::Value frame,
                                       std::uint32_t frameSize) {
  builder.setInsertionPoint(call);
  mlir::Location location = call.getLoc();
  const std::int32_t resume = numbers.lookup(call.getResume().value_or(""));
  if (resume == 0)
    return call.emitOpError() << "resumes in `" << call.getResume().value_or("")
                              << "`, which is no state";
  auto state = call->getParentOfType<FuncOp>();
  mlir::Value own = objectOf(state);
  if (!own)
    own =
        ir::NullRefOp::create(builder, location, ir::RefType::get(builder.getContext(), "object"));
  keep(constant(location, resume), frame, frameSize + RTSL_CALL_RESUME);
  keep(own, frame, frameSize + RTSL_CALL_OBJECT);
  keep(constant(location, static_cast<std::int32_t>(frameSize)), frame,
       frameSize + RTSL_CALL_BELOW);
  mlir::OperandRange arguments = call.getOperands();
  mlir::Value object = own;
  if (arguments.size() > call.getOffsets().size()) {
    object = arguments.front();
    arguments = arguments.drop_front();
  }
  for (auto [value, offset] : llvm::zip(arguments, call.getOffsets()))
    keep(value, frame, frameSize + static_cast<std::uint32_t>(offset));
  ir::MoveFrameOp::create(builder, location,
                          constant(location, static_cast<std::int32_t>(frameSize)), object);
  call.erase();
  return mlir::success();
}

void Dispatcher::expand(ir::CallReturnedOp returned, mlir::Value frame, std::uint32_t frameSize) {
  builder.setInsertionPoint(returned);
  for (auto [result, offset] : llvm::zip(returned.getResults(), returned.getOffsets()))
    result.replaceAllUsesWith(loadFrom(returned.getLoc(), frame,
                                       frameSize + static_cast<std::uint32_t>(offset),
                                       result.getType()));
  returned.erase();
}

void Dispatcher::expand(ir::LeaveOp leave, mlir::Value frame) {
  builder.setInsertionPoint(leave);
  mlir::Location location = leave.getLoc();
  mlir::Value below = loadFrom(location, frame, RTSL_CALL_BELOW, builder.getI32Type());
  mlir::Value down = arith::SubIOp::create(builder, location, constant(location, 0), below);
  mlir::Value object =
      loadFrom(location, frame, RTSL_CALL_OBJECT, ir::RefType::get(builder.getContext(), "object"));
  ir::MoveFrameOp::create(builder, location, down, object);
  leave.erase();
}

mlir::LogicalResult Dispatcher::passFrame(FuncOp state) {
  mlir::Type frameType = ir::PtrType::get(builder.getI32Type());
  (void)state.insertArgument(state.getNumArguments(), frameType, {}, state.getLoc());
  mlir::Value frame = state.getArgument(state.getNumArguments() - 1);
  std::uint32_t frameSize = 0; // as its callees use it: addresses take eight bytes
  if (auto size = ir::attr::frameSize.of(state))
    frameSize = (static_cast<std::uint32_t>(size.getInt()) + 7) / 8 * 8;
  bool isFine = true;
  state.walk([&](mlir::Operation *op) {
    if (auto call = llvm::dyn_cast<ir::EnterOp>(op)) {
      hasCalls = true;
      isFine &= mlir::succeeded(expand(call, frame, frameSize));
    } else if (auto returned = llvm::dyn_cast<ir::CallReturnedOp>(op)) {
      expand(returned, frame, frameSize);
    } else if (auto leave = llvm::dyn_cast<ir::LeaveOp>(op)) {
      expand(leave, frame);
    } else if (auto argument = llvm::dyn_cast<ir::CallArgumentOp>(op)) {
      builder.setInsertionPoint(argument);
      argument.replaceAllUsesWith(
          loadFrom(argument.getLoc(), frame, argument.getOffset(), argument.getType()));
      argument.erase();
    } else if (auto result = llvm::dyn_cast<ir::CallResultOp>(op)) {
      builder.setInsertionPoint(result);
      keep(result.getValue(), frame, result.getOffset());
      result.erase();
    } else if (auto load = llvm::dyn_cast<ir::FrameLoadOp>(op)) {
      expand(load, frame);
    } else if (auto store = llvm::dyn_cast<ir::FrameStoreOp>(op)) {
      expand(store, frame);
    } else if (auto object = llvm::dyn_cast<ir::FrameObjectOp>(op)) {
      builder.setInsertionPoint(object);
      mlir::Type type = llvm::cast<ir::PtrType>(object.getType()).getPointee();
      object.replaceAllUsesWith(address(object.getLoc(), frame, object.getOffset(), type));
      object.erase();
    } else if (llvm::isa<ir::TraceReturnedOp>(op)) {
      op->erase();
    } else if (auto end = llvm::dyn_cast<ir::EndOp>(op)) {
      builder.setInsertionPoint(end);
      mlir::func::ReturnOp::create(builder, end.getLoc(), end.getNext());
      end.erase();
    }
  });
  return mlir::success(isFine);
}

mlir::LogicalResult Dispatcher::number(ir::NextOp next) {
  std::int32_t value = next.getTransition() == ir::Transition::Last ? RTSL_NEXT_LAST : 0;
  if (next.getState()) {
    value = numbers.lookup(*next.getState());
    if (value == 0)
      return next.emitOpError() << "names `" << *next.getState() << "`, which is not a state";
    if (next.getTransition() == ir::Transition::Jump)
      value = -value;
  }
  builder.setInsertionPoint(next);
  if (next.getTransition() == ir::Transition::Return) {
    mlir::Value frame = next->getParentOfType<FuncOp>().getArguments().back();
    mlir::Value resume = loadFrom(next.getLoc(), frame, RTSL_CALL_RESUME, builder.getI32Type());
    next.replaceAllUsesWith(
        arith::SubIOp::create(builder, next.getLoc(), constant(next.getLoc(), 0), resume)
            .getResult());
  } else {
    next.replaceAllUsesWith(constant(next.getLoc(), value));
  }
  next.erase();
  return mlir::success();
}

FuncOp Dispatcher::makeFunction(llvm::StringRef name, llvm::ArrayRef<mlir::Type> inputs) {
  builder.setInsertionPointToEnd(module.getBody());
  auto function = FuncOp::create(builder, builder.getUnknownLoc(), name,
                                 builder.getFunctionType(inputs, {builder.getI32Type()}));
  ir::attr::exported.set(function);
  builder.setInsertionPointToEnd(function.addEntryBlock());
  return function;
}

FuncOp Dispatcher::makeConstant(llvm::StringRef name, std::int32_t value) {
  FuncOp function = makeFunction(name, {});
  mlir::Location location = builder.getUnknownLoc();
  mlir::func::ReturnOp::create(builder, location, constant(location, value));
  return function;
}

/// @name(%index: i32) -> i32: one of the values; 0 if the index is out of range.
FuncOp Dispatcher::makeTable(llvm::StringRef name, llvm::ArrayRef<std::uint32_t> values) {
  mlir::Location location = builder.getUnknownLoc();
  FuncOp function = makeFunction(name, {builder.getI32Type()});
  mlir::Block *entry = &function.getBody().front();
  mlir::Block *end = function.addBlock();
  mlir::Value value = end->addArgument(builder.getI32Type(), location);
  builder.setInsertionPointToEnd(end);
  mlir::func::ReturnOp::create(builder, location, value);
  builder.setInsertionPointToEnd(entry);
  llvm::SmallVector<std::int32_t> indices;
  llvm::SmallVector<mlir::Value> constants;
  for (auto [index, one] : llvm::enumerate(values)) {
    indices.push_back(static_cast<std::int32_t>(index));
    constants.push_back(constant(location, static_cast<std::int32_t>(one)));
  }
  mlir::Value none = constant(location, 0);
  llvm::SmallVector<mlir::Block *> blocks(indices.size(), end);
  llvm::SmallVector<mlir::ValueRange> operands(constants.begin(), constants.end());
  mlir::cf::SwitchOp::create(builder, location, entry->getArgument(0), end, mlir::ValueRange(none),
                             llvm::ArrayRef<std::int32_t>(indices), blocks, operands);
  return function;
}

/// @rtsl_frame_size(%chain: i32) -> i32: beyond the table, the last difference is added for each
/// index.
void Dispatcher::makeFrameSize() {
  mlir::Location location = builder.getUnknownLoc();
  auto asInt = [](std::uint32_t value) { return static_cast<std::int32_t>(value); };
  if (areas.size() < 2) {
    FuncOp function = makeFunction("rtsl_frame_size", {builder.getI32Type()});
    (void)function;
    mlir::func::ReturnOp::create(builder, location,
                                 constant(location, areas.empty() ? 0 : asInt(areas.back())));
    return;
  }
  FuncOp table = makeTable("rtsl_frame_area", areas);
  table.setPrivate();
  ir::attr::exported.removeFrom(table);
  FuncOp function = makeFunction("rtsl_frame_size", {builder.getI32Type()});
  mlir::Value chain = function.getArgument(0), last = constant(location, asInt(areas.size() - 1));
  mlir::Value isLong =
      arith::CmpIOp::create(builder, location, arith::CmpIPredicate::ugt, chain, last);
  mlir::Value index = arith::SelectOp::create(builder, location, isLong, last, chain);
  mlir::Value known =
      mlir::func::CallOp::create(builder, location, table, mlir::ValueRange(index)).getResult(0);
  mlir::Value further = arith::SubIOp::create(builder, location, chain, index);
  mlir::Value more =
      arith::MulIOp::create(builder, location, further,
                            constant(location, asInt(areas.back() - areas[areas.size() - 2])));
  mlir::func::ReturnOp::create(
      builder, location, mlir::ValueRange(arith::AddIOp::create(builder, location, known, more)));
}

/// A switch over all states. Any other number ends the method.
void Dispatcher::makeRunState() {
  mlir::Location location = builder.getUnknownLoc();
  mlir::Type object = ir::RefType::get(builder.getContext(), "object");
  FuncOp function = makeFunction(
      "rtsl_run_state", {builder.getI32Type(), object, ir::PtrType::get(builder.getI32Type())});
  mlir::Block *entry = &function.getBody().front();

  mlir::Block *none = function.addBlock();
  builder.setInsertionPointToEnd(none);
  mlir::func::ReturnOp::create(builder, location, constant(location, 0));
  llvm::SmallVector<std::int32_t> values;
  llvm::SmallVector<mlir::Block *> blocks;
  for (auto [index, state] : llvm::enumerate(states)) {
    mlir::Block *block = function.addBlock();
    builder.setInsertionPointToEnd(block);
    llvm::SmallVector<mlir::Value> arguments;
    if (mlir::Value own = objectOf(state))
      arguments.push_back(
          builder.createOrFold<ir::CastRefOp>(location, own.getType(), entry->getArgument(1)));
    arguments.push_back(entry->getArgument(2));
    auto call = mlir::func::CallOp::create(builder, location, state, arguments);
    mlir::func::ReturnOp::create(builder, location, call.getResults());
    values.push_back(static_cast<std::int32_t>(index) + 1);
    blocks.push_back(block);
  }
  builder.setInsertionPointToEnd(entry);
  llvm::SmallVector<mlir::ValueRange> noOperands(blocks.size());
  mlir::cf::SwitchOp::create(builder, location, entry->getArgument(0), none, mlir::ValueRange{},
                             llvm::ArrayRef<std::int32_t>(values), blocks, noOperands);
}

/// Methods that trace but have no callers and no states, kept by --keep, cannot run on the machine.
void Dispatcher::dropUncalled() {
  llvm::SmallVector<FuncOp> uncalled;
  do {
    for (FuncOp function : uncalled)
      function.erase();
    uncalled.clear();
    for (FuncOp function : module.getOps<FuncOp>()) {
      const bool traces = function
                              .walk([](mlir::Operation *op) {
                                return llvm::isa<ir::TraceOp, ir::TracePayloadOp>(op)
                                           ? mlir::WalkResult::interrupt()
                                           : mlir::WalkResult::advance();
                              })
                              .wasInterrupted();
      if (traces && !ir::attr::state.isOn(function) &&
          mlir::SymbolTable::symbolKnownUseEmpty(function, module))
        uncalled.push_back(function);
    }
  } while (!uncalled.empty());
}

mlir::LogicalResult Dispatcher::run() {
  dropUncalled();
  const RayGraph rays = findRays(module);
  const KeptState kept = findKeptState(module);
  std::map<std::string, std::int32_t> entries;
  for (llvm::StringRef name : machineEntries())
    entries[name.str() + "_first"] = 0;
  for (FuncOp state : module.getOps<FuncOp>()) {
    if (!ir::attr::state.isOn(state))
      continue;
    unsigned ownArguments = objectOf(state) ? 1 : 0;
    if (state.getNumArguments() != ownArguments)
      return state.emitError()
             << "`" << state.getSymName()
             << "` has parameters besides its object, which the machine cannot pass";
    states.push_back(state);
    std::int32_t number = states.size();
    numbers[state.getSymName()] = number;
    if (auto entry = ir::attr::entry.of(state))
      entries[(entry.getValue() + "_first").str()] = number;
  }
  areas = frameAreas(module);
  for (FuncOp state : states) {
    if (mlir::failed(passFrame(state)))
      return mlir::failure();
    llvm::SmallVector<ir::NextOp> nexts;
    state.walk([&](ir::NextOp next) { nexts.push_back(next); });
    for (ir::NextOp next : nexts)
      if (mlir::failed(number(next)))
        return mlir::failure();
  }
  ir::keepSeparateIfMany(states);
  makeRunState();
  makeFrameSize();
  makeConstant("rtsl_calls", hasCalls);
  const auto tellOfScene = [&](FuncOp function) { ir::attr::factOfScene.set(function); };
  for (const auto &[name, number] : entries)
    tellOfScene(makeConstant(name, number));
  llvm::SmallVector<std::uint32_t> sent, sentLast;
  for (const RayGraph::Kind &kind : rays.kinds) {
    sent.push_back(kind.sent);
    sentLast.push_back(kind.sentLast);
  }
  tellOfScene(makeConstant("rtsl_ray_kinds", static_cast<std::int32_t>(rays.kinds.size())));
  tellOfScene(makeTable("rtsl_rays_sent", sent));
  tellOfScene(makeTable("rtsl_rays_sent_last", sentLast));
  const auto low = static_cast<std::uint32_t>(kept.fields),
             high = static_cast<std::uint32_t>(kept.fields >> 32);
  tellOfScene(makeTable("rtsl_rays_kept", {low, high, kept.attributes, payloadsOf(rays)}));
  tellOfScene(makeConstant("rtsl_rays_wait_once", rays.waitsOnce));
  return mlir::success();
}

} // namespace

mlir::LogicalResult makeDispatch(mlir::ModuleOp module) {
  return Dispatcher(module).run();
}

} // namespace rtsl::continuation
