//===- RayGraph.cpp - which rays send which -------------------------------===//
#include "codegen/passes/continuation/states/RayGraph.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/ir/Slots.h"
#include "codegen/passes/continuation/common/TracedFunctions.h"
#include "runtime/device/engines/StackBound.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "llvm/ADT/StringMap.h"

#include <algorithm>

namespace rtsl {

namespace {

class RayFinder {
public:
  explicit RayFinder(mlir::ModuleOp module) : module(module) { graph.kinds.push_back({"color"}); }
  RayGraph run();

private:
  void numberPayloads();
  std::uint32_t payload(llvm::StringRef name, std::optional<std::uint32_t> number);
  std::uint32_t allPayloads() const;
  std::uint32_t kindsOf(mlir::func::FuncOp state) const;
  void findCallers();
  void addRays(mlir::func::FuncOp state);
  bool waitsOnce();
  bool raysReplace();

  mlir::ModuleOp module;
  RayGraph graph;
  /// The kinds of rays that may run a function with a frame of its own: those of its callers.
  llvm::StringMap<std::uint32_t> kindsOfCallers;
};

llvm::StringRef payloadName(ir::SpawnPayloadOp spawn) {
  mlir::Type type = llvm::cast<ir::PtrType>(spawn.getPayload().getType()).getPointee();
  return llvm::cast<ir::StructType>(type).getName();
}

bool isState(mlir::func::FuncOp function) {
  return ir::attr::state.isOn(function);
}

/// The kind of rays with this payload: its number in a linked program, otherwise the next one.
std::uint32_t RayFinder::payload(llvm::StringRef name, std::optional<std::uint32_t> number) {
  auto known = std::find_if(graph.kinds.begin() + 1, graph.kinds.end(),
                            [&](const RayGraph::Kind &kind) { return kind.name == name; });
  if (!number && known != graph.kinds.end())
    return known - graph.kinds.begin();
  const std::uint32_t kind = number.value_or(graph.kinds.size());
  if (graph.kinds.size() <= kind)
    graph.kinds.resize(kind + 1);
  graph.kinds[kind].name = name.str();
  return kind;
}

void RayFinder::numberPayloads() {
  for (auto state : module.getOps<mlir::func::FuncOp>())
    if (isState(state))
      state.walk(
          [&](ir::SpawnPayloadOp spawn) { payload(payloadName(spawn), spawn.getRayType()); });
}

std::uint32_t RayFinder::allPayloads() const {
  const std::uint32_t end = graph.kinds.size() - (graph.hasGenerate ? 1 : 0);
  return ((1ull << end) - 1) & ~1ull;
}

void RayFinder::findCallers() {
  bool changed = true;
  while (changed) {
    changed = false;
    for (auto state : module.getOps<mlir::func::FuncOp>())
      if (isState(state))
        state.walk([&](ir::EnterOp call) {
          std::uint32_t &known = kindsOfCallers[call.getCallee()];
          const std::uint32_t before = known;
          known |= kindsOf(state);
          changed |= known != before;
        });
  }
}

/// The kinds of rays that may run this state, as bits.
std::uint32_t RayFinder::kindsOf(mlir::func::FuncOp state) const {
  if (continuation::isFramed(state))
    return kindsOfCallers.lookup(state.getSymName().rsplit(".state").first);
  llvm::StringRef method;
  if (auto name = ir::attr::methodName.of(state))
    method = name.getValue();
  const auto [base, suffix] = method.split('.');
  if (!suffix.empty()) {
    for (std::size_t kind = 1; kind < graph.kinds.size(); ++kind)
      if (graph.kinds[kind].name == suffix)
        return 1u << kind;
    return 0; // such rays are never sent
  }
  if (base == "shade" || base == "miss")
    return 1;
  if (isOfGenerate(state))
    return 1u << (graph.kinds.size() - 1);
  // A method that has been inlined into its entry point.
  const llvm::StringRef slot = ir::slotOf(state);
  if (slot == ir::slot::shade || slot == ir::slot::miss)
    return 1;
  return !slot.empty() || ir::attr::dispatch.isOn(state) ? allPayloads() : 0;
}

void RayFinder::addRays(mlir::func::FuncOp state) {
  std::uint32_t sent = 0, sentLast = 0;
  auto add = [&](std::uint32_t kind, bool isLast) { (isLast ? sentLast : sent) |= 1u << kind; };
  state.walk([&](mlir::Operation *op) {
    if (auto spawn = llvm::dyn_cast<ir::SpawnOp>(op))
      add(0, spawn.getLast());
    else if (auto spawn = llvm::dyn_cast<ir::SpawnPayloadOp>(op))
      add(payload(payloadName(spawn), spawn.getRayType()), spawn.getLast());
  });
  const std::uint32_t from = kindsOf(state);
  for (std::size_t kind = 0; kind < graph.kinds.size(); ++kind)
    if (from >> kind & 1) {
      graph.kinds[kind].sent |= sent;
      graph.kinds[kind].sentLast |= sentLast;
    }
}

bool RayFinder::waitsOnce() {
  const std::size_t generate = graph.hasGenerate ? graph.kinds.size() - 1 : graph.kinds.size();
  for (std::size_t kind = 0; kind < graph.kinds.size(); ++kind)
    if (graph.kinds[kind].sent != 0 && kind != generate)
      return false;
  const bool noneWaits =
      llvm::all_of(graph.kinds, [](const RayGraph::Kind &kind) { return kind.sent == 0; });
  for (mlir::func::FuncOp state : module.getOps<mlir::func::FuncOp>()) {
    bool hasCalls = false, hasFrame = false;
    if (isState(state))
      state.walk([&](mlir::Operation *op) {
        hasCalls |= llvm::isa<ir::EnterOp, ir::LeaveOp>(op);
        hasFrame |= llvm::isa<ir::FrameLoadOp, ir::FrameStoreOp, ir::FrameObjectOp>(op);
      });
    if (hasCalls || (hasFrame && !noneWaits && !isOfGenerate(state)))
      return false;
  }
  return true;
}

bool sends(mlir::func::FuncOp state) {
  return ir::anyOperation(
      state, [](mlir::Operation *op) { return llvm::isa<ir::SpawnOp, ir::SpawnPayloadOp>(op); });
}

bool RayFinder::raysReplace() {
  auto followsTrace = [](mlir::func::FuncOp state) {
    return !ir::attr::entry.isOn(state) && ir::attr::state.of(state).getInt() > 0;
  };
  return llvm::any_of(graph.kinds, [](const RayGraph::Kind &kind) { return kind.sentLast != 0; }) &&
         llvm::none_of(module.getOps<mlir::func::FuncOp>(), [&](mlir::func::FuncOp state) {
           return isState(state) && followsTrace(state) && sends(state);
         });
}

RayGraph RayFinder::run() {
  numberPayloads();
  for (auto state : module.getOps<mlir::func::FuncOp>())
    graph.hasGenerate |= isState(state) && isOfGenerate(state);
  if (graph.hasGenerate)
    graph.kinds.push_back({"generate"});
  if (graph.kinds.size() > RTSL_MAX_RAY_KINDS) { // assume that each can send each
    graph.kinds = {{"any", 1}};
    return graph;
  }
  findCallers();
  for (auto state : module.getOps<mlir::func::FuncOp>())
    if (isState(state))
      addRays(state);
  graph.waitsOnce = waitsOnce();
  graph.replace = raysReplace();
  return graph;
}

} // namespace

std::vector<std::string> RayGraph::names(std::uint32_t set) const {
  std::vector<std::string> result;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind)
    if (set >> kind & 1)
      result.push_back(kinds[kind].name);
  return result;
}

std::uint32_t RayGraph::levels(std::uint32_t maxDepth) const {
  if (waitsOnce)
    return 1;
  return device::mostLevels(
      kinds.size(), hasGenerate, maxDepth, [&](std::uint32_t kind) { return kinds[kind].sent; },
      [&](std::uint32_t kind) { return kinds[kind].sentLast; });
}

bool RayGraph::grows() const {
  // After this many steps every cycle has been found.
  constexpr std::uint32_t far = 2 * RTSL_MAX_RAY_KINDS;
  return levels(2 * far) != levels(far);
}

bool isOfGenerate(mlir::func::FuncOp state) {
  auto method = ir::attr::methodName.of(state);
  return (method && method.getValue() == "generate") || ir::slotOf(state) == ir::slot::generate;
}

RayGraph findRays(mlir::ModuleOp module) {
  return RayFinder(module).run();
}

} // namespace rtsl
