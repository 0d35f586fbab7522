//===- KeptState.cpp - the state that a waiting ray keeps -----------------===//
#include "codegen/passes/continuation/states/KeptState.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/ir/Slots.h"
#include "codegen/passes/continuation/common/TracedFunctions.h"
#include "runtime/device/engines/KeptState.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "llvm/ADT/StringMap.h"
#include "llvm/ADT/StringSet.h"
#include "llvm/ADT/StringSwitch.h"
#include "llvm/ADT/TypeSwitch.h"

namespace rtsl {

namespace {

using device::KeptField;
using mlir::func::FuncOp;

/// A set of fields of the state.
struct Fields {
  std::uint64_t fields = 0;
  std::uint32_t attributes = 0;

  static Fields all() { return {(std::uint64_t(1) << device::keptFieldCount) - 1, ~0u}; }
  static Fields of(std::initializer_list<KeptField> list) {
    Fields result;
    for (KeptField field : list)
      result.fields |= std::uint64_t(1) << field;
    return result;
  }
  /// True if this added any.
  bool add(const Fields &other) {
    const Fields before = *this;
    fields |= other.fields;
    attributes |= other.attributes;
    return fields != before.fields || attributes != before.attributes;
  }
  void remove(const Fields &other) {
    fields &= ~other.fields;
    attributes &= ~other.attributes;
  }
};

KeptField fieldOf(llvm::StringRef variable) {
  return llvm::StringSwitch<KeptField>(variable)
#define RTSL_STATE_VARIABLE(name, type, ...) .Case(#name, device::kept##name)
#include "language/StateVariables.def"
      .Default(device::keptFieldCount);
}

/// Is it a state variable of type color?
bool isColor(llvm::StringRef variable) {
  return llvm::StringSwitch<bool>(variable)
#define RTSL_STATE_VARIABLE(name, type, ...) .Case(#name, llvm::StringRef(#type) == "color")
#include "language/StateVariables.def"
      .Default(false);
}

/// Fields that are the same for all rays of a sample: they stay in the state (takeFromSample in
/// runtime/device/engines/BeginRay.h).
Fields sharedByRays() {
  enum Writer : std::uint8_t { Shader, Sample, Ray };
  Fields shared;
#define RTSL_STATE_VARIABLE(name, type, writer, need, ...)                                         \
  if (writer == Sample)                                                                            \
    shared.add(Fields::of({device::kept##name}));
#include "language/StateVariables.def"
  return shared;
}

/// The fields of the state that an address points to.
Fields fieldsAt(mlir::Value address) {
  mlir::Operation *base = ir::baseOperation(address);
  if (auto state = llvm::dyn_cast_or_null<ir::StateOp>(base))
    if (const KeptField field = fieldOf(state.getName()); field != device::keptFieldCount)
      return Fields::of({field});
  if (auto attribute = llvm::dyn_cast_or_null<ir::AttributeOp>(base)) {
    if (!attribute.getOffset())
      return Fields::all();
    const auto first = static_cast<std::uint32_t>(*attribute.getOffset());
    const std::uint32_t bytes =
        ir::sizeInBytes(llvm::cast<ir::PtrType>(attribute.getType()).getPointee());
    Fields fields;
    for (std::uint32_t word = first;
         word < first + (bytes + 3) / 4 && word < RTSL_MAX_ATTRIBUTE_WORDS; ++word)
      fields.attributes |= 1u << word;
    return fields;
  }
  return {};
}

/// The fields that the runtime reads of a ray that sends another one: Classic.h, Programs.h and
/// Spawn.h.
Fields readsOfSending(mlir::ModuleOp module) {
  Fields fields = Fields::of({device::keptRandomKey, device::keptDimension, device::keptDepth,
                              device::keptInstance, device::keptHitPointError, device::keptHitPoint,
                              device::keptGeometricNormal});
  if (!ir::attr::singlePrimitives.isOn(module))
    fields.add(Fields::of({device::keptPrimitiveIndex}));
  if (ir::readsFootprints(module))
    fields.add(Fields::of({device::keptConeWidth, device::keptConeSpread}));
  return fields;
}

/// What it reads to send a ray that a shader traces, which may go straight on through surfaces
/// (passedDistance in BeginRay.h).
Fields readsOfTracing(mlir::ModuleOp module) {
  Fields fields = readsOfSending(module);
  if (!ir::attr::noPassedDistances.isOn(module))
    fields.add(Fields::of(
        {device::keptPassedDistance, device::keptHitDistance, device::keptRayDirection}));
  return fields;
}

llvm::StringRef symbolOf(FuncOp function) {
  return function ? function.getSymName() : llvm::StringRef();
}

class KeptStateFinder {
public:
  explicit KeptStateFinder(mlir::ModuleOp module);
  Fields run();

private:
  Fields implicitReads(mlir::Operation *op) const;
  Fields reads(mlir::Operation *op) const;
  Fields ofFunction(llvm::StringRef name) const;
  void summarise();
  Fields after(ir::NextOp next) const;
  Fields atEnd(FuncOp state, ir::EndOp end) const;
  bool update(FuncOp state);

  mlir::ModuleOp module;
  llvm::StringRef illumination, exception; // symbols of the entry points; empty: there is none
  bool sendsPayloads = false, hasOpenCalls = false;
  llvm::StringSet<> callers;         // states that resume after calls with frames of their own
  llvm::StringMap<Fields> functions; // read by functions, including their callees
  llvm::StringMap<Fields> live;      // at the beginnings of states
};

KeptStateFinder::KeptStateFinder(mlir::ModuleOp module)
    : module(module), illumination(symbolOf(ir::entryPoint(module, ir::slot::illumination))),
      exception(symbolOf(ir::entryPoint(module, ir::slot::exception))) {
  module.walk([&](mlir::Operation *op) {
    sendsPayloads |= llvm::isa<ir::SpawnPayloadOp>(op);
    hasOpenCalls |= llvm::isa<ir::EvaluateOp, ir::CallMethodOp>(op);
    if (auto call = llvm::dyn_cast<ir::EnterOp>(op); call && call.getResume())
      callers.insert(*call.getResume());
  });
}

/// The fields that the runtime reads to execute an operation.
Fields KeptStateFinder::implicitReads(mlir::Operation *op) const {
  Fields inherited; // by a ray that is sent; without payloads these are the same for all rays
  if (sendsPayloads)
    inherited = Fields::of({device::keptTime, device::keptRayMask, device::keptRayRoot});
  Fields fields;
  llvm::TypeSwitch<mlir::Operation *>(op)
      .Case([&](ir::SpawnOp) {
        fields = readsOfTracing(module);
        fields.add(inherited);
      })
      .Case([&](ir::SpawnPayloadOp spawn) {
        fields = readsOfTracing(module);
        if (!spawn.getTime())
          fields.add(Fields::of({device::keptTime}));
        if (!spawn.getMask())
          fields.add(Fields::of({device::keptRayMask}));
        if (!spawn.getRoot())
          fields.add(Fields::of({device::keptRayRoot}));
      })
      .Case(
          [&](ir::RandOp) { fields = Fields::of({device::keptRandomKey, device::keptDimension}); })
      .Case([&](ir::IlluminateOp) {
        fields = readsOfSending(module);
        fields.add(inherited);
        fields.add(ofFunction(illumination));
      })
      .Case([&](ir::PayloadOp) { fields = Fields::of({device::keptPayload}); })
      .Case([&](ir::RayTypeOp) { fields = Fields::of({device::keptRayType}); })
      .Case([&](mlir::func::CallOp call) { fields = ofFunction(call.getCallee()); });
  return fields;
}

/// The fields that an operation reads, directly or through calls.
Fields KeptStateFinder::reads(mlir::Operation *op) const {
  Fields fields = implicitReads(op);
  if (llvm::isa<ir::FieldOp, ir::ElementOp>(op))
    return fields; // only computes an address
  for (mlir::OpOperand &operand : op->getOpOperands()) {
    if (!llvm::isa<ir::PtrType>(operand.get().getType()))
      continue;
    auto store = llvm::dyn_cast<ir::StoreOp>(op);
    auto copy = llvm::dyn_cast<ir::CopyOp>(op);
    const bool isTarget =
        llvm::isa<ir::ClearOp>(op) || (store && operand.get() == store.getAddress()) ||
        (copy && operand.get() == copy.getTarget() && copy.getTarget() != copy.getSource());
    if (!isTarget)
      fields.add(fieldsAt(operand.get()));
  }
  return fields;
}

/// The fields that an operation overwrites completely.
Fields written(mlir::Operation *op) {
  mlir::Value address;
  if (auto store = llvm::dyn_cast<ir::StoreOp>(op))
    address = store.getAddress();
  else if (auto clear = llvm::dyn_cast<ir::ClearOp>(op))
    address = clear.getAddress();
  if (!address || !llvm::isa_and_nonnull<ir::StateOp>(address.getDefiningOp()))
    return {};
  return fieldsAt(address);
}

Fields KeptStateFinder::ofFunction(llvm::StringRef name) const {
  const auto known = functions.find(name);
  return known == functions.end() ? Fields::all() : known->second;
}

/// The fields that functions read; declared ones may read all.
void KeptStateFinder::summarise() {
  for (FuncOp function : module.getOps<FuncOp>())
    functions[function.getSymName()] = function.isExternal() ? Fields::all() : Fields();
  bool changed = true;
  while (changed) {
    changed = false;
    for (FuncOp function : module.getOps<FuncOp>()) {
      Fields &fields = functions[function.getSymName()];
      function.walk([&](mlir::Operation *op) { changed |= fields.add(reads(op)); });
    }
  }
}

/// Whether rays of the state's kind return a color, or the sample's color is theirs.
bool bringsColor(FuncOp state) {
  const auto method = ir::attr::methodName.of(state);
  const llvm::StringRef slot = ir::slotOf(state);
  return !(method && method.getValue().contains('.')) && slot != ir::slot::closestHitForPayload &&
         slot != ir::slot::missForPayload;
}

/// The fields that are live after a state with this end.
Fields KeptStateFinder::after(ir::NextOp next) const {
  Fields fields;
  if (sendsPayloads) // whether a color is returned to the sender
    fields.add(Fields::of({device::keptRayType}));
  switch (next.getTransition()) {
  case ir::Transition::Trace:
  case ir::Transition::Jump:
    fields.add(next.getState() ? live.lookup(*next.getState()) : Fields::all());
    break;
  case ir::Transition::Done:
    if (bringsColor(next->getParentOfType<FuncOp>()))
      fields.add(Fields::of({device::keptSampleColor}));
    if (!exception.empty())
      fields.add(ofFunction(exception));
    break;
  case ir::Transition::Last:
    break;
  case ir::Transition::Return:
    for (const auto &caller : callers)
      fields.add(live.lookup(caller.getKey()));
    break;
  }
  return fields;
}

Fields KeptStateFinder::atEnd(FuncOp state, ir::EndOp end) const {
  if (auto next = end.getNext().getDefiningOp<ir::NextOp>())
    return after(next);
  Fields fields; // either of several
  state.walk([&](ir::NextOp next) { fields.add(after(next)); });
  return fields;
}

/// Liveness within a state. True if fields were added to those live at its beginning.
bool KeptStateFinder::update(FuncOp state) {
  llvm::DenseMap<mlir::Block *, Fields> liveIn;
  bool changed = true;
  while (changed) {
    changed = false;
    for (mlir::Block &block : llvm::reverse(state.getBody())) {
      Fields fields;
      for (mlir::Block *successor : block.getSuccessors())
        fields.add(liveIn.lookup(successor));
      for (mlir::Operation &op : llvm::reverse(block)) {
        if (auto end = llvm::dyn_cast<ir::EndOp>(op))
          fields.add(atEnd(state, end));
        fields.remove(written(&op));
        fields.add(reads(&op));
      }
      changed |= liveIn[&block].add(fields);
    }
  }
  return live[state.getSymName()].add(liveIn.lookup(&state.getBody().front()));
}

Fields KeptStateFinder::run() {
  Fields kept;
  if (hasOpenCalls) {
    kept = Fields::all();
  } else {
    summarise();
    llvm::SmallVector<FuncOp> states;
    for (FuncOp function : module.getOps<FuncOp>())
      if (ir::attr::state.isOn(function))
        states.push_back(function);
    bool changed = true;
    while (changed) {
      changed = false;
      for (FuncOp state : llvm::reverse(states))
        changed |= update(state);
    }
    module.walk([&](ir::NextOp next) {
      if (next.getTransition() == ir::Transition::Trace && next.getState())
        kept.add(live.lookup(*next.getState()));
    });
  }
  kept.remove(sharedByRays());
  return kept;
}

} // namespace

std::uint32_t KeptState::words(std::uint32_t colorComponents) const {
  std::uint32_t count = 0;
  for (std::uint32_t field = 0; field < device::keptFieldCount; ++field)
    if (fields >> field & 1)
      count += device::wordsOf(static_cast<KeptField>(field), colorComponents);
  return count + static_cast<std::uint32_t>(llvm::popcount(attributes));
}

KeptState findKeptState(mlir::ModuleOp module) {
  const Fields fields = KeptStateFinder(module).run();
  return {fields.fields, fields.attributes};
}

std::uint32_t colorComponentsOf(mlir::ModuleOp module) {
  std::uint32_t components = 3;
  module.walk([&](mlir::Operation *op) {
    mlir::Type type;
    if (auto result = llvm::dyn_cast<ir::TraceResultOp>(op))
      type = result.getType();
    else if (auto state = llvm::dyn_cast<ir::StateOp>(op); state && isColor(state.getName()))
      type = llvm::cast<ir::PtrType>(state.getType()).getPointee();
    auto vector = llvm::dyn_cast_or_null<mlir::VectorType>(type);
    if (!vector)
      return mlir::WalkResult::advance();
    components = static_cast<std::uint32_t>(vector.getNumElements());
    return mlir::WalkResult::interrupt();
  });
  return components;
}

} // namespace rtsl
