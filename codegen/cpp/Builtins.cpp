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
    if (canBind(*expr.args[i])) {
      texts.push_back(place(*expr.args[i], !indexEffects(*expr.args[i]).isPure()).text);
      continue;
    }
    const std::string name = temporaryName("result");
    before->push_back(fmt::format("{} {}{{}};", module.type(expr.args[i]->type), name));
    texts.push_back(name);
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
  case Builtin::Ambient:
    return withState();
  case Builtin::Hit:
    return withState(function && module.takesScratch(*function) ? "scratch" : "");
  case Builtin::TracePayload:
    module.unsupported(expr.range, "`trace` with a payload in C++");
    return {"0"};
  case Builtin::IgnoreIntersection:
  case Builtin::TerminateRay:
  case Builtin::VisitChild:
  case Builtin::Print:
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
