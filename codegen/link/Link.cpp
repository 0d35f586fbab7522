//===- Link.cpp - from classes to a program -------------------------------===//
#include "codegen/link/Link.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/Rays.h"

#include "codegen/link/Members.h"
#include "codegen/link/Reflect.h"
#include "codegen/link/steps/Steps.h"
#include "codegen/passes/errors/BoundHitError.h"

#include "mlir/IR/OwningOpRef.h"
#include "mlir/IR/Verifier.h"
#include "llvm/ADT/StringSet.h"

namespace rtsl {

std::string initializeSymbol(const std::string &className) {
  return className + ".initialize";
}
std::string constructSymbol(const std::string &className) {
  return className + ".construct";
}
std::string intersectSymbol(const std::string &className) {
  return className + ".intersect";
}

/// The names of the members that functions read, of any class.
static llvm::StringSet<> membersRead(mlir::ModuleOp ir) {
  llvm::StringSet<> names;
  ir.walk([&](ir::MemberOp member) {
    const auto isRead = [](mlir::Operation *user) { return !llvm::isa<ir::StoreOp>(user); };
    if (llvm::any_of(member->getUsers(), isRead))
      names.insert(member.getMember());
  });
  return names;
}

/// rtsl_mesh_attributes of the program.
static void defineMeshAttributes(linking::LinkContext &context) {
  std::vector<std::int32_t> words;
  for (const linking::MeshAttribute &attribute : context.meshAttributes) {
    words.push_back(static_cast<std::int32_t>(attribute.offset));
    words.push_back(static_cast<std::int32_t>(ir::sizeInBytes(attribute.irType) / 4));
    for (const std::uint32_t change : attribute.changes)
      words.push_back(static_cast<std::int32_t>(change));
  }
  ir::attr::meshAttributes.set(context.ir,
                               mlir::Builder(context.ir.getContext()).getDenseI32ArrayAttr(words));
}

/// Does a member refer to images?
static bool holdsImages(const runtime::ValueType &type) {
  return type.kind == runtime::ValueType::Kind::Reference && isSampler(type.className);
}

/// Records what the images of a member need not have.
static void noteChannels(const std::string &className, const runtime::MemberInfo &member,
                         Findings &findings) {
  std::string read;
  for (int channel = 0; channel < 4; ++channel)
    if (member.imageChannels >> channel & 1)
      read += std::string(read.empty() ? "" : ", ") + "rgba"[channel];
  if (member.imageChannels != runtime::MemberInfo::allChannels)
    findings.push_back(
        {Item::Images,
         "channels of " + className + "." + member.name,
         false,
         read.empty() ? "nothing reads its colors" : "nothing but " + read + " is read",
         {}});
}

namespace {

/// What a program does that shaders see in the state: rt_PDF begins as the density of illuminate(P)
/// if some method that runs calls that, and LightColor is 0 where materials with `transmittance`
/// let no light pass.
struct SeenByShaders {
  bool lightPasses, samplesSurfaces;
};

} // namespace

/// Of the program that would be if nothing were kept: what is kept must not change the picture.
/// Nothing if that follows from the program itself. `ir` is not linked yet.
static std::optional<SeenByShaders>
seenIfNothingIsKept(mlir::ModuleOp ir, const typed::Module &module, const LinkRequest &request,
                    std::uint32_t colorComponents, const Diagnostics &diagnostics,
                    FloatingPoint floatingPoint) {
  const auto isLit = [](mlir::Operation *op) {
    return llvm::isa<ir::IlluminanceOp, ir::IlluminateOp>(op);
  };
  if (request.keep.isEmpty() || !ir::anyOperation(ir, isLit))
    return std::nullopt;
  LinkRequest nothingKept = request;
  nothingKept.keep = {};
  const mlir::OwningOpRef<mlir::ModuleOp> copy(ir.clone());
  Diagnostics unheard(diagnostics.sources());
  runtime::Program program;
  if (!link(*copy, module, nothingKept, colorComponents, unheard, program, nullptr, floatingPoint))
    return std::nullopt;
  return SeenByShaders{program.lightPasses, (program.needs & RTSL_NEEDS_EMITTERS) != 0};
}

bool link(mlir::ModuleOp ir, const typed::Module &module, const LinkRequest &request,
          std::uint32_t colorComponents, Diagnostics &diagnostics, runtime::Program &program,
          Findings *findings, FloatingPoint floatingPoint) {
  const std::optional<SeenByShaders> seen =
      seenIfNothingIsKept(ir, module, request, colorComponents, diagnostics, floatingPoint);
  Findings unasked;
  linking::LinkContext context{ir,
                               module,
                               request,
                               diagnostics,
                               findings ? *findings : unasked,
                               linking::elementaryErrorsOf(floatingPoint)};
  linking::dropUnusedClasses(context);
  linking::emptyReferences(context);
  linking::findUsedObjects(context);
  program.raysLeavePlanes = linking::deriveHitErrors(context);
  if (!request.hasCounts && !request.keep.has(Item::Counts))
    ir::attr::singlePrimitives.set(ir);
  const linking::ImageChannels imageChannels = linking::findImageChannels(context);
  linking::resolveSlots(context);
  linking::findMethodsThatPassLight(context);
  linking::replaceLightMayPass(context);
  linking::findMeshMaterials(context);
  linking::dropUnknownChanges(context);
  linking::dropUnreached(context);
  linking::noteClasses(context);
  linking::dropUnreadOutputs(context);
  linking::placeAttributes(context);
  defineMeshAttributes(context);
  linking::resolveRayTypes(context);
  linking::warnOfEndlessRays(context);
  if (diagnostics.hasErrors())
    return false;
  program.paths = linking::findPaths(context);
  program.raysLeaveHits = linking::raysLeaveHits(context);
  program.samplesDiffer = linking::samplesDiffer(context);
  program.lightPasses = seen ? seen->lightPasses : linking::lightPasses(context);
  program.hasPrimitives = linking::hasPrimitives(context);
  program.raysReadLaunch = request.keep.has(Item::Outputs) || linking::raysReadLaunch(context);
  linking::makeEntries(context);
  assert(mlir::succeeded(mlir::verify(ir)) && "linking produced invalid IR");

  const std::uint32_t needs = linking::findNeeds(context);
  if (!(needs & RTSL_NEEDS_EMITTERS && program.lightPasses))
    ir::attr::noPassedDistances.set(ir);
  const std::vector<std::uint32_t> needsOfClasses = linking::findNeedsOfClasses(context, needs);
  const llvm::StringSet<> membersOfProgram = membersRead(ir);
  RequiredMembers required(module);
  for (const auto &[index, linked] : llvm::enumerate(context.classes)) {
    runtime::ClassInfo info = reflect(*linked.info, linked.record, linked.parameters, required);
    info.id = linked.id;
    info.needs = needsOfClasses[index];
    for (runtime::MemberInfo &member : info.members) {
      member.isRead = membersOfProgram.contains(member.name) ||
                      (request.keep.has(Item::Images) && isSampler(info.name));
      if (holdsImages(member.type) && !request.keep.has(Item::Images)) {
        member.imageChannels = linking::channelsOf(imageChannels, *linked.info, member.name);
        noteChannels(info.name, member, context.findings);
      }
    }
    info.attributes = linking::meshAttributesOf(context, info.name);
    if (info.root == "rt_Material") {
      info.anyHit = linking::anyHitTypes(context, linked);
      if (program.lightPasses)
        info.opaqueIfZero = linking::opaqueIfZero(context, linked);
    }
    program.classes.push_back(std::move(info));
  }
  program.meshAttributes = linking::describeMeshAttributes(context);
  program.engine = request.engine;
  program.slots.features = request.features;
  program.prints = linking::numberPrints(ir);
  program.colorComponents = colorComponents;
  // The camera's ray cannot be kept where `generate` does not read it: if it has no direction, the
  // sample ends before `generate` (state.no-ray). Neither can surfaces that shine be kept as lights
  // that nothing chooses: rt_PDF is then 0 (light.surfaces).
  const std::uint32_t kept = request.keep.has(Item::Outputs)
                                 ? RTSL_NEEDS_ALL & ~(RTSL_NEEDS_CAMERA_RAY | RTSL_NEEDS_EMITTERS)
                                 : 0;
  program.needs = (kept | needs) & ~linking::needsLeftOut(context);
  if (seen && !seen->samplesSurfaces)
    program.needs &= ~RTSL_NEEDS_EMITTERS;
  program.keepsMeshes = request.keep.has(Item::Meshes);
  program.keepsMeshAttributes = request.keep.has(Item::MeshAttributes);
  return true;
}

std::vector<std::string> keptFunctions(mlir::ModuleOp ir) {
  std::vector<std::string> names;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (ir::attr::kept.isOn(function))
      names.push_back(function.getSymName().str());
  return names;
}

} // namespace rtsl
