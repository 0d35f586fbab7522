#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Casting.h"

#include <fmt/format.h>

namespace rtsl::cpp {

using typed::Builtin;

/// The runtime header's name, where it is not the language's.
static std::string nameInCpp(Builtin builtin) {
  switch (builtin) {
  case Builtin::PowInt:
    return "powi";
  case Builtin::MixSelect:
    return "mixSelect";
  case Builtin::MinComponent:
    return "minComponent";
  case Builtin::MaxComponent:
    return "maxComponent";
  case Builtin::Not:
    return "logicalNot";
  default:
    return typed::name(builtin);
  }
}

// The place comes first; its indices are evaluated with the values.
Code Builtins::atomic(const std::string &callee, const typed::BuiltinExpr &expr) {
  std::vector<const typed::Expr *> values;
  for (std::size_t i = 1; i < expr.args.size(); ++i)
    values.push_back(expr.args[i].get());
  const bool storesIndices = !printer.lvalues.indexEffects(*expr.args.front()).isPure();
  const Code place = printer.lvalues.of(*expr.args.front(), storesIndices);
  std::vector<Code> codes = printer.expressions.operands(values, Binding::Assignment);
  codes.insert(codes.begin(), place);
  return cpp::call(callee, std::move(codes));
}

// Results of `out` parameters follow the operands.
Code Builtins::withOutputs(const std::string &callee, const typed::BuiltinExpr &expr,
                           std::size_t firstOutput) {
  std::vector<const typed::Expr *> inputs;
  for (std::size_t i = 0; i < firstOutput; ++i)
    inputs.push_back(expr.args[i].get());
  std::vector<Code> codes = printer.expressions.operands(inputs, Binding::Assignment);
  Statements after;
  for (std::size_t i = firstOutput; i < expr.args.size(); ++i) {
    const bool isBindable = printer.lvalues.canBind(*expr.args[i]);
    if (isBindable && after.empty()) { // later ones are written last
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
  const Code call = cpp::call(callee, std::move(codes));
  return after.empty() ? call
                       : printer.calls.valueThen(expr.type, typed::name(expr.builtin), call, after);
}

Code Builtins::print(const typed::BuiltinExpr &expr) {
  std::vector<Code> values = printer.expressions.arguments(expr.args);
  values.insert(values.begin(), name("rt"));
  return cpp::call("rtsl::print", std::move(values));
}

// The payload is an `inout` argument in the middle of others: `trace(origin, direction, tmin, tmax,
// payload, root...)`. The ray may write it in its place, for nothing else reads it meanwhile,
// unless what follows it changes it first.
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
  // One after the other, each in a variable.
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

Code Builtins::builtin(const typed::BuiltinExpr &expr) {
  const std::string callee = "rtsl::" + nameInCpp(expr.builtin);
  auto with = [&](std::vector<Code> codes) {
    const std::vector<Code> own = printer.expressions.arguments(expr.args);
    codes.insert(codes.end(), own.begin(), own.end());
    return cpp::call(callee, std::move(codes));
  };
  switch (expr.builtin) {
  case Builtin::Trace:
  case Builtin::Rand:
  case Builtin::RandOpen:
  case Builtin::Ambient:
  case Builtin::LightCount:
  case Builtin::Illuminate:
  case Builtin::IlluminateBySurface:
  case Builtin::VisitChild:
    return with({name("rt")});
  case Builtin::Hit:
    return printer.function && context.signatures.takesScratch(*printer.function)
               ? with({name("rt"), name("scratch")})
               : with({name("rt")});
  case Builtin::TracePayload:
    return tracePayload(expr);
  case Builtin::IgnoreIntersection:
  case Builtin::TerminateRay:
    return printer.hitAnswers.endOfAnyHit(expr);
  case Builtin::Print:
    return context.options.prints ? print(expr) : Code{};
  case Builtin::AtomicAdd:
  case Builtin::AtomicMin:
  case Builtin::AtomicMax:
  case Builtin::AtomicAnd:
  case Builtin::AtomicOr:
  case Builtin::AtomicXor:
  case Builtin::AtomicExchange:
  case Builtin::AtomicCompSwap:
    return atomic(callee, expr);
  default:
    if (typed::info(expr.builtin).effect == typed::BuiltinEffect::Outputs)
      return withOutputs(callee, expr, typed::outputsOf(expr.builtin).first);
    return with({});
  }
}

} // namespace rtsl::cpp
