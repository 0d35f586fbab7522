//===- Dispatch.cpp - from states to a state machine ----------------------===//
//
// Makes the frame a parameter (PassFrame.h), numbers the states, and adds the functions that
// runtime/device/engines/Machine.h calls:
//
//   func @rtsl_run_state(%state: i32, %object, %frame) -> i32  runs a state, returns the next
//   func @rtsl_frame_size(%chain: i32) -> i32                  bytes of the largest frame
//   func @rtsl_calls() -> i32                                  whether a state calls a function
//   func @rtsl_rt_Material_shade_first() -> i32                the first state of an entry point
//   func @rtsl_first_state(%state: i32, %object) -> i32        that it jumps to (FirstStates.h)
//   func @rtsl_rays_sent(%kind: i32) -> i32                    what bounds the stack (RayGraph.h)
//   func @rtsl_rays_kept(%part: i32) -> i32                    what waiting rays read (KeptState.h)
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Separate.h"
#include "codegen/ir/Slots.h"
#include "codegen/passes/continuation/calls/Steps.h"
#include "codegen/passes/continuation/states/FirstStates.h"
#include "codegen/passes/continuation/states/KeptState.h"
#include "codegen/passes/continuation/states/PassFrame.h"
#include "codegen/passes/continuation/states/RayGraph.h"
#include "codegen/passes/continuation/states/Steps.h"
#include "runtime/device/ray/Abi.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/ControlFlow/IR/ControlFlowOps.h"

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

/// States with a smaller number run first, so that those of rays that end come before those that
/// wait for them: the entry points, then the beginnings of methods, and so on.
std::int64_t turnOf(FuncOp state) {
  return ir::attr::entry.isOn(state) ? -1 : ir::attr::state.of(state).getInt();
}

class Dispatcher {
public:
  explicit Dispatcher(mlir::ModuleOp module)
      : module(module), symbols(module), builder(module.getContext()) {}
  mlir::LogicalResult run();

private:
  void dropUncalled();
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
  mlir::SymbolTable symbols;
  mlir::OpBuilder builder;
  std::vector<FuncOp> states;
  StateNumbers numbers;
  std::vector<std::uint32_t> areas; // of frames, by the longest chain of references
  bool hasCalls = false;
};

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
    mlir::Value slot = ir::FrameSlotOp::create(
        builder, next.getLoc(), ir::PtrType::get(builder.getI32Type()), frame, RTSL_CALL_RESUME);
    mlir::Value resume = ir::LoadOp::create(builder, next.getLoc(), slot);
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
  ir::insertForRuntime(symbols, function);
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
  llvm::SmallVector<mlir::Attribute> names;
  for (FuncOp state : states)
    names.push_back(state.getSymNameAttr());
  ir::attr::runsStates.set(function, builder.getArrayAttr(names));
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

/// Methods that trace but have no states cannot run on the machine. No state calls them: they are
/// kept by --keep, and may call each other.
void Dispatcher::dropUncalled() {
  for (FuncOp function : tracingFunctions(module))
    if (!ir::attr::state.isOn(function))
      symbols.erase(function);
}

mlir::LogicalResult Dispatcher::run() {
  dropUncalled();
  const RayGraph rays = findRays(module);
  const KeptState kept = findKeptState(module);
  const std::map<std::string, std::string> firstStates = findFirstStates(module);
  for (FuncOp state : module.getOps<FuncOp>()) {
    if (!ir::attr::state.isOn(state))
      continue;
    unsigned ownArguments = objectOf(state) ? 1 : 0;
    if (state.getNumArguments() != ownArguments)
      return state.emitError()
             << "`" << state.getSymName()
             << "` has parameters besides its object, which the machine cannot pass";
    states.push_back(state);
  }
  llvm::stable_sort(states, [](FuncOp left, FuncOp right) { return turnOf(left) < turnOf(right); });
  for (auto [index, state] : llvm::enumerate(states))
    numbers[state.getSymName()] = static_cast<std::int32_t>(index) + 1;
  FuncOp firstState = makeFirstState(module, states, numbers);
  ir::insertForRuntime(symbols, firstState);
  ir::attr::exported.set(firstState);
  areas = frameAreas(module);
  for (FuncOp state : states) {
    state.walk([&](ir::EnterOp) { hasCalls = true; });
    if (mlir::failed(passFrame(state, numbers)))
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
  const auto markAsFact = [&](FuncOp function) { ir::attr::factOfScene.set(function); };
  for (const auto &[entry, state] : firstStates)
    markAsFact(makeConstant(entry + "_first", numbers.lookup(state)));
  llvm::SmallVector<std::uint32_t> sent, sentLast;
  for (const RayGraph::Kind &kind : rays.kinds) {
    sent.push_back(kind.sent);
    sentLast.push_back(kind.sentLast);
  }
  markAsFact(makeConstant("rtsl_ray_kinds", static_cast<std::int32_t>(rays.kinds.size())));
  markAsFact(makeTable("rtsl_rays_sent", sent));
  markAsFact(makeTable("rtsl_rays_sent_last", sentLast));
  const auto low = static_cast<std::uint32_t>(kept.fields),
             high = static_cast<std::uint32_t>(kept.fields >> 32);
  markAsFact(makeTable("rtsl_rays_kept", {low, high, kept.attributes, payloadsOf(rays)}));
  markAsFact(makeConstant("rtsl_rays_wait_once", rays.waitsOnce));
  markAsFact(makeConstant("rtsl_rays_replace", rays.replace));
  return mlir::success();
}

} // namespace

mlir::LogicalResult makeDispatch(mlir::ModuleOp module) {
  return Dispatcher(module).run();
}

} // namespace rtsl::continuation
