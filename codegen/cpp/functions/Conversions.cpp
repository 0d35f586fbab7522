#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Casting.h"

#include <algorithm>

namespace rtsl::cpp {

using typed::ExprKind;

Code Conversions::convert(const typed::ConvertExpr &expr) {
  const typed::Expr &operand = *expr.operand;
  const Type *from = operand.type, *to = expr.type;
  if (to->is(TypeKind::Class)) {
    const std::string target = context.types.of(to);
    if (target == context.types.of(from))
      return printer.expressions.expr(operand);
    return cpp::construct(target, {member(printer.expressions.expr(operand), "object")});
  }
  if (from->is(TypeKind::Class)) // to a bool
    return cpp::binary(Operator::NotEqual, member(printer.expressions.expr(operand), "object"),
                       integer(0));
  const Type *fromScalar = from->scalar(), *toScalar = to->scalar();
  if (!fromScalar || !toScalar || fromScalar == toScalar)
    return printer.expressions.expr(operand);

  // An integer literal that is converted implicitly to float or uint.
  const bool isWritten = !expr.isImplicit && !(expr.range == operand.range);
  if (auto *value = dynCast<typed::LiteralExpr>(&operand);
      value && !isWritten && from->isScalar() && !printer.literals.namedConstant(*value)) {
    typed::Constant::Scalar scalar = value->value.scalars.front();
    if (toScalar->is(TypeKind::Float) && !fromScalar->is(TypeKind::Bool)) {
      scalar.f = fromScalar->is(TypeKind::Int) ? static_cast<float>(scalar.i)
                                               : static_cast<float>(scalar.u);
      return printer.literals.scalarLiteral(toScalar, scalar, "");
    }
    if (toScalar->is(TypeKind::UInt) && fromScalar->is(TypeKind::Int) && scalar.i >= 0)
      return printer.literals.scalarLiteral(toScalar, scalar, value->spelling);
  }

  if (toScalar->is(TypeKind::Bool)) {
    const Code zero = printer.literals.scalarLiteral(fromScalar, typed::Constant::Scalar{}, "");
    if (to->isVector())
      return cpp::call("rtsl::notEqual", {printer.expressions.argument(operand), zero});
    return cpp::binary(Operator::NotEqual, printer.expressions.operand(operand, Binding::Relation),
                       zero);
  }
  if (fromScalar->is(TypeKind::Float))
    return cpp::call(toScalar->is(TypeKind::Int) ? "rtsl::toInt" : "rtsl::toUint",
                     {printer.expressions.argument(operand)});
  return cpp::construct(context.types.of(to), {printer.expressions.argument(operand)});
}

Code Conversions::construct(const typed::ConstructExpr &expr) {
  const Type *type = expr.type;
  const std::string typeName = type->is(TypeKind::Class) ? "" : context.types.of(type);
  const typed::Expr &first = *expr.args.front();

  // An initialiser list in braces is evaluated in order.
  if (type->is(TypeKind::Struct) || type->is(TypeKind::Array)) {
    std::vector<Code> parts;
    for (std::size_t i = 0; i < expr.args.size(); ++i) {
      const Type *part =
          type->is(TypeKind::Struct) ? type->structure->fields[i].type : type->element;
      parts.push_back(printer.literals.inMemory(
          part, printer.expressions.apart(*expr.args[i], Binding::Assignment)));
    }
    return type->is(TypeKind::Array) ? array(typeName, std::move(parts))
                                     : list(typeName, std::move(parts));
  }
  if (type->is(TypeKind::Class) || first.type == type)
    return printer.expressions.expr(first);
  if (type->isScalar()) { // the first component is converted
    if (first.type->isMatrix())
      return subscript(subscript(printer.expressions.operand(first, Binding::Primary), integer(0)),
                       integer(0));
    return printer.lvalues.isSimple(first)
               ? component(printer.lvalues.of(first), 0)
               : cpp::call("rtsl::part<0>", {printer.expressions.argument(first)});
  }
  std::vector<Code> args = printer.expressions.arguments(expr.args);
  if (type->is(TypeKind::Color))
    return context.types.color(std::move(args));

  std::size_t scalars = 0;
  bool hasMatrix = false, onlyScalars = true, onlyColumns = type->isMatrix();
  for (const typed::ExprPtr &arg : expr.args) {
    scalars += arg->type->componentCount();
    hasMatrix |= arg->type->isMatrix();
    onlyScalars &= arg->type->isScalar();
    onlyColumns &= type->isMatrix() && arg->type == type->element;
  }
  if (type->isMatrix()) {
    if (expr.args.size() == 1 && hasMatrix)
      return cpp::call(withParameters("rtsl::resize", {typeName}), std::move(args));
    if (onlyColumns || onlyScalars)
      return cpp::construct(typeName, std::move(args));
    return cpp::call(withParameters("rtsl::matrixOf", {typeName}), std::move(args));
  }
  const bool isExact = scalars == type->count && !hasMatrix;
  // One argument sets all components, or is a longer vector whose first components are taken.
  const bool isOne = expr.args.size() == 1 && !hasMatrix;
  if (isExact || isOne)
    return cpp::construct(typeName, std::move(args));
  return cpp::call(withParameters("rtsl::vectorOf", {typeName}), std::move(args));
}

Code Conversions::swizzle(const typed::SwizzleExpr &expr) {
  const typed::Expr &base = *expr.base;
  if (base.type->isScalar()) {
    if (expr.components.size() == 1)
      return printer.expressions.expr(base);
    return cpp::construct(context.types.of(expr.type), {printer.expressions.argument(base)});
  }
  const typed::Expr *vector = nullptr;
  std::vector<std::uint8_t> parts = printer.lvalues.components(expr, vector);
  if (parts.empty()) {
    vector = &base;
    parts = expr.components;
  }
  // The first components of a longer vector, or all of it.
  bool isPrefix = parts.size() > 1;
  for (std::size_t i = 0; i < parts.size(); ++i)
    isPrefix &= parts[i] == i;
  if (isPrefix)
    return cpp::construct(context.types.of(expr.type), {printer.expressions.argument(*vector)});
  if (parts.size() == 1 && !dynCast<typed::ConvertExpr>(vector))
    return component(printer.expressions.operand(*vector, Binding::Primary), parts[0]);
  if (printer.lvalues.isSimple(*vector)) {
    const bool isRepeated =
        std::all_of(parts.begin(), parts.end(), [&](std::uint8_t at) { return at == parts[0]; });
    std::vector<Code> codes;
    for (std::uint8_t part : parts)
      if (codes.empty() || !isRepeated)
        codes.push_back(component(printer.lvalues.of(*vector), part));
    return parts.size() == 1 ? codes.front()
                             : cpp::construct(context.types.of(expr.type), std::move(codes));
  }
  std::vector<std::string> numbers;
  for (std::uint8_t part : parts)
    numbers.push_back(std::to_string(part));
  return cpp::call(withParameters(parts.size() == 1 ? "rtsl::part" : "rtsl::swizzle", numbers),
                   {printer.expressions.argument(*vector)});
}

} // namespace rtsl::cpp
