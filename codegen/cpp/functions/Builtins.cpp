#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Casting.h"

#include <fmt/format.h>

namespace rtsl::cpp {

using typed::Builtin;

/// The function of the runtime header.
static std::string calleeOf(Builtin builtin) {
  switch (builtin) {
#define RTSL_BUILTIN(...)
#define RTSL_NAME_IN_CPP(id, name)                                                                 \
  case Builtin::id:                                                                                \
    return "rtsl::" name;
#include "language/Builtins.def"
  default:
    return std::string("rtsl::") + typed::name(builtin);
  }
}

// The lvalue is the first argument; its indices are evaluated together with the values.
Code Builtins::atomic(const typed::BuiltinExpr &expr) {
  std::vector<const typed::Expr *> values;
  for (std::size_t i = 1; i < expr.args.size(); ++i)
    values.push_back(expr.args[i].get());
  const bool storesIndices = !printer.lvalues.indexEffects(*expr.args.front()).isPure();
  const Code place = printer.lvalues.of(*expr.args.front(), storesIndices);
  std::vector<Code> codes = printer.expressions.operands(values, Binding::Assignment);
  codes.insert(codes.begin(), place);
  return cpp::call(calleeOf(expr.builtin), std::move(codes));
}

// Results of `out` parameters follow the operands.
Code Builtins::withOutputs(const typed::BuiltinExpr &expr) {
  const std::size_t firstOutput = typed::outputsOf(expr.builtin).first;
  std::vector<const typed::Expr *> inputs;
  for (std::size_t i = 0; i < firstOutput; ++i)
    inputs.push_back(expr.args[i].get());
  std::vector<Code> codes = printer.expressions.operands(inputs, Binding::Assignment);
  Statements after;
  for (std::size_t i = firstOutput; i < expr.args.size(); ++i) {
    const bool isBindable = printer.lvalues.canBind(*expr.args[i]);
    // Outputs are written in order: after one through a temporary variable, none is bound.
    if (isBindable && after.empty()) {
      codes.push_back(
          printer.lvalues.of(*expr.args[i], !printer.lvalues.indexEffects(*expr.args[i]).isPure()));
      continue;
    }
    const std::string result = printer.temporaryName("result");
    printer.before->push_back(
        cpp::declaration(context.types.of(expr.args[i]->type), result, list("", {})));
    codes.push_back(name(result));
    if (isBindable) {
      after.push_back(
          statement(cpp::assign(printer.lvalues.of(*expr.args[i], true), name(result))));
      continue;
    }
    const typed::Expr *vector = nullptr;
    const std::vector<std::uint8_t> parts = printer.lvalues.components(*expr.args[i], vector);
    printer.assignments.assignComponents(printer.lvalues.of(*vector, true), parts, name(result),
                                         after);
  }
  const Code call = cpp::call(calleeOf(expr.builtin), std::move(codes));
  return after.empty() ? call
                       : printer.calls.valueThen(expr.type, typed::name(expr.builtin), call, after);
}

Code Builtins::print(const typed::BuiltinExpr &expr) {
  if (!context.options.prints)
    return {};
  std::vector<Code> values = printer.expressions.arguments(expr.args);
  values.insert(values.begin(), name("rt"));
  return cpp::call("rtsl::print", std::move(values));
}

// The payload is an `inout` argument in the middle of others: `trace(origin, direction, tmin, tmax,
// payload, root...)`. The ray may write the original, because nothing else reads it during the
// trace, unless a later argument changes it first.
Code Builtins::tracePayload(const typed::BuiltinExpr &expr) {
  constexpr std::size_t at = 4;
  const typed::Expr &payload = *expr.args[at];
  const typed::Effects indices = printer.lvalues.indexEffects(payload);
  bool isChanged = false;
  std::vector<const typed::Expr *> inputs;
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    if (i == at)
      continue;
    inputs.push_back(expr.args[i].get());
    const typed::Effects effects = context.effects.expression(*expr.args[i]);
    isChanged |= conflicts(effects, indices) ||
                 (i > at && conflicts(effects, context.effects.expression(payload)));
  }
  auto trace = [](std::vector<Code> codes) {
    codes.insert(codes.begin(), name("rt"));
    return cpp::call("rtsl::trace", std::move(codes));
  };
  if (!isChanged) {
    std::vector<Code> codes = printer.expressions.operands(inputs, Binding::Assignment);
    codes.insert(codes.begin() + at, printer.lvalues.of(payload, !indices.isPure()));
    return trace(std::move(codes));
  }
  // The arguments are evaluated in order, each into a variable.
  std::vector<Code> codes;
  Code where;
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    if (i != at) {
      codes.push_back(printer.hoist(expr.args[i]->type, "argument",
                                    printer.expressions.argument(*expr.args[i])));
      continue;
    }
    where = printer.lvalues.of(payload, true);
    const std::string copy = printer.temporaryName("payload");
    printer.before->push_back(cpp::declaration(context.types.of(payload.type), copy, where));
    codes.push_back(name(copy));
  }
  printer.before->push_back(statement(trace(codes)));
  printer.before->push_back(statement(cpp::assign(where, codes[at])));
  return {};
}

Code Builtins::hit(const typed::BuiltinExpr &expr) {
  const bool takesScratch = printer.function && context.signatures.takesScratch(*printer.function);
  return takesScratch ? callWith({name("rt"), name("scratch")}, expr) : withRay(expr);
}

Code Builtins::hitAnswer(const typed::BuiltinExpr &expr) {
  return printer.hitAnswers.endOfAnyHit(expr);
}

Code Builtins::withRay(const typed::BuiltinExpr &expr) {
  return callWith({name("rt")}, expr);
}

Code Builtins::callWith(std::vector<Code> first, const typed::BuiltinExpr &expr) {
  const std::vector<Code> own = printer.expressions.arguments(expr.args);
  first.insert(first.end(), own.begin(), own.end());
  return cpp::call(calleeOf(expr.builtin), std::move(first));
}

Code Builtins::builtin(const typed::BuiltinExpr &expr) {
  switch (expr.builtin) {
#define RTSL_BUILTIN(...)
#define RTSL_RAY_BUILTIN(id, name, effects, cost, where, lowering, printing, ...)                  \
  case Builtin::id:                                                                                \
    return printing(expr);
#include "language/Builtins.def"
  default:
    return typed::has(expr.builtin, typed::effect::Outputs) ? withOutputs(expr)
                                                            : callWith({}, expr);
  }
}

} // namespace rtsl::cpp
