//===- DropUnusedClasses.cpp - erase classes that the scene has no objects of ===//
//
// Methods are lowered once for each class, inherited ones too, so the functions of a class without
// objects are never called. Its declaration remains: other classes may name it as their base.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/link/steps/Steps.h"

#include "frontend/source/Expansion.h"

#include "llvm/ADT/StringSet.h"

#include <set>

namespace rtsl::linking {

namespace {

/// The classes that have objects; empty: all.
llvm::StringSet<> requestedClasses(const LinkRequest &request) {
  llvm::StringSet<> names;
  for (const std::string &name : request.classes)
    names.insert(name);
  return names;
}

/// The classes with methods that run other than to make their objects.
std::set<llvm::StringRef> classesThatRun(mlir::ModuleOp ir) {
  std::set<llvm::StringRef> names;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (ir::attr::methodName.isOn(function) && !ir::attr::whileBuilding.isOn(function) &&
        !ir::attr::kept.isOn(function))
      if (const auto owner = ir::attr::className.of(function))
        names.insert(owner.getValue());
  return names;
}

Finding describe(const LinkContext &context, const LinkedClass &linked, bool runs) {
  const ShownPlace declared = shownBegin(context.diagnostics.sources(), linked.info->range);
  Finding finding = {Item::Classes,
                     linked.info->name,
                     false,
                     "it has no objects",
                     {std::string(declared.file), declared.at.line, declared.at.column}};
  if (!linked.hasObjects)
    return finding;
  finding.isNeeded = linked.isUsed && runs;
  finding.reason = finding.isNeeded ? "it has an object"
                   : linked.isUsed  ? "it has an object, but no ray runs a method of it"
                                    : "nothing refers to its objects";
  if (const auto place = context.request.places.find(linked.info->name);
      place != context.request.places.end())
    finding.place = place->second;
  return finding;
}

} // namespace

void dropUnusedClasses(LinkContext &context) {
  const llvm::StringSet<> requested = requestedClasses(context.request);
  const auto isRequested = [&](llvm::StringRef name) {
    return requested.empty() || requested.contains(name);
  };
  const bool isKept = context.request.keep.has(Item::Classes);
  for (const auto &info : context.module.classes) {
    LinkedClass linked;
    linked.info = info.get();
    linked.hasObjects = isRequested(info->name);
    linked.record = context.symbols.lookup<ir::ClassOp>(info->name);
    linked.id = static_cast<std::uint32_t>(context.classes.size()) + 1;
    if (linked.record && (linked.hasObjects || isKept))
      context.classes.push_back(linked);
    else
      context.findings.push_back(describe(context, linked, false));
  }

  for (auto function : llvm::make_early_inc_range(context.ir.getOps<mlir::func::FuncOp>()))
    if (auto name = ir::attr::className.of(function))
      if (!isRequested(name.getValue()) && !isKept)
        context.symbols.erase(function);
}

void noteClasses(LinkContext &context) {
  const std::set<llvm::StringRef> running = classesThatRun(context.ir);
  for (const LinkedClass &linked : context.classes)
    context.findings.push_back(describe(context, linked, running.count(linked.info->name) != 0));
}

} // namespace rtsl::linking
