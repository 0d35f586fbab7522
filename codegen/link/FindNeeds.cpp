//===- FindNeeds.cpp - what of a hit is read ------------------------------===//
//
// Texture coordinates, derivatives and transforms cost time at every hit. What no function of the program reads is not
// computed at all; what neither the methods of a material nor those of the objects behind it read is not computed where
// that material was hit. Which objects these are the scene knows (Scene.cpp).
//
//===----------------------------------------------------------------------===//
#include "codegen/link/Steps.h"

#include "llvm/ADT/StringSwitch.h"

#include <set>

namespace rtsl::linking {

namespace {

/// What one function reads itself.
std::uint32_t needsOf(mlir::func::FuncOp function) {
  std::uint32_t needs = 0;
  function.walk([&](ir::StateOp state) {
    const bool isRead =
        llvm::any_of(state->getUsers(), [](mlir::Operation *user) { return !mlir::isa<ir::StoreOp>(user); });
    if (isRead)
      needs |= llvm::StringSwitch<std::uint32_t>(state.getName())
                   .Cases({"TextureUV", "TextureUVW"}, RTSL_NEEDS_TEXTURE_COORDINATES)
                   .Cases({"dPdu", "dPdv", "dsdu", "dsdv", "dtdu", "dtdv"}, RTSL_NEEDS_DERIVATIVES)
                   .Cases({"ObjectToWorld", "WorldToObject"}, RTSL_NEEDS_TRANSFORMS)
                   .Case("InverseRayDirection", RTSL_NEEDS_INVERSE_DIRECTION)
                   .Cases({"EmissionColor", "BSDFValue", "BSDFSeed", "PDF", "du", "dv"}, RTSL_NEEDS_SAMPLING)
                   .Cases({"Time", "TimeSeed"}, RTSL_NEEDS_TIME)
                   .Cases({"LaunchIndex", "LaunchSize"}, RTSL_NEEDS_LAUNCH)
                   .Case("LensCoord", RTSL_NEEDS_LENS)
                   .Default(0);
  });
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

/// The methods of a material that run where it was hit.
std::vector<mlir::func::FuncOp> methodsAtHits(const LinkContext &context, const LinkedClass &material) {
  std::vector<std::string> names = {"shade"};
  for (const RayType &type : context.rayTypes)
    for (const char *method : {"closestHit.", "anyHit."})
      names.push_back(method + type.name());
  std::vector<mlir::func::FuncOp> methods;
  for (const std::string &name : names)
    if (mlir::func::FuncOp method = findMethod(context, material, name))
      methods.push_back(method);
  return methods;
}

} // namespace

std::uint32_t findNeeds(mlir::ModuleOp ir) {
  std::uint32_t needs = 0;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    needs |= needsOf(function);
  return needs;
}

std::uint32_t findNeeds(const LinkContext &context, const LinkedClass &linked) {
  if (linked.info->root != "rt_Material") {
    std::vector<mlir::func::FuncOp> methods;
    for (auto function : mlir::ModuleOp(context.ir).getOps<mlir::func::FuncOp>())
      if (auto owner = function->getAttrOfType<mlir::StringAttr>("rtsl.class"); owner && owner == linked.info->name)
        methods.push_back(function);
    return needsReachedFrom(std::move(methods), context.ir, /*onItself=*/true);
  }
  std::uint32_t needs = needsReachedFrom(methodsAtHits(context, linked), context.ir, /*onItself=*/true);
  // `illuminance` runs the lights on the material's own state.
  if (findMethod(context, linked, "shade"))
    for (const LinkedClass &light : context.classes)
      if (light.info->root == "rt_Light")
        if (mlir::func::FuncOp illumination = findMethod(context, light, "illumination"))
          needs |= needsReachedFrom({illumination}, context.ir, /*onItself=*/false);
  return needs;
}

} // namespace rtsl::linking
