//===- DropUnreached.cpp - erase methods that are never run ---------------===//
//
// A method runs if another one calls it, if some method sends a ray that runs it, if the engine
// calls it, or if the output that it computes of a hit is read. From the methods that every sample
// runs, this follows all of these; the rest is erased. Later steps (types of rays, attributes,
// outputs required) consider only the methods that remain.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/link/CallGraph.h"
#include "codegen/link/steps/Steps.h"
#include "codegen/passes/errors/DeriveHitErrors.h"

#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/StringExtras.h"
#include "llvm/ADT/StringSet.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace rtsl::linking {

namespace {

using mlir::func::FuncOp;

/// The reason why a method runs.
struct Cause {
  std::string reason;
  ir::SourcePlace place;
};

class Reach {
public:
  explicit Reach(const LinkContext &context) : context(context) {}

  /// All functions that are reached, with the first cause found: first those reached by rendering,
  /// then those that run only while the scene is built.
  const llvm::MapVector<mlir::Operation *, Cause> &run() {
    addRoots();
    follow();
    rendering = reached.size();
    addBuildingRoots();
    follow();
    return reached;
  }

  bool isReachedByRendering(FuncOp function) const {
    const auto found = reached.find(function);
    return found != reached.end() && std::size_t(found - reached.begin()) < rendering;
  }

private:
  void follow() {
    for (; next < reached.size(); ++next)
      look(llvm::cast<FuncOp>((reached.begin() + std::ptrdiff_t(next))->first));
  }

  void add(FuncOp function, Cause cause) {
    if (function)
      reached.insert({function, std::move(cause)});
  }

  /// Adds the methods of this name of classes derived from `root`.
  void addMethods(llvm::StringRef root, const std::string &method, const Cause &cause) {
    if (!added.insert((root + " " + method).str()).second)
      return; // a function keeps its first cause
    for (const LinkedClass &linked : context.classes)
      if (linked.isMet && linked.info->root == root)
        add(findMethod(context, linked, method), cause);
  }

  void addBuildingRoots() {
    for (auto function : mlir::ModuleOp(context.ir).getOps<FuncOp>())
      if (ir::attr::constructor.isOn(function))
        add(function, {"makes the object", {}});
    addMethods("rt_Primitive", "computeBounds", {"computes the bounds of the object", {}});
  }

  void addRoots() {
    if (!context.request.isOnlySampled)
      addRootsOfRendering();
    if (context.request.isSampled)
      for (const Slot &slot : samplingSlots)
        addMethods(slot.base, slot.method, {"called by the host", {}});
  }

  void addRootsOfRendering() {
    for (auto function : mlir::ModuleOp(context.ir).getOps<FuncOp>())
      if (ir::attr::hitError.isOn(function)) // only those that are needed have been derived
        add(function, {"bounds the error of a hit", {}});
    if (context.request.engine != runtime::Engine::Programs) {
      addMethods("rt_Camera", "generateRay", {"begins every sample", {}});
      addClassicRays({"for the camera's rays", {}});
    }
    if (context.request.engine != runtime::Engine::Classic)
      addMethods("rt_RayGeneration", "generate", {"begins every sample", {}});
    addMethods("rt_Primitive", "intersect", {"finds hits", {}});
    addMethods("rt_Selector", "visit", {"decides what rays may hit", {}});
    if (context.request.features & RTSL_FEATURE_EXCEPTIONS)
      addMethods("rt_Exception", "exception", {"for samples that raise an exception", {}});
  }

  void addClassicRays(const Cause &cause) {
    addMethods("rt_Material", "shade", cause);
    addMethods("rt_Miss", "miss", cause);
  }

  void look(FuncOp function) {
    const std::string name = shownName(function);
    const Reader reader = readerOf(context.symbols, function);
    function.walk([&](mlir::Operation *op) {
      const auto by = [&](const char *does) {
        return Cause{does + (" `" + name) + "`", ir::placeOf(op->getLoc())};
      };
      if (auto call = llvm::dyn_cast<mlir::func::CallOp>(op)) {
        // a dispatch function has the cause of its callers
        const bool isDispatch = ir::attr::dispatch.isOn(function);
        add(context.function(call.getCallee()),
            isDispatch ? reached.lookup(function) : by("called by"));
      } else if (auto slot = llvm::dyn_cast<ir::CallMethodOp>(op)) { // not resolved yet
        const llvm::StringRef base =
            llvm::cast<ir::RefType>(slot.getObject().getType()).getClassName();
        if (!slots.insert((base + "." + slot.getMethod()).str()).second)
          return;
        for (const LinkedClass &linked : context.classes)
          if (linked.isUsed && derivesFrom(*linked.info, base))
            add(findMethod(context, linked, slot.getMethod().str()), by("called by"));
      } else if (llvm::isa<ir::TraceOp>(op)) {
        addClassicRays(by("for rays of"));
      } else if (auto trace = llvm::dyn_cast<ir::TracePayloadOp>(op)) {
        const auto payload = llvm::cast<ir::PtrType>(trace.getPayload().getType()).getPointee();
        const std::string type = llvm::cast<ir::StructType>(payload).getName().str();
        addMethods("rt_Material", "closestHit." + type, by("for rays of"));
        addMethods("rt_Material", "anyHit." + type, by("for rays of"));
        addMethods("rt_Miss", "miss." + type, by("for rays of"));
      } else if (llvm::isa<ir::IlluminanceOp, ir::IlluminateOp>(op)) {
        const bool isOne = llvm::isa<ir::IlluminateOp>(op);
        const char *does = isOne ? "for `illuminate` in" : "for `illuminance` in";
        if (isLitByLights(op))
          addMethods("rt_Light", "illumination", by(does));
        else
          for (const Slot &slot : surfaceSlots)
            addMethods(slot.base, slot.method, by(does));
        if (sendsRaysToLights(op) && !std::exchange(areRaysToLights, true))
          for (const auto &[slot, passing] : context.methodsThatPassLight)
            for (FuncOp method : passing)
              add(method, by(does));
      }
      if (const std::uint32_t needs = needsOf(reader, op))
        addComputations(needs, by(llvm::isa<ir::StateOp>(op) ? "read by" : "for rays of"));
    });
  }

  void addComputations(std::uint32_t needs, const Cause &cause) {
    if (needs & (RTSL_NEEDS_NORMALS | RTSL_NEEDS_FOOTPRINT))
      addMethods("rt_Primitive", "computeNormal", cause);
    if (needs & RTSL_NEEDS_TEXTURE_COORDINATES)
      addMethods("rt_Primitive", "computeTextureCoordinates", cause);
    if (needs & (RTSL_NEEDS_DERIVATIVES | RTSL_NEEDS_FOOTPRINT))
      addMethods("rt_Primitive", "computeDerivatives", cause);
    if (isOfScratchChanges(needs))
      addMethods("rt_Primitive", typed::scratchChangesMethod, cause);
    if (needs & RTSL_NEEDS_CAMERA_RAY && context.request.engine != runtime::Engine::Classic)
      addMethods("rt_Camera", "generateRay", cause);
  }

  const LinkContext &context;
  llvm::MapVector<mlir::Operation *, Cause> reached;
  std::size_t next = 0, rendering = 0;
  std::set<std::string> slots;  // unresolved slots that have been followed
  llvm::StringSet<> added;      // roots and methods
  bool areRaysToLights = false; // some have been found
};

/// "closestHit.Radiance" is started for a ray; "lookup" is not.
bool isStartedByRays(llvm::StringRef method) {
  const llvm::StringRef name = method.split('.').first;
  return name == "shade" || name == "miss" || name == "closestHit" || name == "anyHit";
}

/// Is it a method of a material that no surface has, but others refer to?
bool isOfInnerMaterial(const LinkContext &context, FuncOp function) {
  const auto name = ir::attr::className.of(function);
  return name && llvm::any_of(context.classes, [&](const LinkedClass &linked) {
           return linked.info->name == name.getValue() && linked.isUsed && !linked.isMet;
         });
}

Item itemOf(llvm::StringRef method) {
  return isStartedByRays(method) ? Item::States : Item::Methods;
}

/// Can a method be kept that nothing reaches? The machine begins samples with `generate` if there
/// is one (RayGraph.h): the engine `classic` has none.
bool canBeKept(const LinkContext &context, llvm::StringRef method) {
  return context.request.keep.has(itemOf(method)) &&
         (method != "generate" || context.request.engine != runtime::Engine::Classic);
}

/// The methods that are kept although nothing reaches them, and what they call.
llvm::SmallPtrSet<mlir::Operation *, 16>
functionsOfKept(const LinkContext &context,
                const llvm::MapVector<mlir::Operation *, Cause> &reached) {
  std::vector<FuncOp> kept;
  for (auto function : mlir::ModuleOp(context.ir).getOps<FuncOp>())
    if (const auto method = ir::attr::methodName.of(function);
        method && !reached.contains(function) && canBeKept(context, method.getValue()))
      kept.push_back(function);
  const std::vector<FuncOp> all = reachedFrom(kept, context.symbols);
  return {all.begin(), all.end()};
}

} // namespace

std::string shownName(FuncOp function) {
  auto [owner, rest] = function.getSymName().split('.');
  const auto method = ir::attr::methodName.of(function);
  std::string shown;
  if (method)
    rest = method.getValue();
  if (ir::attr::className.isOn(function)) {
    shown = owner.str() + ".";
    std::tie(owner, rest) = rest.split('.');
    if (ir::attr::hidden.isOn(function)) {
      shown += owner.str() + "::";
      std::tie(owner, rest) = rest.split('.');
    }
  }
  shown += owner.str();
  if (rest.empty())
    return shown;
  llvm::SmallVector<llvm::StringRef> parameters;
  rest.split(parameters, '.');
  return shown + "(" + llvm::join(parameters, ", ") + ")";
}

bool isLitByLights(mlir::Operation *op) {
  auto light = llvm::dyn_cast<ir::IlluminateOp>(op);
  return llvm::isa<ir::IlluminanceOp>(op) || (light && light.getIndex());
}

bool isLitBySurface(mlir::Operation *op) {
  auto light = llvm::dyn_cast<ir::IlluminateOp>(op);
  return light && !light.getIndex();
}

/// Does a function that rendering runs have such an operation?
static bool anyThatRenders(const LinkContext &context,
                           llvm::function_ref<bool(mlir::Operation *)> holds) {
  Reach reach(context);
  reach.run();
  return llvm::any_of(mlir::ModuleOp(context.ir).getOps<FuncOp>(), [&](FuncOp function) {
    return reach.isReachedByRendering(function) && ir::anyOperation(function, holds);
  });
}

bool usesLights(const LinkContext &context) {
  return anyThatRenders(context, isLitByLights);
}

bool usesSurfacesAsLights(const LinkContext &context) {
  return anyThatRenders(context, isLitBySurface);
}

void dropUnreached(LinkContext &context) {
  Reach reach(context);
  const llvm::MapVector<mlir::Operation *, Cause> reached = reach.run();
  for (auto &[name, finding] : context.dispatches)
    if (FuncOp function = context.function(name); function && reach.isReachedByRendering(function))
      context.findings.push_back(finding);
  const llvm::SmallPtrSet<mlir::Operation *, 16> ofKept = functionsOfKept(context, reached);
  for (auto function : llvm::make_early_inc_range(context.ir.getOps<FuncOp>())) {
    const auto method = ir::attr::methodName.of(function);
    const auto found = reached.find(function);
    if (method || ir::attr::hidden.isOn(function)) {
      Finding finding;
      finding.item = method ? itemOf(method.getValue()) : Item::Methods;
      finding.subject = shownName(function);
      finding.isNeeded = reach.isReachedByRendering(function);
      if (finding.isNeeded) {
        finding.reason = found->second.reason;
        finding.place = found->second.place;
      } else if (found != reached.end()) {
        finding.reason = "runs only while the scene is built";
        ir::attr::whileBuilding.set(function);
      } else {
        finding.reason = finding.item != Item::States           ? "nothing in this scene runs it"
                         : isOfInnerMaterial(context, function) ? "no surface has this material"
                                                                : "no ray of this scene starts it";
      }
      if (!finding.place.isKnown())
        finding.place = ir::placeOf(function.getLoc());
      if (finding.isNeeded && context.isWithout(finding.item, finding.subject))
        makeEmpty(function);
      const Item item = finding.item;
      context.findings.push_back(std::move(finding));
      if (found == reached.end() &&
          (method ? canBeKept(context, method.getValue()) : context.request.keep.has(item))) {
        // A function that no entry point reaches must be one itself, unless it sends rays: such
        // functions are only started by rays.
        if (item == Item::Methods && !ir::anyOperation(function, ir::sendsRays))
          ir::attr::kept.set(function);
        continue;
      }
    }
    if (found == reached.end() && !ofKept.contains(function))
      context.symbols.erase(function);
  }
}

} // namespace rtsl::linking
