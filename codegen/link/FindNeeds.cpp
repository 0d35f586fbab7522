//===- FindNeeds.cpp - what of a hit is read ------------------------------===//
//
// Texture coordinates, derivatives and transforms cost time at every hit. If no function that is left in the program
// reads them, the runtime does not compute them.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/Steps.h"

#include "llvm/ADT/StringSwitch.h"

namespace rtsl::linking {

std::uint32_t findNeeds(mlir::ModuleOp ir) {
  std::uint32_t needs = 0;
  ir.walk([&](ir::StateOp state) {
    const bool isRead =
        llvm::any_of(state->getUsers(), [](mlir::Operation *user) { return !mlir::isa<ir::StoreOp>(user); });
    if (isRead)
      needs |= llvm::StringSwitch<std::uint32_t>(state.getName())
                   .Cases({"TextureUV", "TextureUVW"}, RTSL_NEEDS_TEXTURE_COORDINATES)
                   .Cases({"dPdu", "dPdv", "dsdu", "dsdv", "dtdu", "dtdv"}, RTSL_NEEDS_DERIVATIVES)
                   .Cases({"ObjectToWorld", "WorldToObject"}, RTSL_NEEDS_TRANSFORMS)
                   .Case("InverseRayDirection", RTSL_NEEDS_INVERSE_DIRECTION)
                   .Cases({"EmissionColor", "BSDFValue", "BSDFSeed", "PDF", "du", "dv"}, RTSL_NEEDS_SAMPLING)
                   .Default(0);
  });
  return needs;
}

} // namespace rtsl::linking
