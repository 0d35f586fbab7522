//===- LinkModule.cpp - linking a module without a scene ------------------===//
#include "codegen/link/LinkModule.h"

#include "codegen/ir/Attributes.h"
#include "codegen/link/steps/Steps.h"

namespace rtsl {

namespace linking {

namespace {

std::vector<RayTypeFacts> rayTypesOf(const LinkContext &context) {
  std::vector<RayTypeFacts> facts;
  for (const RayType &type : context.rayTypes)
    facts.push_back({structOf(context, type), type.number, type.search});
  return facts;
}

/// The offset of each scratch member that some method uses.
std::map<const typed::Member *, std::uint32_t> attributeWordsOf(const LinkContext &context) {
  const ClassesByName classes = classesOf(context);
  std::map<const typed::Member *, std::uint32_t> words;
  mlir::ModuleOp(context.ir).walk([&](ir::AttributeOp attribute) {
    const auto function = attribute->getParentOfType<mlir::func::FuncOp>();
    const auto owner = ir::attr::className.of(function);
    const typed::Class *info = owner ? findClass(classes, owner.str()) : nullptr;
    if (!info || !attribute.getOffset())
      return;
    if (const typed::Member *member = scratchOf(*info, attribute))
      words[member] = *attribute.getOffset();
  });
  return words;
}

} // namespace

} // namespace linking

std::optional<ModuleFacts> linkModule(mlir::ModuleOp ir, const typed::Module &module,
                                      Diagnostics &diagnostics, FloatingPoint floatingPoint) {
  LinkRequest request;
  request.isSampled = true;
  request.engine = runtime::Engine::Either;
  Findings unasked;
  linking::LinkContext context{ir,          module,  request,
                               diagnostics, unasked, linking::elementaryErrorsOf(floatingPoint)};
  context.hasScene = false;
  linking::dropUnusedClasses(context);
  linking::deriveHitErrors(context);
  linking::resolveSlots(context);
  linking::findMeshMaterials(context);
  linking::placeAttributes(context);
  linking::resolveRayTypes(context);
  if (diagnostics.hasErrors())
    return std::nullopt;

  ModuleFacts facts;
  facts.rayTypes = linking::rayTypesOf(context);
  facts.attributeWords = linking::attributeWordsOf(context);
  for (const linking::MeshAttribute &attribute : context.meshAttributes)
    facts.meshAttributes.push_back({attribute.name,
                                    attribute.type,
                                    attribute.offset,
                                    {attribute.changes[0], attribute.changes[1]}});
  facts.needs = linking::findNeeds(context);
  if (!linking::usesSurfacesAsLights(context)) // those that call it never run (light.surfaces)
    facts.needs &= ~RTSL_NEEDS_EMITTERS;
  if (!(facts.needs & RTSL_NEEDS_EMITTERS))
    ir::attr::noPassedDistances.set(ir);
  const std::vector<std::uint32_t> needs = linking::findNeedsOfClasses(context, facts.needs);
  for (const auto &[index, linked] : llvm::enumerate(context.classes)) {
    facts.needsOfClass[linked.info] = needs[index];
    facts.meshAttributesOfClass[linked.info] =
        linking::meshAttributesOf(context, linked.info->name);
  }
  return facts;
}

} // namespace rtsl
