#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace rtsl::cpp {

/// In C++ the sign of a number is an operator, and infinities and NaNs have names.
template <typename Number>
static Code numberLiteral(Number value, const char *type, const char *infinity,
                          const char *suffix) {
  if (std::isnan(value))
    return call(fmt::format("std::numeric_limits<{}>::quiet_NaN", type), {});
  if (std::signbit(value))
    return unary(UnaryOperator::Minus, numberLiteral(-value, type, infinity, suffix));
  if (std::isinf(value))
    return name(infinity);
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos)
    text += ".0";
  return literal(text + suffix, value == 0);
}

Code floatLiteral(float value) {
  return numberLiteral(value, "float", "rtsl::infinity", "f");
}

Code doubleLiteral(double value) {
  return numberLiteral(value, "double", "std::numeric_limits<double>::infinity()", "");
}

/// `1.` and `.5` as C++ programmers write them.
static std::string inCpp(const std::string &spelling) {
  std::string text = spelling;
  if (text.front() == '.')
    text.insert(0, "0");
  const std::size_t point = text.find('.');
  if (point != std::string::npos &&
      (point + 1 == text.size() || !std::isdigit(static_cast<unsigned char>(text[point + 1]))))
    text.insert(point + 1, "0");
  if (text.find_first_of(".eE") == std::string::npos)
    text += ".0";
  return text + "f";
}

/// A literal of an author, without its sign.
static Code withSign(const std::string &spelling,
                     const std::function<Code(const std::string &)> &make) {
  return spelling.front() == '-' ? unary(UnaryOperator::Minus, make(spelling.substr(1)))
                                 : make(spelling);
}

static bool sameValue(const typed::Constant &a, const typed::Constant &b) {
  return a.scalars.size() == b.scalars.size() &&
         std::equal(a.scalars.begin(), a.scalars.end(), b.scalars.begin(),
                    [](typed::Constant::Scalar x, typed::Constant::Scalar y) {
                      return x.u == y.u || x.b == y.b;
                    });
}

// The checker replaces names of constants by their values. The name is still in the source text,
// and means the same in C++: the nearest constant of that name.
const void *Literals::namedConstant(const typed::LiteralExpr &expr) const {
  if (!expr.spelling.empty())
    return nullptr;
  const std::string name = context.notes.identifier(expr.range);
  if (name.empty() || name == "true" || name == "false")
    return nullptr;
  auto isIt = [&](const auto &constant) {
    return constant.name == name && constant.isConst && constant.type == expr.type &&
           constant.constant && sameValue(*constant.constant, expr.value);
  };
  if (printer.function)
    for (const auto &local : printer.function->locals)
      if (isIt(*local))
        return local.get();
  for (const typed::Class *at = printer.owner; at; at = at->base)
    for (const auto &member : at->members)
      if (isIt(*member))
        return member.get();
  for (const auto &constant : context.module.constants)
    if (isIt(*constant))
      return constant.get();
  return nullptr;
}

/// Whether the expression consists of numbers alone. A constant with a name need not be a constant
/// expression in C++.
bool Literals::isTable(const typed::Expr &expr) const {
  auto isNumber = [&](const typed::Expr &element) {
    auto *literal = dynCast<typed::LiteralExpr>(&element);
    return literal && element.type->isScalar() && !namedConstant(*literal) &&
           (!element.type->is(TypeKind::Float) || std::isfinite(literal->value.scalars.front().f));
  };
  auto *array = dynCast<typed::ConstructExpr>(&expr);
  return array && array->type->is(TypeKind::Array) &&
         std::all_of(array->args.begin(), array->args.end(), [&](const typed::ExprPtr &element) {
           return isNumber(*element) || isTable(*element);
         });
}

Code Literals::scalarLiteral(const Type *type, typed::Constant::Scalar value,
                             const std::string &spelling) {
  switch (type->kind) {
  case TypeKind::Bool:
    return boolean(value.b);
  case TypeKind::Float:
    return spelling.empty() ? floatLiteral(value.f)
                            : withSign(spelling, [&](const std::string &text) {
                                return cpp::literal(inCpp(text), value.f == 0);
                              });
  case TypeKind::UInt: {
    std::string text = spelling.empty() ? std::to_string(value.u) : spelling;
    while (!text.empty() && (text.back() == 'u' || text.back() == 'U'))
      text.pop_back();
    return cpp::literal(text + "u", value.u == 0);
  }
  default:
    if (spelling.empty() || value.i == std::numeric_limits<std::int32_t>::min())
      return integer(value.i);
    if (value.i < 0 && spelling.front() == '0') // the literal gives the 32 bits
      return cpp::construct("int", {cpp::literal(spelling + "u")});
    return withSign(spelling,
                    [&](const std::string &text) { return cpp::literal(text, value.i == 0); });
  }
}

Code Literals::literal(const Type *type, const typed::Constant &constant,
                       const std::string &spelling) {
  if (type->isScalar())
    return scalarLiteral(type, constant.scalars.front(), spelling);
  std::size_t next = 0;
  std::function<Code(const Type *)> part = [&](const Type *at) -> Code {
    if (at->isScalar())
      return scalarLiteral(at, constant.scalars[next++], "");
    std::vector<Code> parts;
    if (at->is(TypeKind::Struct)) {
      for (const typed::Field &field : at->structure->fields)
        parts.push_back(inMemory(field.type, part(field.type)));
      return list(context.types.of(at), std::move(parts));
    }
    if (at->is(TypeKind::Array)) {
      for (unsigned i = 0; i < at->count; ++i)
        parts.push_back(inMemory(at->element, part(at->element)));
      return array(context.types.of(at), std::move(parts));
    }
    const std::size_t count =
        at->is(TypeKind::Color) ? constant.scalars.size() : at->componentCount();
    const Type *scalar = at->is(TypeKind::Color) ? nullptr : at->scalar();
    for (std::size_t i = 0; i < count; ++i)
      parts.push_back(scalar ? scalarLiteral(scalar, constant.scalars[next++], "")
                             : floatLiteral(constant.scalars[next++].f));
    if (at->is(TypeKind::Color))
      return context.types.color(std::move(parts));
    return cpp::construct(context.types.of(at), std::move(parts));
  };
  return part(type);
}

/// An initialiser of a field or an element: a bool needs 32 bits there.
Code Literals::inMemory(const Type *type, Code value) {
  return type->is(TypeKind::Bool) ? cpp::construct("rtsl::Bool", {std::move(value)}) : value;
}

} // namespace rtsl::cpp
