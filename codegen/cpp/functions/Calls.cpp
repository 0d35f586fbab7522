#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using typed::ExprKind;

/// What an assignment to the lvalue would write: the whole variable that it is part of.
static std::set<const void *> writesOf(typed::EffectsOf &effects, const typed::Expr &place) {
  return effects.expression(typed::wholeOf(place)).reads;
}

static bool meet(const std::set<const void *> &a, const std::set<const void *> &b) {
  return std::any_of(a.begin(), a.end(), [&](const void *at) { return b.count(at) != 0; });
}

Code Calls::callWith(const Code &callee, std::vector<Code> first, const typed::Function &target,
                     const std::vector<typed::ExprPtr> &args, const Type *result) {
  typed::EffectsOf &effects = context.effects;
  const typed::Effects &inside = effects.function(target);
  auto isOutput = [&](std::size_t i) {
    return target.parameters[i]->direction != ast::Direction::In;
  };

  std::vector<typed::Effects> facts;
  std::vector<std::set<const void *>> roots(args.size());
  for (std::size_t i = 0; i < args.size(); ++i) {
    facts.push_back(isOutput(i) ? printer.lvalues.indexEffects(*args[i])
                                : effects.expression(*args[i]));
    if (isOutput(i))
      roots[i] = writesOf(effects, *args[i]);
  }

  std::vector<Code> codes = std::move(first);
  Statements after;
  for (std::size_t i = 0; i < args.size(); ++i) {
    const typed::Variable &parameter = *target.parameters[i];
    bool shows = false; // whether it and a later argument affect each other
    for (std::size_t j = i + 1; j < args.size(); ++j)
      shows |= conflicts(facts[i], facts[j]);
    if (!isOutput(i)) {
      Code code = printer.expressions.argument(*args[i]);
      if (shows)
        code = printer.hoist(args[i]->type, "argument", code);
      // Passed by reference although the call may change the original.
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
    if (printer.lvalues.canBind(*args[i]) && !isShared) {
      codes.push_back(printer.lvalues.of(*args[i], shows));
      continue;
    }
    // The argument is passed through a temporary variable.
    const std::string variable =
        printer.temporaryName(parameter.name.empty() ? "result" : parameter.name);
    const bool readsOld = parameter.direction == ast::Direction::InOut;
    const typed::Expr *vector = nullptr;
    const std::vector<std::uint8_t> parts = printer.lvalues.components(*args[i], vector);
    const bool isPart = parts.size() > 1;
    const Code where = printer.lvalues.of(isPart ? *vector : *args[i],
                                          !printer.lvalues.indexEffects(*args[i]).isPure());
    const Code old = !readsOld ? list("", {})
                     : isPart  ? printer.expressions.argument(*args[i])
                               : where;
    printer.before->push_back(cpp::declaration(context.types.of(parameter.type), variable, old));
    codes.push_back(name(variable));
    if (isPart)
      printer.assignments.assignComponents(where, parts, codes.back(), after);
    else
      after.push_back(statement(cpp::assign(where, codes.back())));
  }

  const Code call = cpp::call(callee, std::move(codes));
  const bool mayEnd = printer.hitAnswers.mayEndAnyHit() && context.signatures.mayAnswerHit(target);
  if (after.empty() && !mayEnd)
    return call;
  const Code value = valueThen(result, target.name, call, after);
  if (mayEnd)
    printer.hitAnswers.leaveIfAnswered();
  return value;
}

/// Emits a call and the statements `after` it. Returns the variable with its result; null if it has
/// none.
Code Calls::valueThen(const Type *type, const std::string &hint, const Code &call,
                      const Statements &after) {
  Code value;
  if (type->is(TypeKind::Void))
    printer.before->push_back(statement(call));
  else
    value = printer.hoist(type, hint, call);
  printer.before->insert(printer.before->end(), after.begin(), after.end());
  return value;
}

Code Calls::call(const typed::CallExpr &expr) {
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

Code Calls::methodCall(const typed::MethodCallExpr &expr) {
  const Type *type = expr.receiver->type;
  const std::string className = type->classType ? type->classType->name : type->builtinClass;
  context.required.callThroughReference(className, expr.method, expr.function);
  const Code receiver = printer.expressions.operand(*expr.receiver, Binding::Primary);
  if (!expr.function)
    return callMember(receiver, expr.method, {name("rt")});
  return callWith(member(receiver, context.names.of(expr.function)), {name("rt")}, *expr.function,
                  expr.args, expr.type);
}

} // namespace rtsl::cpp
