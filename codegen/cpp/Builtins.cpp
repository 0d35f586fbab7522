//===- Builtins.cpp - built-in functions ----------------------------------===//
#include "codegen/cpp/Printer.h"

#include "sema/Casting.h"

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

// Results of `out` parameters, behind the operands.
Code FunctionPrinter::withOutputs(const std::string &callee, const typed::BuiltinExpr &expr,
                                  std::size_t firstOutput) {
  std::vector<const typed::Expr *> inputs;
  for (std::size_t i = 0; i < firstOutput; ++i)
    inputs.push_back(expr.args[i].get());
  std::vector<std::string> texts = operands(inputs, Binding::Assignment);
  std::vector<std::string> after;
  for (std::size_t i = firstOutput; i < expr.args.size(); ++i) {
    const bool isBindable = canBind(*expr.args[i]);
    if (isBindable && after.empty()) { // later ones are written last
      texts.push_back(place(*expr.args[i], !indexEffects(*expr.args[i]).isPure()).text);
      continue;
    }
    const std::string name = temporaryName("result");
    before->push_back(fmt::format("{} {}{{}};", module.type(expr.args[i]->type), name));
    texts.push_back(name);
    if (isBindable) {
      after.push_back(place(*expr.args[i], true).text + " = " + name + ";");
      continue;
    }
    const typed::Expr *vector = nullptr;
    const std::vector<std::uint8_t> parts = components(*expr.args[i], vector);
    const std::string where = place(*vector, true).text;
    for (std::size_t part = 0; part < parts.size(); ++part)
      after.push_back(fmt::format("{}.{} = {}.{};", where, "xyzw"[parts[part]], name, "xyzw"[part]));
  }
  const std::string call = callee + "(" + join(texts, ", ") + ")";
  if (after.empty())
    return {call};
  std::string value;
  if (expr.type->is(TypeKind::Void))
    before->push_back(call + ";");
  else
    value = hoist(expr.type, typed::name(expr.builtin), call);
  before->insert(before->end(), after.begin(), after.end());
  return {value};
}

Code FunctionPrinter::print(const typed::BuiltinExpr &expr) {
  std::vector<const typed::Expr *> values;
  for (const typed::ExprPtr &arg : expr.args)
    values.push_back(arg.get());
  return {"rtsl::print(rt, " + join(operands(values, Binding::Assignment), ", ") + ")"};
}

// The payload is an `inout` argument in the middle of others: `trace(origin, direction, tmin, tmax, payload, root...)`. The
// ray may write it in its place, for nobody looks at it meanwhile, unless what stands behind it changes it first.
Code FunctionPrinter::tracePayload(const typed::BuiltinExpr &expr) {
  constexpr std::size_t at = 4;
  const typed::Expr &payload = *expr.args[at];
  const Effects indices = indexEffects(payload);
  bool isChanged = false;
  std::vector<const typed::Expr *> inputs;
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    if (i == at)
      continue;
    inputs.push_back(expr.args[i].get());
    const Effects effects = module.effects.expression(*expr.args[i]);
    isChanged |= conflicts(effects, indices) || (i > at && conflicts(effects, module.effects.expression(payload)));
  }
  if (!isChanged) {
    std::vector<std::string> texts = operands(inputs, Binding::Assignment);
    texts.insert(texts.begin() + at, place(payload, !indices.isPure()).text);
    return {"rtsl::trace(rt, " + join(texts, ", ") + ")"};
  }
  // One after the other, each in a variable.
  std::vector<std::string> texts;
  std::string where;
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    if (i != at) {
      texts.push_back(hoist(expr.args[i]->type, "argument", argument(*expr.args[i])));
      continue;
    }
    where = place(payload, true).text;
    texts.push_back(temporaryName("payload"));
    before->push_back(fmt::format("{} {} = {};", module.type(payload.type), texts.back(), where));
  }
  before->push_back("rtsl::trace(rt, " + join(texts, ", ") + ");");
  before->push_back(where + " = " + texts[at] + ";");
  return {};
}

Code FunctionPrinter::builtin(const typed::BuiltinExpr &expr) {
  const std::string callee = "rtsl::" + nameInCpp(expr.builtin);
  auto withState = [&](const std::string &more = "") {
    std::vector<std::string> texts = {"rt"};
    if (!more.empty())
      texts.push_back(more);
    for (std::string &text : arguments(expr.args))
      texts.push_back(std::move(text));
    return Code{callee + "(" + join(texts, ", ") + ")"};
  };
  switch (expr.builtin) {
  case Builtin::Trace:
  case Builtin::Rand:
  case Builtin::RandOpen:
  case Builtin::Ambient:
  case Builtin::LightCount:
  case Builtin::Illuminate:
    return withState();
  case Builtin::Hit:
    return withState(function && module.takesScratch(*function) ? "scratch" : "");
  case Builtin::TracePayload:
    return tracePayload(expr);
  case Builtin::IgnoreIntersection:
  case Builtin::TerminateRay:
    return endOfAnyHit(expr);
  case Builtin::Print:
    return module.options.prints ? print(expr) : Code{};
  case Builtin::VisitChild:
    module.unsupported(expr.range, std::string("`") + typed::name(expr.builtin) + "` in C++");
    return {"0"};
  case Builtin::Modf:
  case Builtin::Frexp:
    return withOutputs(callee, expr, 1);
  case Builtin::UaddCarry:
  case Builtin::UsubBorrow:
  case Builtin::UmulExtended:
  case Builtin::ImulExtended:
    return withOutputs(callee, expr, 2);
  default:
    return {callee + "(" + join(arguments(expr.args), ", ") + ")"};
  }
}

} // namespace rtsl::cpp
