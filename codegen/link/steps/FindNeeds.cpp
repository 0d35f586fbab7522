//===- FindNeeds.cpp - the outputs required of a hit ----------------------===//
//
// Normals, texture coordinates, derivatives and transforms cost time at every hit. Outputs that no
// function of the program reads are not computed at all; those that the methods of a material and
// of the objects it refers to do not read are not computed where that material was hit. The scene
// determines these objects (Scene.cpp).
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/link/CallGraph.h"
#include "codegen/link/steps/Steps.h"

#include "llvm/ADT/StringMap.h"
#include "llvm/ADT/StringSwitch.h"

namespace rtsl::linking {

namespace {

std::uint32_t needsOf(llvm::StringRef state) {
  constexpr std::uint32_t RTSL_NEEDS_NOTHING = 0;
  const auto needs = llvm::StringSwitch<std::uint32_t>(state)
#define RTSL_STATE_VARIABLE(name, type, writer, need, ...) .Case(#name, RTSL_NEEDS_##need)
#include "language/StateVariables.def"
                         .Default(0);
  return needs & RTSL_NEEDS_NORMAL_CHANGES ? needs | RTSL_NEEDS_FOOTPRINT : needs;
}

/// Whether the function may run for `intersect`, before the ray is known to hit the primitive;
/// outputs of the hit that it reads must then be computed for each candidate.
bool mayRunForCandidates(const Reader &reader) {
  const auto method = ir::attr::methodName.of(reader.function);
  if (method && method == typed::scratchChangesMethod)
    return false;
  return (reader.root.empty() || reader.root == "rt_Primitive" || reader.root == ir::helperRoot) &&
         !(method &&
           llvm::StringSwitch<bool>(method.getValue())
               .Cases({"computeNormal", "computeTextureCoordinates", "computeDerivatives"}, true)
               .Cases({"computeBounds", "generateSample", "samplePDF"}, true)
               .Default(false));
}

/// Whether reading this reads an output of a candidate.
bool isOfCandidate(llvm::StringRef state, const Reader &reader) {
  if (state == "BoundMin" || state == "BoundMax") {
    const auto method = ir::attr::methodName.of(reader.function);
    return !method || method != "computeBounds";
  }
  return llvm::StringSwitch<bool>(state)
             .Cases({"PrimitiveIndex", "InstanceIndex", "InstanceId"}, true)
             .Cases({"ObjectToWorld", "WorldToObject"}, true)
             .Default(false) &&
         mayRunForCandidates(reader);
}

/// Whether rays that the function sends may start at a hit. Their offset from the surface depends
/// on the normal and on the error of the hit (runtime/device/ray/Spawn.h).
bool mayStartAtHits(const Reader &reader) {
  return reader.root.empty() || reader.root == "rt_Material" || reader.root == ir::helperRoot;
}

/// Whether the function may run for `generate`, where the ray is the camera's.
bool mayRunForGenerate(const Reader &reader) {
  return reader.root.empty() || reader.root == "rt_RayGeneration" || reader.root == ir::helperRoot;
}

constexpr std::uint32_t ofRaysFromHits = RTSL_NEEDS_NORMALS | RTSL_NEEDS_HIT_ERRORS;

/// The outputs that one function reads itself.
std::uint32_t needsOf(const LinkContext &context, mlir::func::FuncOp function) {
  std::uint32_t needs = 0;
  const Reader reader = readerOf(context.symbols, function);
  function.walk([&](mlir::Operation *op) { needs |= linking::needsOf(reader, op); });
  return needs;
}

/// The outputs that functions and all their callees read. With `onItself`, calls through references
/// are ignored. `isLit`, if not null, becomes true if they use lights.
std::uint32_t needsReachedFrom(llvm::ArrayRef<mlir::func::FuncOp> functions,
                               const LinkContext &context, bool onItself, bool *isLit = nullptr) {
  std::uint32_t needs = 0;
  const auto follows = [&](mlir::func::FuncOp callee) {
    return !onItself || !ir::attr::dispatch.isOn(callee);
  };
  for (mlir::func::FuncOp function : reachedFrom(functions, context.symbols, follows)) {
    needs |= needsOf(context, function);
    if (isLit)
      *isLit |= ir::anyOperation(function, [](mlir::Operation *op) {
        return llvm::isa<ir::IlluminanceOp, ir::IlluminateOp>(op);
      });
  }
  return needs;
}

} // namespace

Reader readerOf(const mlir::SymbolTable &symbols, mlir::func::FuncOp function) {
  const auto name = ir::attr::className.of(function);
  auto owner = name ? symbols.lookup<ir::ClassOp>(name) : ir::ClassOp();
  return {function, owner ? owner.getRoot() : llvm::StringRef()};
}

bool isRead(mlir::Value address) {
  return llvm::any_of(address.getUsers(),
                      [](mlir::Operation *user) { return !mlir::isa<ir::StoreOp>(user); });
}

bool isOfScratchChanges(std::uint32_t needs) {
  return needs & RTSL_NEEDS_ATTRIBUTES && needs & RTSL_NEEDS_FOOTPRINT;
}

std::uint32_t needsOf(const Reader &reader, mlir::Operation *op) {
  if (auto state = llvm::dyn_cast<ir::StateOp>(op)) {
    if (!isRead(state))
      return 0;
    const bool isCameraRay =
        (state.getName() == "RayOrigin" || state.getName() == "RayDirection") &&
        mayRunForGenerate(reader);
    return needsOf(state.getName()) |
           (isOfCandidate(state.getName(), reader) ? RTSL_NEEDS_CANDIDATE : 0) |
           (isCameraRay ? RTSL_NEEDS_CAMERA_RAY : 0);
  }
  if (auto attribute = llvm::dyn_cast<ir::AttributeOp>(op))
    return !isRead(attribute)    ? 0
           : attribute.getAxis() ? RTSL_NEEDS_ATTRIBUTES | RTSL_NEEDS_FOOTPRINT
                                 : RTSL_NEEDS_ATTRIBUTES;
  if (auto trace = llvm::dyn_cast<ir::TracePayloadOp>(op);
      trace && trace.getHow().value_or(0) & RTSL_INVOKE_ANY_HIT)
    return RTSL_NEEDS_ANY_HIT | (mayStartAtHits(reader) ? ofRaysFromHits : 0);
  if (isLitBySurface(op))
    return RTSL_NEEDS_EMITTERS | RTSL_NEEDS_SAMPLING | ofRaysFromHits;
  return ir::sendsRays(op) && mayStartAtHits(reader) ? ofRaysFromHits : 0;
}

std::uint32_t findNeeds(const LinkContext &context) {
  std::uint32_t needs = 0;
  for (auto function : mlir::ModuleOp(context.ir).getOps<mlir::func::FuncOp>())
    needs |= needsOf(context, function);
  if (context.request.engine == runtime::Engine::Classic) // nothing generates rays
    needs &= ~RTSL_NEEDS_CAMERA_RAY;
  return needs;
}

namespace {

/// The outputs that the methods of this name of all classes derived from `root` read.
std::uint32_t needsOfMethods(const LinkContext &context, llvm::StringRef root,
                             const std::string &method) {
  std::vector<mlir::func::FuncOp> methods;
  for (const LinkedClass &linked : context.classes)
    if ((linked.isUsed || root != "rt_Light") && linked.info->root == root)
      if (mlir::func::FuncOp function = findMethod(context, linked, method))
        methods.push_back(function);
  return needsReachedFrom(methods, context, /*onItself=*/false);
}

} // namespace

std::vector<std::uint32_t> findNeedsOfClasses(const LinkContext &context, std::uint32_t ofProgram) {
  if (context.request.keep.has(Item::Outputs))
    return std::vector<std::uint32_t>(context.classes.size(), RTSL_NEEDS_ALL);
  llvm::StringMap<std::vector<mlir::func::FuncOp>> methods; // by class
  for (auto function : mlir::ModuleOp(context.ir).getOps<mlir::func::FuncOp>())
    if (auto owner = ir::attr::className.of(function))
      methods[owner.getValue()].push_back(function);
  // Lights run on the state of the shader that they light.
  const std::uint32_t ofLights = needsOfMethods(context, "rt_Light", "illumination");
  // A method that computes one of these may read another.
  const std::uint32_t ofDerivatives = needsOfMethods(context, "rt_Primitive", "computeDerivatives");
  const std::uint32_t ofScratchChanges =
      needsOfMethods(context, "rt_Primitive", typed::scratchChangesMethod);
  const std::uint32_t ofNormals = needsOfMethods(context, "rt_Primitive", "computeNormal");
  const std::uint32_t ofCoordinates =
      needsOfMethods(context, "rt_Primitive", "computeTextureCoordinates");

  // The density with which a point of a lamp is chosen depends on the normal there
  // (runtime/device/engines/Emitters.h).
  const bool hasLamps = ofProgram & RTSL_NEEDS_EMITTERS;

  llvm::SmallPtrSet<mlir::Operation *, 8> passing;
  if (lightPasses(context))
    for (const auto &[slot, found] : context.methodsThatPassLight)
      passing.insert(found.begin(), found.end());

  std::vector<std::uint32_t> all;
  for (const LinkedClass &linked : context.classes) {
    bool isLit = false;
    std::uint32_t needs =
        needsReachedFrom(methods.lookup(linked.info->name), context, /*onItself=*/true, &isLit);
    if (isLit)
      needs |= ofLights;
    if (hasLamps && linked.info->root == "rt_Material" && findMethod(context, linked, "emission"))
      needs |= RTSL_NEEDS_NORMALS;
    if (llvm::any_of(passingSlots, [&](const Slot &slot) {
          return linked.info->root == slot.base &&
                 passing.contains(findMethod(context, linked, slot.method));
        }))
      needs |= ofRaysFromHits; // light that passes leaves the hit
    if (isOfScratchChanges(needs))
      needs |= ofScratchChanges;
    if (needs & (RTSL_NEEDS_DERIVATIVES | RTSL_NEEDS_FOOTPRINT))
      needs |= ofDerivatives;
    if (needs & RTSL_NEEDS_TEXTURE_COORDINATES)
      needs |= ofCoordinates;
    if (needs & (RTSL_NEEDS_NORMALS | RTSL_NEEDS_FOOTPRINT))
      needs |= ofNormals;
    all.push_back(needs);
  }
  return all;
}

} // namespace rtsl::linking
