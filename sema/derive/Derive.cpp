//===- Derive.cpp - which functions are derived ---------------------------===//
#include "sema/derive/Derive.h"

#include "sema/derive/Derivation.h"
#include "sema/derive/DerivedBody.h"
#include "sema/derive/ScratchChanges.h"
#include "sema/derive/Term.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <algorithm>
#include <set>

namespace rtsl::derive {

using namespace typed;

const StateVariable *changeOf(StateVariable variable, const Function &in, Axis axis) {
  static constexpr StateVariable ofPoint[] = {StateVariable::dPdx, StateVariable::dPdy};
  static constexpr StateVariable ofUV[] = {StateVariable::dUVdx, StateVariable::dUVdy};
  static constexpr StateVariable ofUVW[] = {StateVariable::dUVWdx, StateVariable::dUVWdy};
  static constexpr StateVariable ofNormal[] = {StateVariable::dNdx, StateVariable::dNdy};
  const auto index = static_cast<int>(axis);
  if (in.owner && in.owner->root == "rt_Primitive") {
    const bool isDirection =
        variable == StateVariable::RayDirection || variable == StateVariable::InverseRayDirection;
    return isDirection ? &ofUVW[index] : nullptr;
  }
  switch (variable) {
  case StateVariable::HitPoint:
    return &ofPoint[index];
  case StateVariable::TextureUV:
    return &ofUV[index];
  case StateVariable::TextureUVW:
    return &ofUVW[index];
  case StateVariable::ShadingNormal:
    return &ofNormal[index];
  default:
    return nullptr;
  }
}

bool changes(const Member &member) {
  return member.access == ast::Access::Scratch && member.owner &&
         member.owner->root == "rt_Material" &&
         (member.type->isScalar() || member.type->isVector()) && isDifferentiable(member.type);
}

/// The user function that an expression calls; null if there is none.
static const Function *callee(const Expr &expr) {
  if (auto *call = dynCast<CallExpr>(&expr))
    return call->function;
  if (auto *call = dynCast<MethodCallExpr>(&expr))
    return call->function;
  return nullptr;
}

static bool isDerivative(const Expr &expr) {
  auto *builtin = dynCast<BuiltinExpr>(&expr);
  return builtin && (builtin->builtin == Builtin::DFdx || builtin->builtin == Builtin::DFdy);
}

static bool isSeed(const Expr &expr, const Function &in) {
  if (auto *member = dynCast<MemberExpr>(&expr))
    return changes(*member->member);
  auto *state = dynCast<StateExpr>(&expr);
  return state && changeOf(state->variable, in, Axis::X);
}

/// Do methods of this class run at a hit?
static bool isAtHits(const std::string &root) {
  return root == "rt_Material" || root == "rt_Texture";
}

Derivation::Definitions Derivation::definitions(const Function &function) const {
  if (!function.owner || function.isConstructor)
    return {&function};
  const Function &top = overridden(function);
  Definitions found;
  for (const auto &candidate : module.classes)
    if (candidate->derivesFrom(top.owner))
      for (const auto &method : candidate->functions)
        if (method->name == top.name && sameParameters(*method, top))
          found.push_back(method.get());
  return found;
}

const Derivation::Facts &Derivation::factsOf(const Function &function) {
  const auto [found, isNew] = facts.try_emplace(&function);
  Facts &made = found->second;
  if (isNew && function.body)
    forEachExpr(*function.body, [&](const Expr &expr) {
      made.asks |= isDerivative(expr);
      made.readsSeeds |= isSeed(expr, function);
      if (const Function *called = callee(expr))
        for (const Function *definition : definitions(*called))
          made.callees.push_back(definition);
    });
  return made;
}

bool Derivation::reaches(const Function &from, bool Facts::*property) {
  std::set<const Function *> seen;
  Definitions pending = {&from};
  while (!pending.empty()) {
    const Function *at = pending.back();
    pending.pop_back();
    if (!seen.insert(at).second)
      continue;
    const Facts &of = factsOf(*at);
    if (of.*property)
      return true;
    pending.insert(pending.end(), of.callees.begin(), of.callees.end());
  }
  return false;
}

bool Derivation::asks(const Function &function) {
  const Definitions all = definitions(function);
  return std::any_of(all.begin(), all.end(), [&](const Function *definition) {
    return reaches(*definition, &Facts::asks);
  });
}

bool Derivation::readsSeeds(const Function &function) {
  const Definitions all = definitions(function);
  return std::any_of(all.begin(), all.end(), [&](const Function *definition) {
    return reaches(*definition, &Facts::readsSeeds);
  });
}

bool Derivation::hasVariants(const Function &function) const {
  return !function.isConstructor && !function.isStateMethod &&
         (!function.owner || function.owner->root == helperRoot ||
          function.owner->root == "rt_Primitive" || isAtHits(function.owner->root));
}

bool Derivation::canBeFollowed(const Function &function) {
  return hasVariants(function) && isDifferentiable(function.returnType) &&
         std::all_of(
             function.parameters.begin(), function.parameters.end(),
             [](const auto &parameter) { return parameter->direction == ast::Direction::In; }) &&
         effects.function(function).isPure();
}

AxisSet Derivation::axesOf(const Function &function, Result result) {
  if (result == Result::Value || asks(function))
    return AxisSet::both();
  return AxisSet::only(result == Result::AlongX ? Axis::X : Axis::Y);
}

std::string Derivation::variantName(const Function &from, Result result) const {
  std::string name = from.name + (result == Result::Value    ? "WithFootprint"
                                  : result == Result::AlongX ? "DFdx"
                                                             : "DFdy");
  const auto isTaken = [&](const auto &functions) {
    return std::any_of(functions.begin(), functions.end(),
                       [&](const auto &function) { return function->name == name; });
  };
  while (isTaken(module.functions) ||
         std::any_of(module.classes.begin(), module.classes.end(),
                     [&](const auto &other) { return isTaken(other->functions); }))
    name += "_";
  return name;
}

void Derivation::makeVariant(const Function &from, Result result) {
  auto function = std::make_unique<Function>();
  function->name = variantName(from, result);
  function->returnType = from.returnType;
  function->owner = from.owner;
  function->isCalledOnSelf = from.owner != nullptr;
  function->sends = from.sends;
  function->callSends = from.callSends;
  function->mayRunInLookup = from.mayRunInLookup;
  function->range = from.range;
  made[{&from, result}] = function.get();
  variants.push_back({std::move(function), &from, result});
}

const Function &Derivation::variant(const Function &function, Result result) {
  if (!made.count({&function, result}))
    for (const Function *definition : definitions(function))
      makeVariant(*definition, result);
  return *made.at({&function, result});
}

/// Places the variants of these functions after them.
void Derivation::addVariants(std::vector<std::unique_ptr<Function>> &functions) {
  std::vector<std::unique_ptr<Function>> all;
  for (std::unique_ptr<Function> &function : functions) {
    const Function *from = function.get();
    all.push_back(std::move(function));
    for (Variant &variant : variants)
      if (variant.from == from)
        all.push_back(std::move(variant.function));
  }
  functions = std::move(all);
}

std::string Derivation::memberName(const Member &of, Axis axis) const {
  std::string name = of.name + (axis == Axis::X ? "_dx" : "_dy");
  while (std::any_of(module.classes.begin(), module.classes.end(), [&](const auto &other) {
    return std::any_of(other->members.begin(), other->members.end(),
                       [&](const auto &member) { return member->name == name; });
  }))
    name += "_";
  return name;
}

const Member &Derivation::changeOf(const Member &member, Axis axis) {
  const auto index = static_cast<int>(axis);
  for (const auto &known : members)
    if (known->changeOf == &member && known->axis == index)
      return *known;
  auto change = std::make_unique<Member>();
  change->access = ast::Access::Scratch;
  change->name = memberName(member, axis);
  change->type = member.type;
  change->owner = member.owner;
  change->changeOf = &member;
  change->axis = index;
  change->range = member.range;
  members.push_back(std::move(change));
  return *members.back();
}

void Derivation::addMembers() {
  for (const auto &owner : module.classes)
    for (auto &member : members)
      if (member && member->owner == owner.get())
        owner->members.push_back(std::move(member));
}

std::vector<const Member *> Derivation::changesUsedOf(const Class &primitive) {
  std::vector<std::pair<const Member *, Axis>> used;
  for (const Class *at = &primitive; at; at = at->base)
    for (const auto &member : at->members)
      for (const auto &change : members)
        if (member->access == ast::Access::Scratch && changes(*change->changeOf) &&
            member->name == change->changeOf->name && member->type == change->type)
          used.emplace_back(member.get(), change->axis == 0 ? Axis::X : Axis::Y);
  std::vector<const Member *> found;
  for (const auto &[member, axis] : used)
    if (const Member *change = &changeOf(*member, axis);
        std::find(found.begin(), found.end(), change) == found.end())
      found.push_back(change);
  return found;
}

void Derivation::addScratchChanges() {
  for (const auto &owner : module.classes) {
    const auto intersect =
        std::find_if(owner->functions.begin(), owner->functions.end(), [](const auto &function) {
          return function->isStateMethod && function->name == "intersect" && function->body;
        });
    if (owner->root != "rt_Primitive" || intersect == owner->functions.end())
      continue;
    const std::vector<const Member *> used = changesUsedOf(*owner);
    if (used.empty())
      continue;
    Scratch &one = scratch.emplace_back();
    one.owner = owner.get();
    one.made = std::make_unique<Function>();
    one.made->name = scratchChangesMethod;
    one.made->returnType = types().voidType;
    one.made->owner = owner.get();
    one.made->isStateMethod = true;
    one.made->range = (*intersect)->range;
    one.withDerivatives.owner = owner.get();
    if (!canFollowScratch(**intersect, effects)) {
      one.made->knowsNoChanges = true;
      writeNoScratchChanges(**intersect, used, *one.made);
      continue;
    }
    writeScratchChanges(*this, **intersect, used, one.withDerivatives);
    DerivedBody(*this, one.withDerivatives, *one.made, /*isAtHit=*/true).replace();
  }
}

void Derivation::run() {
  struct Replaced {
    Function *function;
    Function derived; // its body and variables
  };
  std::deque<Replaced> replaced; // at the end: bodies are read until then
  const auto replace = [&](Function &function, bool isAtHit) {
    if (!function.body || !reaches(function, &Facts::asks))
      return;
    Replaced &one = replaced.emplace_back();
    one.function = &function;
    DerivedBody(*this, function, one.derived, isAtHit).replace();
  };
  for (const auto &function : module.functions)
    replace(*function, false);
  for (const auto &owner : module.classes)
    for (const auto &method : owner->functions)
      replace(*method, isAtHits(owner->root) && !method->isConstructor);
  std::size_t derived = 0;
  const auto deriveVariants = [&] { // deriving one may require others
    for (; derived < variants.size(); ++derived)
      DerivedBody(*this, *variants[derived].from, *variants[derived].function, true)
          .vary(variants[derived].result);
  };
  deriveVariants();
  addScratchChanges(); // when it is known which changes materials use
  deriveVariants();

  for (Replaced &one : replaced) {
    one.function->body = std::move(one.derived.body);
    one.function->locals = std::move(one.derived.locals);
  }
  addMembers();
  addVariants(module.functions);
  for (const auto &owner : module.classes)
    addVariants(owner->functions);
  for (Scratch &one : scratch)
    one.owner->functions.push_back(std::move(one.made));
}

} // namespace rtsl::derive

namespace rtsl {

void replaceDerivatives(typed::Module &module) {
  derive::Derivation(module).run();
}

} // namespace rtsl
