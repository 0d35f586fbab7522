//===- HitErrors.cpp - error bounds of the hits of primitives -------------===//
//
// Where a ray leaves a primitive with its own `intersect`, the runtime needs a bound of the error
// of t (runtime/device/ray/HitError.h). This step derives it for the primitives with a material
// that sends rays. If no bound can be derived, a warning suggests to state one.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/link/steps/Steps.h"

#include "codegen/passes/errors/DeriveHitErrors.h"
#include "frontend/source/Expansion.h"
#include "sema/typed/Casting.h"
#include "sema/typed/Walk.h"

#include <algorithm>

namespace rtsl::linking {

namespace {

/// The `hit(t)` at that location; an empty range if there is none.
SourceRange findHit(const typed::Module &module, const SourceManager &sources,
                    const ir::SourcePlace &place) {
  SourceRange range;
  const auto look = [&](const typed::Function &function) {
    if (!function.body)
      return;
    forEachExpr(*function.body, [&](const typed::Expr &expr) {
      const auto *call = dynCast<typed::BuiltinExpr>(&expr);
      if (!call || !has(call->builtin, typed::effect::Hits) || range.isValid())
        return;
      const ShownPlace shown = shownBegin(sources, call->range);
      if (shown.file == place.file && shown.at.line == place.line &&
          shown.at.column == place.column)
        range = call->range;
    });
  };
  for (const auto &definition : module.classes)
    for (const auto &function : definition->functions)
      look(*function);
  for (const auto &function : module.functions)
    look(*function);
  return range;
}

/// Warns of hits without an error bound on primitives that rays leave.
void warnOfUnboundHits(const std::vector<DerivedHitError> &derived, const typed::Module &module,
                       Diagnostics &diagnostics) {
  for (const DerivedHitError &one : derived)
    for (const UnboundHit &hit : one.unbound)
      diagnostics
          .report(Code::hitErrorUnknown,
                  findHit(module, diagnostics.sources(), ir::placeOf(hit.place)), hit.reason)
          .note("state how far off t may be at most: `hit(t, error)`");
}

/// The materials whose methods send rays.
std::set<std::string> findSenders(const LinkContext &context) {
  std::set<std::string> senders;
  for (mlir::Operation *function : functionsThatSendRays(context.ir, context.symbols))
    if (auto owner = ir::attr::className.of(function))
      senders.insert(owner.str());
  std::set<std::string> materials;
  for (const LinkedClass &linked : context.classes)
    if (linked.info->root == "rt_Material" && senders.count(linked.info->name))
      materials.insert(linked.info->name);
  return materials;
}

/// For each primitive, a material on it that sends rays.
std::map<std::string, std::string> findSendersOn(const LinkContext &context,
                                                 const std::set<std::string> &senders) {
  std::map<std::string, std::string> found;
  for (const auto &[primitive, material] : context.request.surfaces)
    if (senders.count(material))
      found.try_emplace(primitive, material);
  if (context.request.surfaces.empty() && !senders.empty())
    for (const LinkedClass &linked : context.classes)
      found.try_emplace(linked.info->name, *senders.begin());
  return found;
}

} // namespace

ElementaryErrors elementaryErrorsOf(FloatingPoint floatingPoint) {
  return floatingPoint == FloatingPoint::Fast ? fastErrors : strictErrors;
}

bool deriveHitErrors(LinkContext &context) {
  const std::set<std::string> senders = findSenders(context);
  const std::map<std::string, std::string> sendersOn = findSendersOn(context, senders);
  std::map<std::string, Finding> findings;
  std::vector<std::string> left;
  for (const LinkedClass &linked : context.classes) {
    if (linked.info->root != "rt_Primitive" || !findMethod(context, linked, "intersect"))
      continue;
    const std::string &name = linked.info->name;
    const auto sender = sendersOn.find(name);
    const bool isLeft = sender != sendersOn.end();
    const std::string subject = "bound of the error of t in " + name + ".intersect";
    findings[name] = {Item::Outputs,
                      subject,
                      isLeft,
                      isLeft ? "rays of `" + sender->second + "` leave it" : "no ray leaves it",
                      {}};
    if ((isLeft && !context.isWithout(Item::Outputs, subject)) ||
        context.request.keep.has(Item::Outputs))
      left.push_back(name);
  }
  std::vector<DerivedHitError> derived =
      rtsl::deriveHitErrors(context.ir, context.symbols, left, context.elementaryErrors);
  for (const DerivedHitError &one : derived)
    if (!one.hasFunction && findings[one.className].isNeeded) {
      findings[one.className].isNeeded = false;
      findings[one.className].reason =
          one.unbound.empty() ? "the author states it" : "no bound is known";
    }
  for (auto &[name, finding] : findings)
    context.findings.push_back(std::move(finding));
  // No warnings for items kept although no ray leaves them.
  derived.erase(
      std::remove_if(derived.begin(), derived.end(),
                     [&](const DerivedHitError &one) { return !sendersOn.count(one.className); }),
      derived.end());
  warnOfUnboundHits(derived, context.module, context.diagnostics);
  return derived.size() == sendersOn.size() &&
         llvm::all_of(derived, [](const DerivedHitError &one) { return one.isPlane; });
}

} // namespace rtsl::linking
