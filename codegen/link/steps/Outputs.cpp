//===- Outputs.cpp - outputs that are never read --------------------------===//
//
// Methods store their outputs in the state: `computeTextureCoordinates` writes TextureUV and
// TextureUVW. RTSL_NEEDS_* (FindNeeds.cpp) determines whether such a method runs at all; here,
// single outputs that no function of the program reads are not written, and code that only computes
// them is removed.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/steps/Steps.h"

#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/StringSwitch.h"

namespace rtsl::linking {

namespace {

using mlir::func::FuncOp;

/// State that methods write only for other methods. The rest is read by the runtime, which also
/// reads both normals if one of them is used, because the author may set only one, which then
/// serves as the other. `readsSamples`: the host or the runtime reads the outputs of sampling;
/// `hasFootprints`: the runtime reads dPdu and dPdv.
bool isOnlyForMethods(llvm::StringRef state, bool readsSamples, bool hasFootprints) {
  return llvm::StringSwitch<bool>(state)
      .Cases({"TextureUV", "TextureUVW", "TextureColor", "FloatTextureValue"}, true)
      .Cases({"dsdu", "dsdv", "dtdu", "dtdv"}, true)
      .Cases({"dPdu", "dPdv"}, !hasFootprints)
      .Cases({"PDF", "BSDFValue", "EmissionColor"}, !readsSamples)
      .Default(false);
}

struct Output {
  llvm::SmallVector<ir::StateOp> written; // only written there
  bool isRead = false;
};

/// Outputs of a hit or a sample that the runtime computes if they are used.
struct Computed {
  std::uint32_t need;
  const char *subject;
};
constexpr Computed computed[] = {
    {RTSL_NEEDS_NORMALS, "computeNormal"},
    {RTSL_NEEDS_TEXTURE_COORDINATES, "computeTextureCoordinates"},
    {RTSL_NEEDS_DERIVATIVES, "computeDerivatives"},
    {RTSL_NEEDS_TRANSFORMS, "rt_ObjectToWorld, rt_WorldToObject"},
    {RTSL_NEEDS_INSTANCE_ID, "rt_InstanceId"},
    {RTSL_NEEDS_INVERSE_DIRECTION, "rt_InverseRayDirection"},
    {RTSL_NEEDS_SAMPLING, "rt_BSDFSeed, rt_PDF and others of sampling"},
    {RTSL_NEEDS_TIME, "rt_Time, rt_TimeSeed"},
    {RTSL_NEEDS_LAUNCH, "rt_LaunchIndex, rt_LaunchSize"},
    {RTSL_NEEDS_LENS, "rt_LensCoord"},
    {RTSL_NEEDS_FOOTPRINT, footprintSubject},
    {RTSL_NEEDS_NORMAL_CHANGES, "changes of normals"},
    {RTSL_NEEDS_CAMERA_RAY, "the camera's ray in `generate`"},
    {RTSL_NEEDS_EMITTERS, "surfaces that shine as lights"},
    {RTSL_NEEDS_CANDIDATE, "rt_BoundMin, rt_BoundMax and other state of the object in `intersect`"},
};

/// Records the first reader, or that there is none.
Finding findReader(const LinkContext &context, const Computed &one) {
  Finding finding = {Item::Outputs, one.subject, false, "it is never read", {}};
  for (auto function : mlir::ModuleOp(context.ir).getOps<FuncOp>()) {
    const Reader reader = readerOf(context.symbols, function);
    const auto read = function.walk([&](mlir::Operation *op) {
      if (!(needsOf(reader, op) & one.need))
        return mlir::WalkResult::advance();
      finding.isNeeded = true;
      finding.reason =
          (llvm::isa<ir::StateOp>(op) ? "read by `"
                                      : "required for rays that start at the hit, by `") +
          shownName(function) + "`";
      finding.place = ir::placeOf(op->getLoc());
      return mlir::WalkResult::interrupt();
    });
    if (read.wasInterrupted())
      break;
  }
  return finding;
}

} // namespace

std::uint32_t needsLeftOut(const LinkContext &context) {
  std::uint32_t needs = 0;
  for (const Computed &one : computed)
    if (context.isWithout(Item::Outputs, one.subject))
      needs |= one.need;
  return needs;
}

void dropUnreadOutputs(LinkContext &context) {
  for (const Computed &one : computed)
    context.findings.push_back(findReader(context, one));

  const std::uint32_t needs = findNeeds(context);
  const bool readsSamples = context.request.isSampled || needs & RTSL_NEEDS_EMITTERS;
  const bool hasFootprints = needs & RTSL_NEEDS_FOOTPRINT;
  llvm::MapVector<mlir::StringAttr, Output> outputs;
  context.ir.walk([&](ir::StateOp state) {
    if (!isOnlyForMethods(state.getName(), readsSamples, hasFootprints))
      return;
    Output &output = outputs[state.getNameAttr()];
    if (isRead(state))
      output.isRead = true;
    else if (!state->use_empty())
      output.written.push_back(state);
  });
  for (auto &[name, output] : outputs) {
    if (output.isRead)
      continue;
    for (ir::StateOp state : output.written) {
      const auto function = state->getParentOfType<FuncOp>();
      context.findings.push_back({Item::Outputs, "rt_" + name.str() + " of " + shownName(function),
                                  false, "it is never read", ir::placeOf(state->getLoc())});
      if (context.request.keep.has(Item::Outputs))
        continue;
      for (mlir::Operation *user : llvm::make_early_inc_range(state->getUsers()))
        user->erase();
      state->erase();
    }
  }
}

} // namespace rtsl::linking
