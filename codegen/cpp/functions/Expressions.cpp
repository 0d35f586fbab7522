//===- Expressions.cpp - expressions, conversions, constructors -----------===//
#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

using typed::ExprKind;

FunctionPrinter::FunctionPrinter(Context &context, const typed::Function *function,
                                 const typed::Class *owner)
    : context(context), function(function), owner(function ? function->owner : owner) {
  if (!function)
    return;
  for (const auto &parameter : function->parameters)
    usedNames.insert(context.names.of(parameter.get()));
  for (const auto &local : function->locals)
    usedNames.insert(context.names.of(local.get()));
}

Code FunctionPrinter::initialiser(const typed::Expr &expr) {
  return apart(expr, Binding::Assignment);
}

//===----------------------------------------------------------------------===//
// Order
//===----------------------------------------------------------------------===//

std::string FunctionPrinter::temporaryName(const std::string &hint) {
  for (unsigned i = 1;; ++i) {
    std::string name = hint + std::to_string(i);
    if (usedNames.insert(name).second) {
      temporaries.insert(name);
      return name;
    }
  }
}

Code FunctionPrinter::hoist(const Type *type, const std::string &hint, Code value) {
  const std::string variable = temporaryName(hint);
  before->push_back(cpp::declaration("const", context.types.of(type), variable, std::move(value)));
  return name(variable);
}

/// What a variable that holds the expression's value is called: after the first call in it.
static std::string hintFor(const typed::Expr &expr) {
  std::string hint;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (!hint.empty() || !typed::hasSideEffects(inner))
      return;
    if (auto *builtin = dynCast<typed::BuiltinExpr>(&inner))
      hint = typed::name(builtin->builtin);
    else if (auto *call = dynCast<typed::CallExpr>(&inner))
      hint = call->function->name;
    else if (auto *call = dynCast<typed::MethodCallExpr>(&inner))
      hint = call->method;
  });
  if (auto *variable = dynCast<typed::VariableExpr>(&expr))
    hint = variable->variable->name;
  return hint.empty() ? "value" : hint;
}

std::vector<Code> FunctionPrinter::operands(const std::vector<const typed::Expr *> &exprs,
                                            Binding atLeast) {
  std::vector<Effects> all;
  bool anyEffects = false;
  for (const typed::Expr *expr : exprs) {
    all.push_back(context.effects.expression(*expr));
    anyEffects |= !all.back().isPure();
  }
  anyEffects &= isNested;
  std::vector<Code> codes;
  for (std::size_t i = 0; i < exprs.size(); ++i) {
    bool shows = false;
    for (std::size_t later = i + 1; anyEffects && later < exprs.size(); ++later)
      shows |= conflicts(all[i], all[later]);
    codes.push_back(shows ? hoist(exprs[i]->type, hintFor(*exprs[i]), argument(*exprs[i]))
                          : operand(*exprs[i], atLeast));
  }
  return codes;
}

std::vector<Code> FunctionPrinter::arguments(const std::vector<typed::ExprPtr> &exprs) {
  std::vector<const typed::Expr *> pointers;
  for (const typed::ExprPtr &expr : exprs)
    pointers.push_back(expr.get());
  return operands(pointers, Binding::Assignment);
}

Code FunctionPrinter::apart(const typed::Expr &expr, Binding atLeast) {
  Statements *outer = before;
  before = nullptr;
  Code code = operand(expr, atLeast);
  before = outer;
  return code;
}

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

Code FunctionPrinter::operand(const typed::Expr &expr, Binding atLeast) {
  Code code = this->expr(expr);
  // The author's own parentheses stay, where there is something to hold together.
  const bool keeps = code && atLeast > Binding::Or && bindingOf(code) < Binding::Unary &&
                     context.notes.inParentheses(expr.range);
  return keeps ? parentheses(code) : code;
}

Code FunctionPrinter::expr(const typed::Expr &expr) {
  if (auto found = replaced.find(&expr); found != replaced.end())
    return found->second;
  if (before)
    return lowered(expr);
  // Nothing can go before this expression: what must, goes into a function that is called at once.
  Statements statements;
  const bool outer = isInLambda;
  before = &statements;
  isInLambda = true;
  Code code = lowered(expr);
  before = nullptr;
  isInLambda = outer;
  if (statements.empty())
    return code;
  if (code) // otherwise it is of type void
    statements.push_back(returning(code));
  return lambda(std::move(statements));
}

Code FunctionPrinter::lowered(const typed::Expr &expr) {
  switch (expr.kind) {
  case ExprKind::Literal: {
    const auto &value = cast<typed::LiteralExpr>(expr);
    if (const void *constant = namedConstant(value))
      return name(context.names.of(constant));
    return literal(expr.type, value.value, value.spelling);
  }
  case ExprKind::Variable:
  case ExprKind::State:
  case ExprKind::Member:
  case ExprKind::Field:
    return place(expr);
  case ExprKind::Index: {
    const auto &part = cast<typed::IndexExpr>(expr);
    const bool changes =
        conflicts(context.effects.expression(*part.base), context.effects.expression(*part.index));
    if (!part.base->type->isVector() || !changes)
      return place(expr);
    return element(part, hoist(part.base->type, "value", argument(*part.base)),
                   false); // of the vector as it was
  }
  case ExprKind::Swizzle:
    return swizzle(cast<typed::SwizzleExpr>(expr));
  case ExprKind::Length:
    return length(cast<typed::LengthExpr>(expr));
  case ExprKind::Unary:
    return unary(cast<typed::UnaryExpr>(expr));
  case ExprKind::IncDec:
    return incDec(cast<typed::IncDecExpr>(expr), true);
  case ExprKind::Binary: {
    const auto &op = cast<typed::BinaryExpr>(expr);
    return binary(op.op, *op.left, *op.right);
  }
  case ExprKind::Assign: {
    const auto &assignment = cast<typed::AssignExpr>(expr);
    const typed::Expr *vector = nullptr;
    Code code = assign(assignment, true);
    if (components(*assignment.target, vector).size() > 1 || !isSimple(*assignment.target))
      return code;
    before->push_back(statement(code));
    return place(*assignment.target);
  }
  case ExprKind::Conditional:
    return conditional(cast<typed::ConditionalExpr>(expr));
  case ExprKind::Comma: {
    const auto &comma = cast<typed::CommaExpr>(expr);
    const Statements left = expressionStatement(*comma.left);
    before->insert(before->end(), left.begin(), left.end());
    return lowered(*comma.right);
  }
  case ExprKind::Convert:
    return convert(cast<typed::ConvertExpr>(expr));
  case ExprKind::Construct:
    return construct(cast<typed::ConstructExpr>(expr));
  case ExprKind::Builtin:
    return builtin(cast<typed::BuiltinExpr>(expr));
  case ExprKind::Call:
    return call(cast<typed::CallExpr>(expr));
  case ExprKind::MethodCall:
    return methodCall(cast<typed::MethodCallExpr>(expr));
  case ExprKind::String:
    return string(cast<typed::StringExpr>(expr).value);
  }
  return {};
}

bool isInMemory(const typed::Expr &expr) {
  if (auto *index = dynCast<typed::IndexExpr>(&expr))
    return !index->base->type->isVector() || isInMemory(*index->base);
  if (auto *assignment = dynCast<typed::AssignExpr>(&expr))
    return isInMemory(*assignment->target);
  if (auto *comma = dynCast<typed::CommaExpr>(&expr))
    return isInMemory(*comma->right);
  if (auto *construct = dynCast<typed::ConstructExpr>(&expr)) // of its own type: nothing happens
    return construct->args.front()->type == expr.type && isInMemory(*construct->args.front());
  if (auto *convert = dynCast<typed::ConvertExpr>(&expr))
    return convert->operand->type == expr.type && isInMemory(*convert->operand);
  return expr.kind == ExprKind::Member || expr.kind == ExprKind::Field;
}

// C++ requires both values to be of one type.
Code FunctionPrinter::conditional(const typed::ConditionalExpr &expr) {
  auto choice = [&](const typed::Expr &value) {
    Code code = apart(value, Binding::Assignment);
    const bool isBools = value.type->isVector() && value.type->element->is(TypeKind::Bool);
    return isBools && isInMemory(value) ? cpp::construct(context.types.of(value.type), {code})
                                        : code;
  };
  Code condition = operand(*expr.condition, Binding::Or);
  Code whenTrue = choice(*expr.whenTrue);
  return cpp::conditional(condition, whenTrue, choice(*expr.whenFalse));
}

//===----------------------------------------------------------------------===//
// Conversions
//===----------------------------------------------------------------------===//

Code FunctionPrinter::convert(const typed::ConvertExpr &expr) {
  const typed::Expr &operand = *expr.operand;
  const Type *from = operand.type, *to = expr.type;
  if (to->is(TypeKind::Class)) {
    const std::string target = context.types.of(to);
    if (target == context.types.of(from))
      return this->expr(operand);
    return cpp::construct(target, {member(this->expr(operand), "object")});
  }
  if (from->is(TypeKind::Class)) // to a bool
    return cpp::binary(Operator::NotEqual, member(this->expr(operand), "object"), integer(0));
  const Type *fromScalar = from->scalar(), *toScalar = to->scalar();
  if (!fromScalar || !toScalar || fromScalar == toScalar)
    return this->expr(operand);

  // A whole number where a float or uint was meant.
  const bool isWritten = !expr.isImplicit && !(expr.range == operand.range);
  if (auto *value = dynCast<typed::LiteralExpr>(&operand);
      value && !isWritten && from->isScalar() && !namedConstant(*value)) {
    typed::Constant::Scalar scalar = value->value.scalars.front();
    if (toScalar->is(TypeKind::Float) && !fromScalar->is(TypeKind::Bool)) {
      scalar.f = fromScalar->is(TypeKind::Int) ? static_cast<float>(scalar.i)
                                               : static_cast<float>(scalar.u);
      return scalarLiteral(toScalar, scalar, "");
    }
    if (toScalar->is(TypeKind::UInt) && fromScalar->is(TypeKind::Int) && scalar.i >= 0)
      return scalarLiteral(toScalar, scalar, value->spelling);
  }

  if (toScalar->is(TypeKind::Bool)) {
    const Code zero = scalarLiteral(fromScalar, typed::Constant::Scalar{}, "");
    if (to->isVector())
      return cpp::call("rtsl::notEqual", {argument(operand), zero});
    return cpp::binary(Operator::NotEqual, this->operand(operand, Binding::Relation), zero);
  }
  if (fromScalar->is(TypeKind::Float))
    return cpp::call(toScalar->is(TypeKind::Int) ? "rtsl::toInt" : "rtsl::toUint",
                     {argument(operand)});
  return cpp::construct(context.types.of(to), {argument(operand)});
}

//===----------------------------------------------------------------------===//
// Constructors
//===----------------------------------------------------------------------===//

Code FunctionPrinter::construct(const typed::ConstructExpr &expr) {
  const Type *type = expr.type;
  const std::string typeName = type->is(TypeKind::Class) ? "" : context.types.of(type);
  const typed::Expr &first = *expr.args.front();

  // Braces promise the order.
  if (type->is(TypeKind::Struct) || type->is(TypeKind::Array)) {
    std::vector<Code> parts;
    for (std::size_t i = 0; i < expr.args.size(); ++i) {
      const Type *part =
          type->is(TypeKind::Struct) ? type->structure->fields[i].type : type->element;
      parts.push_back(inMemory(part, apart(*expr.args[i], Binding::Assignment)));
    }
    return type->is(TypeKind::Array) ? array(typeName, std::move(parts))
                                     : list(typeName, std::move(parts));
  }
  if (type->is(TypeKind::Class) || first.type == type)
    return this->expr(first);
  if (type->isScalar()) { // of the first component
    if (first.type->isMatrix())
      return subscript(subscript(operand(first, Binding::Primary), integer(0)), integer(0));
    return isSimple(first) ? component(place(first), 0)
                           : cpp::call("rtsl::part<0>", {argument(first)});
  }
  std::vector<Code> args = arguments(expr.args);
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
  // to every component, or the first of a longer one
  const bool isOne = expr.args.size() == 1 && !hasMatrix;
  if (isExact || isOne)
    return cpp::construct(typeName, std::move(args));
  return cpp::call(withParameters("rtsl::vectorOf", {typeName}), std::move(args));
}

Code FunctionPrinter::swizzle(const typed::SwizzleExpr &expr) {
  const typed::Expr &base = *expr.base;
  if (base.type->isScalar()) {
    if (expr.components.size() == 1)
      return this->expr(base);
    return cpp::construct(context.types.of(expr.type), {argument(base)});
  }
  const typed::Expr *vector = nullptr;
  std::vector<std::uint8_t> parts = components(expr, vector);
  if (parts.empty()) {
    vector = &base;
    parts = expr.components;
  }
  // The first components of a longer vector, or all of it.
  bool isPrefix = parts.size() > 1;
  for (std::size_t i = 0; i < parts.size(); ++i)
    isPrefix &= parts[i] == i;
  if (isPrefix)
    return cpp::construct(context.types.of(expr.type), {argument(*vector)});
  if (parts.size() == 1 && !dynCast<typed::ConvertExpr>(vector))
    return component(operand(*vector, Binding::Primary), parts[0]);
  if (isSimple(*vector)) {
    const bool isRepeated =
        std::all_of(parts.begin(), parts.end(), [&](std::uint8_t at) { return at == parts[0]; });
    std::vector<Code> codes;
    for (std::uint8_t part : parts)
      if (codes.empty() || !isRepeated)
        codes.push_back(component(place(*vector), part));
    return parts.size() == 1 ? codes.front()
                             : cpp::construct(context.types.of(expr.type), std::move(codes));
  }
  std::vector<std::string> numbers;
  for (std::uint8_t part : parts)
    numbers.push_back(std::to_string(part));
  return cpp::call(withParameters(parts.size() == 1 ? "rtsl::part" : "rtsl::swizzle", numbers),
                   {argument(*vector)});
}

} // namespace rtsl::cpp
