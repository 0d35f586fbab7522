//===- Calls.cpp - calls of the author's functions ------------------------===//
//
// RTSL copies arguments in and results of `out` parameters out, from left to right. C++ passes the
// place itself where that cannot be told apart: nobody else looks at the place during the call.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/Printer.h"

#include "codegen/lower/Analysis.h"
#include "sema/Casting.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using typed::ExprKind;

/// Can a C++ reference to the place's type refer to it? Not to several components of a vector, and
/// not to a bool that lies in memory as 32 bits.
bool FunctionPrinter::canBind(const typed::Expr &place) const {
  const typed::Expr *vector = nullptr;
  if (components(place, vector).size() > 1)
    return false;
  auto *variable = dynCast<typed::VariableExpr>(&place);
  const bool isBool = place.type->is(TypeKind::Bool) || (place.type->isVector() && place.type->element->is(TypeKind::Bool));
  if (auto *component = dynCast<typed::SwizzleExpr>(&place); component && isBool)
    return canBind(*component->base);
  return variable || !isBool;
}

/// What an assignment to the place would write: what it is part of.
static std::set<const void *> writesOf(EffectsOf &effects, const typed::Expr &place) {
  return effects.expression(lowering::wholeOf(place)).reads;
}

static bool meet(const std::set<const void *> &a, const std::set<const void *> &b) {
  return std::any_of(a.begin(), a.end(), [&](const void *at) { return b.count(at) != 0; });
}

Code FunctionPrinter::callWith(const std::string &callee, std::vector<std::string> first,
                               const typed::Function &target, const std::vector<typed::ExprPtr> &args,
                               const Type *result) {
  EffectsOf &effects = module.effects;
  const Effects &inside = effects.function(target);
  auto isOutput = [&](std::size_t i) { return target.parameters[i]->direction != ast::Direction::In; };

  std::vector<Effects> facts;
  std::vector<std::set<const void *>> roots(args.size());
  for (std::size_t i = 0; i < args.size(); ++i) {
    facts.push_back(isOutput(i) ? indexEffects(*args[i]) : effects.expression(*args[i]));
    if (isOutput(i))
      roots[i] = writesOf(effects, *args[i]);
  }

  std::vector<std::string> texts = std::move(first);
  std::vector<std::string> after;
  for (std::size_t i = 0; i < args.size(); ++i) {
    const typed::Variable &parameter = *target.parameters[i];
    bool shows = false; // to a later argument, or the other way round
    for (std::size_t j = i + 1; j < args.size(); ++j)
      shows |= conflicts(facts[i], facts[j]);
    if (!isOutput(i)) {
      std::string text = shows ? hoist(args[i]->type, "argument", argument(*args[i])) : argument(*args[i]);
      // By reference, beside something that the call changes.
      bool changes = meet(facts[i].reads, inside.writes);
      for (std::size_t j = 0; j < args.size(); ++j)
        changes |= isOutput(j) && meet(facts[i].reads, roots[j]);
      if (!shows && changes && module.isByReference(parameter, target))
        text = module.type(parameter.type) + "(" + text + ")";
      texts.push_back(text);
      continue;
    }
    bool isShared = meet(roots[i], inside.reads) || meet(roots[i], inside.writes);
    for (std::size_t j = 0; j < args.size(); ++j) {
      if (j != i && isOutput(j))
        isShared |= meet(roots[i], roots[j]);
      if (j > i)
        isShared |= meet(facts[j].writes, roots[i]);
    }
    if (canBind(*args[i]) && !isShared) {
      texts.push_back(place(*args[i], shows).text);
      continue;
    }
    // Through a variable of its own.
    const std::string name = temporaryName(parameter.name.empty() ? "result" : parameter.name);
    const bool readsOld = parameter.direction == ast::Direction::InOut;
    const typed::Expr *vector = nullptr;
    const std::vector<std::uint8_t> parts = components(*args[i], vector);
    const bool isPart = parts.size() > 1;
    const std::string where = place(isPart ? *vector : *args[i], !indexEffects(*args[i]).isPure()).text;
    before->push_back(readsOld ? fmt::format("{} {} = {};", module.type(parameter.type), name,
                                             isPart ? argument(*args[i]) : where)
                               : fmt::format("{} {}{{}};", module.type(parameter.type), name));
    texts.push_back(name);
    if (!isPart)
      after.push_back(where + " = " + name + ";");
    for (std::size_t part = 0; isPart && part < parts.size(); ++part)
      after.push_back(fmt::format("{}.{} = {}.{};", where, "xyzw"[parts[part]], name, "xyzw"[part]));
  }

  const std::string call = callee + "(" + join(texts, ", ") + ")";
  const bool mayEnd = mayEndAnyHit() && module.mayAnswerHit(target);
  if (after.empty() && !mayEnd)
    return {call};
  std::string value;
  if (result->is(TypeKind::Void))
    before->push_back(call + ";");
  else
    value = hoist(result, target.name, call);
  before->insert(before->end(), after.begin(), after.end());
  if (mayEnd)
    leaveIfAnswered();
  return {value};
}

Code FunctionPrinter::call(const typed::CallExpr &expr) {
  const typed::Function &target = *expr.function;
  std::vector<std::string> first;
  if (module.takesState(target))
    first.push_back("rt");
  if (module.takesScratch(target))
    first.push_back("scratch");
  const std::string base = expr.isOfBase ? module.names.of(target.owner) + "::" : std::string();
  return callWith(base + module.names.of(&target), std::move(first), target, expr.args, expr.type);
}

Code FunctionPrinter::methodCall(const typed::MethodCallExpr &expr) {
  const Type *type = expr.receiver->type;
  const std::string className = type->classType ? type->classType->name : type->builtinClass;
  module.useThroughReference(className, expr.method, expr.function);
  const std::string receiver = operand(*expr.receiver, Binding::Primary);
  if (!expr.function)
    return {receiver + "." + expr.method + "(rt)"};
  return callWith(receiver + "." + module.names.of(expr.function), {"rt"}, *expr.function, expr.args, expr.type);
}

} // namespace rtsl::cpp
