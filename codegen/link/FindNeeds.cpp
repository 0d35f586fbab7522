//===- FindNeeds.cpp - what of a hit is read ------------------------------===//
//
// Texture coordinates, derivatives and transforms cost time at every hit. What no function of the program reads is not
// computed at all; what the methods of a material cannot reach is not computed where that material was hit.
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

/// What a function and all that it calls read.
std::uint32_t needsReachedFrom(mlir::func::FuncOp root, mlir::ModuleOp ir) {
  std::uint32_t needs = 0;
  std::set<mlir::Operation *> seen = {root};
  std::vector<mlir::func::FuncOp> pending = {root};
  while (!pending.empty()) {
    mlir::func::FuncOp function = pending.back();
    pending.pop_back();
    needs |= needsOf(function);
    function.walk([&](mlir::func::CallOp call) {
      auto callee = ir.lookupSymbol<mlir::func::FuncOp>(call.getCallee());
      if (callee && seen.insert(callee).second)
        pending.push_back(callee);
    });
  }
  return needs;
}

} // namespace

std::uint32_t findNeeds(mlir::ModuleOp ir) {
  std::uint32_t needs = 0;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    needs |= needsOf(function);
  return needs;
}

std::uint32_t findNeeds(const LinkContext &context, const LinkedClass &material) {
  std::uint32_t needs = 0;
  for (const RayType &type : context.rayTypes)
    for (const char *method : {"closestHit.", "anyHit."})
      if (mlir::func::FuncOp program = findMethod(context, material, method + type.name()))
        needs |= needsReachedFrom(program, context.ir);
  mlir::func::FuncOp shade = findMethod(context, material, "shade");
  if (!shade)
    return needs;
  needs |= needsReachedFrom(shade, context.ir);
  // `illuminance` runs the lights on the material's own state.
  for (const LinkedClass &light : context.classes)
    if (light.info->root == "rt_Light")
      if (mlir::func::FuncOp illumination = findMethod(context, light, "illumination"))
        needs |= needsReachedFrom(illumination, context.ir);
  return needs;
}

} // namespace rtsl::linking
