//===- FindNeeds.cpp - what of a hit is read ------------------------------===//
//
// Normals, texture coordinates, derivatives and transforms cost time at every hit. What no function of the program reads is not
// computed at all; what neither the methods of a material nor those of the objects behind it read is not computed where
// that material was hit. Which objects these are the scene knows (Scene.cpp).
//
//===----------------------------------------------------------------------===//
#include "codegen/link/Steps.h"

#include "llvm/ADT/StringSwitch.h"

#include <set>

namespace rtsl::linking {

namespace {

std::uint32_t needsOf(llvm::StringRef state) {
  return llvm::StringSwitch<std::uint32_t>(state)
      .Cases({"TextureUV", "TextureUVW"}, RTSL_NEEDS_TEXTURE_COORDINATES)
      .Cases({"dPdu", "dPdv", "dsdu", "dsdv", "dtdu", "dtdv"}, RTSL_NEEDS_DERIVATIVES)
      .Cases({"ObjectToWorld", "WorldToObject"}, RTSL_NEEDS_TRANSFORMS)
      .Case("InverseRayDirection", RTSL_NEEDS_INVERSE_DIRECTION)
      .Cases({"EmissionColor", "BSDFValue", "BSDFSeed", "PDF", "du", "dv"}, RTSL_NEEDS_SAMPLING)
      .Cases({"Time", "TimeSeed"}, RTSL_NEEDS_TIME)
      .Cases({"LaunchIndex", "LaunchSize"}, RTSL_NEEDS_LAUNCH)
      .Case("LensCoord", RTSL_NEEDS_LENS)
      .Cases({"GeometricNormal", "ShadingNormal"}, RTSL_NEEDS_NORMALS)
      .Default(0);
}

/// The rt_ class below which the function's class is; empty for a function of no class.
llvm::StringRef rootOf(mlir::func::FuncOp function) {
  const auto name = function->getAttrOfType<mlir::StringAttr>("rtsl.class");
  auto owner = name ? mlir::SymbolTable::lookupNearestSymbolFrom<ir::ClassOp>(function, name) : ir::ClassOp();
  return owner ? owner.getRoot() : llvm::StringRef();
}

/// Whether the function may run before the ray is known to hit the primitive, for `intersect`; what it then reads of the
/// hit has to be there for each candidate.
bool mayRunForCandidates(mlir::func::FuncOp function) {
  const llvm::StringRef root = rootOf(function);
  const auto method = function->getAttrOfType<mlir::StringAttr>("rtsl.method");
  return (root.empty() || root == "rt_Primitive") &&
         !(method && llvm::StringSwitch<bool>(method.getValue())
                         .Cases({"computeNormal", "computeTextureCoordinates", "computeDerivatives"}, true)
                         .Cases({"generateSample", "samplePDF"}, true)
                         .Default(false));
}

/// Whether reading this is reading of a candidate.
bool isOfCandidate(llvm::StringRef state, mlir::func::FuncOp function) {
  if (state == "BoundMin" || state == "BoundMax") {
    const auto method = function->getAttrOfType<mlir::StringAttr>("rtsl.method");
    return !method || method != "computeBounds";
  }
  return llvm::StringSwitch<bool>(state)
             .Cases({"PrimitiveIndex", "InstanceIndex", "ObjectToWorld", "WorldToObject"}, true)
             .Default(false) &&
         mayRunForCandidates(function);
}

/// Whether rays that the function sends may begin where something was hit. How far from there they begin to see rests
/// on the normal (runtime/device/Spawn.h).
bool mayStartAtHits(mlir::func::FuncOp function) {
  const llvm::StringRef root = rootOf(function);
  return root.empty() || root == "rt_Material";
}

/// What one function reads itself.
std::uint32_t needsOf(mlir::func::FuncOp function) {
  std::uint32_t needs = 0;
  function.walk([&](mlir::Operation *op) { needs |= linking::needsOf(function, op); });
  return needs;
}

/// What functions and all that they call read. With `onItself`, calls through references are left out.
std::uint32_t needsReachedFrom(std::vector<mlir::func::FuncOp> pending, mlir::ModuleOp ir, bool onItself) {
  std::uint32_t needs = 0;
  std::set<mlir::Operation *> seen(pending.begin(), pending.end());
  while (!pending.empty()) {
    mlir::func::FuncOp function = pending.back();
    pending.pop_back();
    needs |= needsOf(function);
    function.walk([&](mlir::func::CallOp call) {
      if (onItself && call.getCallee().starts_with(dispatchPrefix))
        return;
      auto callee = ir.lookupSymbol<mlir::func::FuncOp>(call.getCallee());
      if (callee && seen.insert(callee).second)
        pending.push_back(callee);
    });
  }
  return needs;
}

} // namespace

std::uint32_t needsOf(mlir::func::FuncOp function, mlir::Operation *op) {
  if (auto state = llvm::dyn_cast<ir::StateOp>(op)) {
    const bool isRead =
        llvm::any_of(state->getUsers(), [](mlir::Operation *user) { return !mlir::isa<ir::StoreOp>(user); });
    if (!isRead)
      return 0;
    return needsOf(state.getName()) | (isOfCandidate(state.getName(), function) ? RTSL_NEEDS_CANDIDATE : 0);
  }
  if (auto trace = llvm::dyn_cast<ir::TracePayloadOp>(op); trace && trace.getHow().value_or(0) & RTSL_ASK_ANY_HIT)
    return RTSL_NEEDS_ANY_HIT | (mayStartAtHits(function) ? RTSL_NEEDS_NORMALS : 0);
  const bool sendsRay = llvm::isa<ir::TraceOp, ir::TracePayloadOp, ir::IlluminanceOp>(op);
  return sendsRay && mayStartAtHits(function) ? RTSL_NEEDS_NORMALS : 0;
}

std::uint32_t findNeeds(mlir::ModuleOp ir) {
  std::uint32_t needs = 0;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    needs |= needsOf(function);
  return needs;
}

namespace {

/// What the class's own methods read.
std::uint32_t ownNeeds(const LinkContext &context, const LinkedClass &linked) {
  std::vector<mlir::func::FuncOp> methods;
  for (auto function : mlir::ModuleOp(context.ir).getOps<mlir::func::FuncOp>())
    if (auto owner = function->getAttrOfType<mlir::StringAttr>("rtsl.class"); owner && owner == linked.info->name)
      methods.push_back(function);
  std::uint32_t needs = needsReachedFrom(std::move(methods), context.ir, /*onItself=*/true);
  // `illuminance` runs the lights on the material's own state.
  if (linked.info->root == "rt_Material" && findMethod(context, linked, "shade"))
    for (const LinkedClass &light : context.classes)
      if (light.isUsed && light.info->root == "rt_Light")
        if (mlir::func::FuncOp illumination = findMethod(context, light, "illumination"))
          needs |= needsReachedFrom({illumination}, context.ir, /*onItself=*/false);
  return needs;
}

/// What a method of some primitive reads.
std::uint32_t needsOfPrimitives(const LinkContext &context, const std::string &method) {
  std::uint32_t needs = 0;
  for (const LinkedClass &primitive : context.classes)
    if (primitive.info->root == "rt_Primitive")
      if (mlir::func::FuncOp function = findMethod(context, primitive, method))
        needs |= needsReachedFrom({function}, context.ir, /*onItself=*/false);
  return needs;
}

} // namespace

std::uint32_t findNeeds(const LinkContext &context, const LinkedClass &linked) {
  if (context.request.keep.has(Item::Outputs))
    return RTSL_NEEDS_ALL;
  std::uint32_t needs = ownNeeds(context, linked);
  // Whoever computes one of these may read another.
  if (needs & RTSL_NEEDS_DERIVATIVES)
    needs |= needsOfPrimitives(context, "computeDerivatives");
  if (needs & RTSL_NEEDS_TEXTURE_COORDINATES)
    needs |= needsOfPrimitives(context, "computeTextureCoordinates");
  if (needs & RTSL_NEEDS_NORMALS)
    needs |= needsOfPrimitives(context, "computeNormal");
  return needs;
}

} // namespace rtsl::linking
