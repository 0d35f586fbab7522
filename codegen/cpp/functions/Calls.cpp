//===- Calls.cpp - calls of the author's functions ------------------------===//
//
// RTSL copies arguments in and results of `out` parameters out, from left to right. C++ passes the
// place itself where that cannot be told apart: nobody else looks at the place during the call.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

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
  const bool isBool = place.type->is(TypeKind::Bool) ||
                      (place.type->isVector() && place.type->element->is(TypeKind::Bool));
  if (auto *component = dynCast<typed::SwizzleExpr>(&place); component && isBool)
    return canBind(*component->base);
  return variable || !isBool;
}

/// What an assignment to the place would write: what it is part of.
static std::set<const void *> writesOf(EffectsOf &effects, const typed::Expr &place) {
  return effects.expression(typed::wholeOf(place)).reads;
}

static bool meet(const std::set<const void *> &a, const std::set<const void *> &b) {
  return std::any_of(a.begin(), a.end(), [&](const void *at) { return b.count(at) != 0; });
}

Code FunctionPrinter::callWith(const Code &callee, std::vector<Code> first,
                               const typed::Function &target,
                               const std::vector<typed::ExprPtr> &args, const Type *result) {
  EffectsOf &effects = context.effects;
  const Effects &inside = effects.function(target);
  auto isOutput = [&](std::size_t i) {
    return target.parameters[i]->direction != ast::Direction::In;
  };

  std::vector<Effects> facts;
  std::vector<std::set<const void *>> roots(args.size());
  for (std::size_t i = 0; i < args.size(); ++i) {
    facts.push_back(isOutput(i) ? indexEffects(*args[i]) : effects.expression(*args[i]));
    if (isOutput(i))
      roots[i] = writesOf(effects, *args[i]);
  }

  std::vector<Code> codes = std::move(first);
  Statements after;
  for (std::size_t i = 0; i < args.size(); ++i) {
    const typed::Variable &parameter = *target.parameters[i];
    bool shows = false; // to a later argument, or the other way round
    for (std::size_t j = i + 1; j < args.size(); ++j)
      shows |= conflicts(facts[i], facts[j]);
    if (!isOutput(i)) {
      Code code = argument(*args[i]);
      if (shows)
        code = hoist(args[i]->type, "argument", code);
      // By reference, beside something that the call changes.
      bool changes = meet(facts[i].reads, inside.writes);
      for (std::size_t j = 0; j < args.size(); ++j)
        changes |= isOutput(j) && meet(facts[i].reads, roots[j]);
      if (!shows && changes && context.signatures.isByReference(parameter, target))
        code = cpp::construct(context.types.of(parameter.type), {code});
      codes.push_back(code);
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
      codes.push_back(place(*args[i], shows));
      continue;
    }
    // Through a variable of its own.
    const std::string variable = temporaryName(parameter.name.empty() ? "result" : parameter.name);
    const bool readsOld = parameter.direction == ast::Direction::InOut;
    const typed::Expr *vector = nullptr;
    const std::vector<std::uint8_t> parts = components(*args[i], vector);
    const bool isPart = parts.size() > 1;
    const Code where = place(isPart ? *vector : *args[i], !indexEffects(*args[i]).isPure());
    const Code old = !readsOld ? list("", {}) : isPart ? argument(*args[i]) : where;
    before->push_back(cpp::declaration(context.types.of(parameter.type), variable, old));
    codes.push_back(name(variable));
    if (isPart)
      assignComponents(where, parts, codes.back(), after);
    else
      after.push_back(statement(cpp::assign(where, codes.back())));
  }

  const Code call = cpp::call(callee, std::move(codes));
  const bool mayEnd = mayEndAnyHit() && context.signatures.mayAnswerHit(target);
  if (after.empty() && !mayEnd)
    return call;
  const Code value = valueThen(result, target.name, call, after);
  if (mayEnd)
    leaveIfAnswered();
  return value;
}

/// A call, what follows it, and the variable that holds its result; nothing if it has none.
Code FunctionPrinter::valueThen(const Type *type, const std::string &hint, const Code &call,
                                const Statements &after) {
  Code value;
  if (type->is(TypeKind::Void))
    before->push_back(statement(call));
  else
    value = hoist(type, hint, call);
  before->insert(before->end(), after.begin(), after.end());
  return value;
}

Code FunctionPrinter::call(const typed::CallExpr &expr) {
  const typed::Function &target = *expr.function;
  std::vector<Code> first;
  if (context.signatures.takesState(target))
    first.push_back(name("rt"));
  if (context.signatures.takesScratch(target))
    first.push_back(name("scratch"));
  const std::string base = expr.isOfBase ? context.names.of(target.owner) + "::" : std::string();
  return callWith(name(base + context.names.of(&target)), std::move(first), target, expr.args,
                  expr.type);
}

Code FunctionPrinter::methodCall(const typed::MethodCallExpr &expr) {
  const Type *type = expr.receiver->type;
  const std::string className = type->classType ? type->classType->name : type->builtinClass;
  context.required.callThroughReference(className, expr.method, expr.function);
  const Code receiver = operand(*expr.receiver, Binding::Primary);
  if (!expr.function)
    return callMember(receiver, expr.method, {name("rt")});
  return callWith(member(receiver, context.names.of(expr.function)), {name("rt")}, *expr.function,
                  expr.args, expr.type);
}

} // namespace rtsl::cpp
