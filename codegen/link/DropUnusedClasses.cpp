//===- DropUnusedClasses.cpp - keep what the scene has objects of ---------===//
//
// Methods are lowered once for each class, inherited ones too, so that the functions of a class
// without objects are never called. Its declaration stays: other classes may name it as their base.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/link/Steps.h"

#include "frontend/source/Expansion.h"

#include "llvm/ADT/StringSet.h"

#include <set>

namespace rtsl::linking {

namespace {

/// The classes of which there are objects; empty: all.
llvm::StringSet<> wantedOf(const LinkRequest &request) {
  llvm::StringSet<> names;
  for (const std::string &name : request.classes)
    names.insert(name);
  return names;
}

/// The classes of which something runs a method, beside the making of their objects.
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
                     "no object has it",
                     {std::string(declared.file), declared.at.line, declared.at.column}};
  if (!linked.hasObjects)
    return finding;
  finding.isNeeded = linked.isUsed && runs;
  finding.reason = finding.isNeeded ? "an object has it"
                   : linked.isUsed  ? "an object has it, but no ray runs a method of it"
                                    : "only objects have it that nothing refers to";
  if (const auto place = context.request.places.find(linked.info->name);
      place != context.request.places.end())
    finding.place = place->second;
  return finding;
}

} // namespace

void dropUnusedClasses(LinkContext &context) {
  const llvm::StringSet<> wanted = wantedOf(context.request);
  const auto isWanted = [&](llvm::StringRef name) {
    return wanted.empty() || wanted.contains(name);
  };
  const bool isKept = context.request.keep.has(Item::Classes);
  for (const auto &info : context.module.classes) {
    LinkedClass linked;
    linked.info = info.get();
    linked.hasObjects = isWanted(info->name);
    linked.record = context.symbols.lookup<ir::ClassOp>(info->name);
    linked.id = static_cast<std::uint32_t>(context.classes.size()) + 1;
    if (linked.record && (linked.hasObjects || isKept))
      context.classes.push_back(linked);
    else
      context.findings.push_back(describe(context, linked, false));
  }

  for (auto function : llvm::make_early_inc_range(context.ir.getOps<mlir::func::FuncOp>()))
    if (auto name = ir::attr::className.of(function))
      if (!isWanted(name.getValue()) && !isKept)
        context.symbols.erase(function);
}

void noteClasses(LinkContext &context) {
  const std::set<llvm::StringRef> running = classesThatRun(context.ir);
  for (const LinkedClass &linked : context.classes)
    context.findings.push_back(describe(context, linked, running.count(linked.info->name) != 0));
}

} // namespace rtsl::linking
