//===- DropUnusedClasses.cpp - keep what the scene has objects of ---------===//
//
// Methods are lowered once for each class, inherited ones too, so that the functions of a class without objects are
// never called. Its declaration stays: other classes may name it as their base.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/Steps.h"

#include "frontend/Expansion.h"

#include <algorithm>

namespace rtsl::linking {

namespace {

bool isWanted(const LinkRequest &request, const std::string &name) {
  return request.classes.empty() ||
         std::find(request.classes.begin(), request.classes.end(), name) != request.classes.end();
}

void note(LinkContext &context, const LinkedClass &linked) {
  const ShownPlace declared = shownBegin(context.diagnostics.sources(), linked.info->range);
  Finding finding = {Item::Classes, linked.info->name, linked.hasObjects, "no object has it",
                     {std::string(declared.file), declared.at.line, declared.at.column}};
  if (linked.hasObjects) {
    finding.reason = "an object has it";
    if (const auto place = context.request.places.find(linked.info->name); place != context.request.places.end())
      finding.place = place->second;
  }
  context.findings.push_back(std::move(finding));
}

} // namespace

void dropUnusedClasses(LinkContext &context) {
  mlir::SymbolTable symbols(context.ir);
  const bool isKept = context.request.keep.has(Item::Classes);
  for (const auto &info : context.module.classes) {
    LinkedClass linked;
    linked.info = info.get();
    linked.hasObjects = isWanted(context.request, info->name);
    linked.record = symbols.lookup<ir::ClassOp>(info->name);
    linked.id = static_cast<std::uint32_t>(context.classes.size()) + 1;
    note(context, linked);
    if (linked.record && (linked.hasObjects || isKept))
      context.classes.push_back(linked);
  }

  for (auto function : llvm::make_early_inc_range(context.ir.getOps<mlir::func::FuncOp>()))
    if (auto name = function->getAttrOfType<mlir::StringAttr>("rtsl.class"))
      if (!isWanted(context.request, name.str()) && !isKept)
        function.erase();
}

} // namespace rtsl::linking
