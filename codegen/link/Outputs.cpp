//===- Outputs.cpp - results that nobody reads ----------------------------===//
//
// What a method computes goes to state: `computeTextureCoordinates` writes TextureUV and
// TextureUVW. Whether the method runs at all is a matter of RTSL_NEEDS_* (FindNeeds.cpp); here
// single results that no function of the program reads are not written, and what was computed for
// them alone goes with them.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/Steps.h"

#include "llvm/ADT/MapVector.h"
#include "llvm/ADT/StringSwitch.h"

namespace rtsl::linking {

namespace {

using mlir::func::FuncOp;

/// State that methods write for other methods alone. The runtime reads the rest, and both normals
/// where one is asked for: if the author leaves one out it is the other. `isSampled`: the host
/// reads what sampling gives.
bool isOnlyForMethods(llvm::StringRef state, bool isSampled) {
  return llvm::StringSwitch<bool>(state)
      .Cases({"TextureUV", "TextureUVW", "TextureColor", "FloatTextureValue"}, true)
      .Cases({"dPdu", "dPdv", "dsdu", "dsdv", "dtdu", "dtdv"}, true)
      .Cases({"PDF", "BSDFValue", "EmissionColor"}, !isSampled)
      .Default(false);
}

struct Output {
  llvm::SmallVector<ir::StateOp> written; // only written there
  bool isRead = false;
};

/// What the runtime computes of a hit or a sample if somebody asks for it.
struct Computed {
  std::uint32_t need;
  const char *subject;
};
constexpr Computed computed[] = {
    {RTSL_NEEDS_NORMALS, "computeNormal"},
    {RTSL_NEEDS_TEXTURE_COORDINATES, "computeTextureCoordinates"},
    {RTSL_NEEDS_DERIVATIVES, "computeDerivatives"},
    {RTSL_NEEDS_TRANSFORMS, "rt_ObjectToWorld, rt_WorldToObject"},
    {RTSL_NEEDS_INVERSE_DIRECTION, "rt_InverseRayDirection"},
    {RTSL_NEEDS_SAMPLING, "rt_BSDFSeed, rt_PDF and others of sampling"},
    {RTSL_NEEDS_TIME, "rt_Time, rt_TimeSeed"},
    {RTSL_NEEDS_LAUNCH, "rt_LaunchIndex, rt_LaunchSize"},
    {RTSL_NEEDS_LENS, "rt_LensCoord"},
    {RTSL_NEEDS_CANDIDATE,
     "rt_BoundMin, rt_BoundMax and what else `intersect` knows of its object"},
};

/// Notes who reads it first, or that nobody does.
Finding findReader(const LinkContext &context, const Computed &one) {
  Finding finding = {Item::Outputs, one.subject, false, "nobody reads it", {}};
  for (auto function : mlir::ModuleOp(context.ir).getOps<FuncOp>()) {
    const Reader reader = readerOf(context.symbols, function);
    const auto read = function.walk([&](mlir::Operation *op) {
      if (!(needsOf(reader, op) & one.need))
        return mlir::WalkResult::advance();
      finding.isNeeded = true;
      finding.reason =
          (llvm::isa<ir::StateOp>(op) ? "read by `"
                                      : "where rays begin to see that leave the hit: `") +
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

  llvm::MapVector<mlir::StringAttr, Output> outputs;
  context.ir.walk([&](ir::StateOp state) {
    if (!isOnlyForMethods(state.getName(), context.request.isSampled))
      return;
    const bool isRead = llvm::any_of(
        state->getUsers(), [](mlir::Operation *user) { return !llvm::isa<ir::StoreOp>(user); });
    Output &output = outputs[state.getNameAttr()];
    output.isRead |= isRead;
    if (!isRead && !state->use_empty())
      output.written.push_back(state);
  });
  for (auto &[name, output] : outputs) {
    if (output.isRead)
      continue;
    for (ir::StateOp state : output.written) {
      const auto function = state->getParentOfType<FuncOp>();
      context.findings.push_back({Item::Outputs, "rt_" + name.str() + " of " + shownName(function),
                                  false, "nobody reads it", ir::placeOf(state->getLoc())});
      if (context.request.keep.has(Item::Outputs))
        continue;
      for (mlir::Operation *user : llvm::make_early_inc_range(state->getUsers()))
        user->erase();
      state->erase();
    }
  }
}

} // namespace rtsl::linking
