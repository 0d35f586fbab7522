//===- CheckSpecialCall.cpp - calls that no signature describes -----------===//
#include "sema/check/FunctionChecker.h"
#include "sema/check/Suggest.h"

#include <fmt/format.h>

namespace rtsl {

using typed::Builtin;
using typed::ExprPtr;

/// `trace(origin, direction, tmin, tmax, payload [, root, mask, time])`.
ExprPtr FunctionChecker::checkTracePayload(const ast::CallExpr &expr) {
  const Type *vec3 = types.vector(types.floatType, 3);
  struct Parameter {
    const char *name;
    const Type *type; // null: the payload
  };
  const Parameter parameters[] = {{"origin", vec3},          {"direction", vec3},
                                  {"tmin", types.floatType}, {"tmax", types.floatType},
                                  {"payload", nullptr},      {"root", types.intType},
                                  {"mask", types.uintType},  {"time", types.floatType}};
  const std::size_t count = expr.args.size();
  constexpr std::size_t payloadIndex = 4;
  if (count < 5 || count > 8) {
    diagnostics.report(Code::badTrace, expr.callee.range, count)
        .note("`color trace(vec3 origin, vec3 direction)`")
        .note("`void trace(vec3 origin, vec3 direction, float tmin, float tmax, inout P payload [, "
              "int root, uint "
              "mask, float time])`");
    for (const ast::ExprPtr &arg : expr.args)
      checkExpr(*arg);
    return errorExpr(expr.range);
  }
  if (!recordSpecial(Ability::Trace, "trace", expr.callee.range))
    return errorExpr(expr.range);
  auto node = makeExpr<typed::BuiltinExpr>(types.voidType, expr.range);
  node->builtin = Builtin::TracePayload;
  bool broken = false;
  for (std::size_t i = 0; i != count; ++i) {
    ExprPtr arg = checkValue(*expr.args[i], i == payloadIndex ? Access::ReadWrite : Access::Read);
    if (arg->type->isError()) {
      broken = true;
    } else if (i == payloadIndex) {
      if (!arg->type->is(TypeKind::Struct)) {
        diagnostics.report(Code::payloadNotAStruct, arg->range, toString(arg->type));
        broken = true;
      } else {
        broken |= !requireTarget(*expr.args[i], *arg, "write to");
      }
    } else if (implicitConversion(arg->type, parameters[i].type) == Conversion::None) {
      Diagnostic &diagnostic =
          diagnostics.report(Code::badArgument, arg->range, i + 1, "trace",
                             toString(parameters[i].type), toString(arg->type));
      diagnostic.note(std::string("this is the parameter `") + parameters[i].name + "`");
      explainConversion(diagnostic, *arg, parameters[i].type);
      broken = true;
    } else {
      arg = convertImplicitly(std::move(arg), parameters[i].type);
    }
    node->args.push_back(std::move(arg));
  }
  return broken ? errorExpr(expr.range) : std::move(node);
}

/// Is it an int or uint in an element of a buffer, and no component of a vector?
static bool isWordOfBuffer(const typed::Expr &place) {
  const typed::Expr *at = &place;
  while (true) {
    if (const auto *field = dynCast<typed::FieldExpr>(at)) {
      at = field->base.get();
    } else if (const auto *index = dynCast<typed::IndexExpr>(at)) {
      if (index->base->type->is(TypeKind::Buffer))
        return true;
      if (!index->base->type->is(TypeKind::Array))
        return false;
      at = index->base.get();
    } else {
      return false;
    }
  }
}

static bool isComponent(const typed::Expr &place) {
  const auto *index = dynCast<typed::IndexExpr>(&place);
  return place.kind == typed::ExprKind::Swizzle || (index && index->base->type->isVector());
}

/// `atomicAdd(counts[i], 1)`: the old value.
ExprPtr FunctionChecker::checkAtomic(const ast::CallExpr &expr, Builtin atomic) {
  const std::size_t count = typed::parameterCount(atomic);
  if (expr.args.size() != count) {
    diagnostics.report(Code::wrongArgumentCount, expr.range, expr.callee.text,
                       fmt::format("{} arguments", count), expr.args.size());
    for (const ast::ExprPtr &arg : expr.args)
      checkExpr(*arg);
    return errorExpr(expr.range);
  }
  ExprPtr place = checkValue(*expr.args.front(), Access::ReadWrite);
  const Type *type = place->type;
  bool isBroken = type->isError();
  if (!isBroken &&
      (!isWordOfBuffer(*place) || !(type->is(TypeKind::Int) || type->is(TypeKind::UInt)))) {
    Diagnostic &diagnostic = diagnostics.report(Code::badAtomic, place->range, expr.callee.text);
    if (type->is(TypeKind::Float))
      diagnostic.note("a sum of floats would depend on the order; add whole numbers, such as "
                      "`int(round(value * 65536.0))`");
    else if (isComponent(*place))
      diagnostic.note("a component of a vector cannot be changed in one step; use an array");
    isBroken = true;
  }
  isBroken = isBroken || !requireTarget(*expr.args.front(), *place, "write to");
  auto node = makeExpr<typed::BuiltinExpr>(type, expr.range);
  node->builtin = atomic;
  node->args.push_back(std::move(place));
  for (std::size_t i = 1; i != count; ++i) {
    ExprPtr value = checkValue(*expr.args[i]);
    if (!isBroken)
      value = coerce(std::move(value), type);
    isBroken = isBroken || value->type->isError();
    node->args.push_back(std::move(value));
  }
  return isBroken ? errorExpr(expr.range) : std::move(node);
}

ExprPtr FunctionChecker::checkPrint(const ast::CallExpr &expr) {
  auto node = makeExpr<typed::BuiltinExpr>(types.voidType, expr.range);
  node->builtin = Builtin::Print;
  bool broken = false;
  for (const ast::ExprPtr &argument : expr.args) {
    ExprPtr arg = checkExpr(*argument);
    const Type *type = arg->type;
    if (type->isError()) {
      broken = true;
    } else if (!type->scalar() && !type->is(TypeKind::Color) && !type->is(TypeKind::String)) {
      diagnostics.report(Code::cannotPrint, arg->range, toString(type))
          .note("`print` takes text, numbers, vectors, matrices and colors");
      broken = true;
    }
    node->args.push_back(std::move(arg));
  }
  return broken ? errorExpr(expr.range) : std::move(node);
}

} // namespace rtsl
