//===- Expressions.cpp - expressions, literals, conversions, constructors -===//
#include "codegen/cpp/Printer.h"

#include "codegen/lower/Analysis.h"
#include "sema/Casting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::cpp {

using typed::ExprKind;

std::string bind(const Code &code, Binding atLeast) {
  return code.binding < atLeast ? "(" + code.text + ")" : code.text;
}

std::string join(const std::vector<std::string> &parts, const char *between) {
  return fmt::format("{}", fmt::join(parts, between));
}

FunctionPrinter::FunctionPrinter(ModulePrinter &module, const typed::Function *function, const typed::Class *owner)
    : module(module), function(function), owner(function ? function->owner : owner) {
  if (!function)
    return;
  for (const auto &parameter : function->parameters)
    usedNames.insert(module.names.of(parameter.get()));
  for (const auto &local : function->locals)
    usedNames.insert(module.names.of(local.get()));
}

std::string FunctionPrinter::initialiser(const typed::Expr &expr) { return apart(expr, Binding::Assignment); }

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

std::string FunctionPrinter::hoist(const Type *type, const std::string &hint, const std::string &value) {
  std::string name = temporaryName(hint);
  before->push_back(fmt::format("const {} {} = {};", module.type(type), name, value));
  return name;
}

/// What a variable that holds the expression's value is called: after the first call in it.
static std::string hintFor(const typed::Expr &expr) {
  std::string hint;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (!hint.empty() || !lowering::hasSideEffects(inner))
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

std::vector<std::string> FunctionPrinter::operands(const std::vector<const typed::Expr *> &exprs,
                                                   Binding atLeast) {
  std::vector<Effects> all;
  bool anyEffects = false;
  for (const typed::Expr *expr : exprs) {
    all.push_back(module.effects.expression(*expr));
    anyEffects |= !all.back().isPure();
  }
  anyEffects &= isNested;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < exprs.size(); ++i) {
    bool shows = false;
    for (std::size_t later = i + 1; anyEffects && later < exprs.size(); ++later)
      shows |= conflicts(all[i], all[later]);
    texts.push_back(shows ? hoist(exprs[i]->type, hintFor(*exprs[i]), argument(*exprs[i])) : operand(*exprs[i], atLeast));
  }
  return texts;
}

std::vector<std::string> FunctionPrinter::arguments(const std::vector<typed::ExprPtr> &exprs) {
  std::vector<const typed::Expr *> pointers;
  for (const typed::ExprPtr &expr : exprs)
    pointers.push_back(expr.get());
  return operands(pointers, Binding::Assignment);
}

std::string FunctionPrinter::apart(const typed::Expr &expr, Binding atLeast) {
  std::vector<std::string> *outer = before;
  before = nullptr;
  std::string text = operand(expr, atLeast);
  before = outer;
  return text;
}

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

std::string FunctionPrinter::operand(const typed::Expr &expr, Binding atLeast) {
  Code code = this->expr(expr);
  // The author's own parentheses stay, where there is something to hold together.
  const bool keeps = atLeast > Binding::Or && code.binding < Binding::Unary &&
                     module.notes.inParentheses(expr.range);
  return keeps ? "(" + code.text + ")" : bind(code, atLeast);
}

Code FunctionPrinter::expr(const typed::Expr &expr) {
  if (auto found = replaced.find(&expr); found != replaced.end())
    return found->second;
  if (before)
    return lowered(expr);
  // Nothing can go before this expression: what must, goes into a function that is called at once.
  std::vector<std::string> statements;
  const bool outer = isInLambda;
  before = &statements;
  isInLambda = true;
  Code code = lowered(expr);
  before = nullptr;
  isInLambda = outer;
  if (statements.empty())
    return code;
  if (code.text.empty()) // of type void
    return {fmt::format("[&] {{ {} }}()", join(statements, " "))};
  return {fmt::format("[&] {{ {} return {}; }}()", join(statements, " "), code.text)};
}

static std::string quoted(const std::string &text) {
  std::string literal = "\"";
  for (char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      literal += std::string("\\") + c;
    else if (c == '\n')
      literal += "\\n";
    else if (byte < 0x20 || byte == 0x7f)
      literal += fmt::format("\\{:03o}", byte);
    else
      literal += c;
  }
  return literal + "\"";
}

Code FunctionPrinter::lowered(const typed::Expr &expr) {
  switch (expr.kind) {
  case ExprKind::Literal: {
    const auto &value = cast<typed::LiteralExpr>(expr);
    if (const void *constant = namedConstant(value))
      return {module.names.of(constant)};
    return literal(expr.type, value.value, value.spelling);
  }
  case ExprKind::Variable:
  case ExprKind::State:
  case ExprKind::Member:
  case ExprKind::Field:
    return place(expr);
  case ExprKind::Index: {
    const auto &part = cast<typed::IndexExpr>(expr);
    const bool changes = conflicts(module.effects.expression(*part.base), module.effects.expression(*part.index));
    if (!part.base->type->isVector() || !changes)
      return place(expr);
    return element(part, hoist(part.base->type, "value", argument(*part.base)), false); // of the vector as it was
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
    before->push_back(code.text + ";");
    return place(*assignment.target);
  }
  case ExprKind::Conditional:
    return conditional(cast<typed::ConditionalExpr>(expr));
  case ExprKind::Comma: {
    const auto &comma = cast<typed::CommaExpr>(expr);
    std::string left = expressionStatement(*comma.left);
    if (!left.empty())
      before->push_back(left.substr(0, left.size() - 1));
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
    return {quoted(cast<typed::StringExpr>(expr).value)};
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

// C++ asks both values to be of one type.
Code FunctionPrinter::conditional(const typed::ConditionalExpr &expr) {
  auto choice = [&](const typed::Expr &value) {
    std::string text = apart(value, Binding::Assignment);
    const bool isBools = value.type->isVector() && value.type->element->is(TypeKind::Bool);
    return isBools && isInMemory(value) ? module.type(value.type) + "(" + text + ")" : text;
  };
  std::string condition = operand(*expr.condition, Binding::Or);
  std::string whenTrue = choice(*expr.whenTrue);
  std::string whenFalse = choice(*expr.whenFalse);
  return {condition + " ? " + whenTrue + " : " + whenFalse, Binding::Assignment};
}

//===----------------------------------------------------------------------===//
// Literals
//===----------------------------------------------------------------------===//

std::string floatText(float value) {
  if (std::isnan(value))
    return "std::numeric_limits<float>::quiet_NaN()";
  if (std::isinf(value))
    return value < 0 ? "-rtsl::infinity" : "rtsl::infinity";
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos)
    text += ".0";
  return text + "f";
}

/// `1.` and `.5` as C++ programmers write them.
static std::string floatText(const std::string &spelling) {
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

static bool sameValue(const typed::Constant &a, const typed::Constant &b) {
  return a.scalars.size() == b.scalars.size() &&
         std::equal(a.scalars.begin(), a.scalars.end(), b.scalars.begin(),
                    [](typed::Constant::Scalar x, typed::Constant::Scalar y) { return x.u == y.u || x.b == y.b; });
}

// The checker puts values for the names of constants. What the author wrote still stands in the
// text, and names there what it names in C++: the nearest constant of that name.
const void *FunctionPrinter::namedConstant(const typed::LiteralExpr &expr) const {
  if (!expr.spelling.empty())
    return nullptr;
  const std::string name = module.notes.identifier(expr.range);
  if (name.empty() || name == "true" || name == "false")
    return nullptr;
  auto isIt = [&](const auto &constant) {
    return constant.name == name && constant.isConst && constant.type == expr.type && constant.constant &&
           sameValue(*constant.constant, expr.value);
  };
  if (function)
    for (const auto &local : function->locals)
      if (isIt(*local))
        return local.get();
  for (const typed::Class *at = owner; at; at = at->base)
    for (const auto &member : at->members)
      if (isIt(*member))
        return member.get();
  for (const auto &constant : module.module.constants)
    if (isIt(*constant))
      return constant.get();
  return nullptr;
}

/// Named ones need not be known to C++ while it compiles.
bool FunctionPrinter::isTable(const typed::Expr &expr) const {
  auto isNumber = [&](const typed::Expr &element) {
    auto *literal = dynCast<typed::LiteralExpr>(&element);
    return literal && element.type->isScalar() && !namedConstant(*literal) &&
           (!element.type->is(TypeKind::Float) || std::isfinite(literal->value.scalars.front().f));
  };
  auto *array = dynCast<typed::ConstructExpr>(&expr);
  return array && array->type->is(TypeKind::Array) &&
         std::all_of(array->args.begin(), array->args.end(),
                     [&](const typed::ExprPtr &element) { return isNumber(*element) || isTable(*element); });
}

Code FunctionPrinter::scalarLiteral(const Type *type, typed::Constant::Scalar value,
                                    const std::string &spelling) {
  switch (type->kind) {
  case TypeKind::Bool:
    return {value.b ? "true" : "false"};
  case TypeKind::Float: {
    std::string text = spelling.empty() ? floatText(value.f) : floatText(spelling);
    return {text, text.front() == '-' ? Binding::Unary : Binding::Primary};
  }
  case TypeKind::UInt: {
    std::string text = spelling.empty() ? std::to_string(value.u) : spelling;
    while (!text.empty() && (text.back() == 'u' || text.back() == 'U'))
      text.pop_back();
    return {text + "u"};
  }
  default:
    if (value.i == std::numeric_limits<std::int32_t>::min())
      return {"std::numeric_limits<int>::min()"};
    if (value.i < 0 && !spelling.empty() && spelling.front() == '0')
      return {"int(" + spelling + "u)"}; // names 32 bits
    return {spelling.empty() ? std::to_string(value.i) : spelling,
            value.i < 0 ? Binding::Unary : Binding::Primary};
  }
}

Code FunctionPrinter::literal(const Type *type, const typed::Constant &constant, const std::string &spelling) {
  if (type->isScalar())
    return scalarLiteral(type, constant.scalars.front(), spelling);
  std::size_t next = 0;
  std::function<std::string(const Type *)> part = [&](const Type *at) -> std::string {
    if (at->isScalar())
      return scalarLiteral(at, constant.scalars[next++], "").text;
    std::vector<std::string> parts;
    if (at->is(TypeKind::Struct)) {
      for (const typed::Field &field : at->structure->fields)
        parts.push_back(braced(field.type, part(field.type)));
      return module.type(at) + "{" + join(parts, ", ") + "}";
    }
    if (at->is(TypeKind::Array)) {
      for (unsigned i = 0; i < at->count; ++i)
        parts.push_back(braced(at->element, part(at->element)));
      return module.type(at) + "{{" + join(parts, ", ") + "}}";
    }
    const std::size_t count = at->is(TypeKind::Color) ? constant.scalars.size() : at->componentCount();
    const Type *scalar = at->is(TypeKind::Color) ? nullptr : at->scalar();
    for (std::size_t i = 0; i < count; ++i)
      parts.push_back(scalar ? scalarLiteral(scalar, constant.scalars[next++], "").text
                             : floatText(constant.scalars[next++].f));
    if (at->is(TypeKind::Color) && count == 3 && module.options.colorComponents != 3)
      return fmt::format("rtsl::rgb<{}>({})", module.options.colorComponents, join(parts, ", "));
    return module.type(at) + "(" + join(parts, ", ") + ")";
  };
  return {part(type)};
}

/// An initialiser of a field or an element: a bool needs 32 bits there.
std::string FunctionPrinter::braced(const Type *type, const std::string &text) {
  return type->is(TypeKind::Bool) ? "rtsl::Bool(" + text + ")" : text;
}

//===----------------------------------------------------------------------===//
// Conversions
//===----------------------------------------------------------------------===//

Code FunctionPrinter::convert(const typed::ConvertExpr &expr) {
  const typed::Expr &operand = *expr.operand;
  const Type *from = operand.type, *to = expr.type;
  if (to->is(TypeKind::Class)) {
    const std::string target = module.type(to);
    if (target == module.type(from))
      return this->expr(operand);
    return {target + "(" + bind(this->expr(operand), Binding::Primary) + ".object)"};
  }
  if (from->is(TypeKind::Class)) // to a bool
    return {bind(this->expr(operand), Binding::Primary) + ".object != 0", Binding::Equality};
  const Type *fromScalar = from->scalar(), *toScalar = to->scalar();
  if (!fromScalar || !toScalar || fromScalar == toScalar)
    return this->expr(operand);

  // A whole number where a float or uint was meant.
  const bool isWritten = !expr.isImplicit && !(expr.range == operand.range);
  if (auto *value = dynCast<typed::LiteralExpr>(&operand);
      value && !isWritten && from->isScalar() && !namedConstant(*value)) {
    typed::Constant::Scalar scalar = value->value.scalars.front();
    if (toScalar->is(TypeKind::Float) && !fromScalar->is(TypeKind::Bool)) {
      scalar.f = fromScalar->is(TypeKind::Int) ? static_cast<float>(scalar.i) : static_cast<float>(scalar.u);
      return scalarLiteral(toScalar, scalar, "");
    }
    if (toScalar->is(TypeKind::UInt) && fromScalar->is(TypeKind::Int) && scalar.i >= 0)
      return scalarLiteral(toScalar, scalar, value->spelling);
  }

  if (toScalar->is(TypeKind::Bool)) {
    typed::Constant::Scalar zero{};
    const std::string zeroText = scalarLiteral(fromScalar, zero, "").text;
    if (to->isVector())
      return {"rtsl::notEqual(" + argument(operand) + ", " + zeroText + ")"};
    return {this->operand(operand, Binding::Relation) + " != " + zeroText, Binding::Equality};
  }
  if (fromScalar->is(TypeKind::Float))
    return {std::string(toScalar->is(TypeKind::Int) ? "rtsl::toInt(" : "rtsl::toUint(") + argument(operand) + ")"};
  return {module.type(to) + "(" + argument(operand) + ")"};
}

//===----------------------------------------------------------------------===//
// Constructors
//===----------------------------------------------------------------------===//

Code FunctionPrinter::construct(const typed::ConstructExpr &expr) {
  const Type *type = expr.type;
  const std::string name = type->is(TypeKind::Class) ? "" : module.type(type);
  const typed::Expr &first = *expr.args.front();

  // Braces promise the order.
  if (type->is(TypeKind::Struct) || type->is(TypeKind::Array)) {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < expr.args.size(); ++i) {
      const Type *part = type->is(TypeKind::Struct) ? type->structure->fields[i].type : type->element;
      parts.push_back(braced(part, apart(*expr.args[i], Binding::Assignment)));
    }
    return {name + (type->is(TypeKind::Array) ? "{{" : "{") + join(parts, ", ") +
            (type->is(TypeKind::Array) ? "}}" : "}")};
  }
  if (type->is(TypeKind::Class) || first.type == type)
    return this->expr(first);
  if (type->isScalar()) { // of the first component
    if (first.type->isMatrix())
      return {operand(first, Binding::Primary) + "[0][0]"};
    return {isSimple(first) ? place(first).text + ".x" : "rtsl::part<0>(" + argument(first) + ")"};
  }
  if (type->is(TypeKind::Color)) {
    const std::vector<std::string> args = arguments(expr.args);
    if (args.size() == 3 && module.options.colorComponents != 3)
      return {fmt::format("rtsl::rgb<{}>({})", module.options.colorComponents, join(args, ", "))};
    return {name + "(" + join(args, ", ") + ")"};
  }

  std::size_t scalars = 0;
  bool hasMatrix = false, onlyScalars = true, onlyColumns = type->isMatrix();
  for (const typed::ExprPtr &arg : expr.args) {
    scalars += arg->type->componentCount();
    hasMatrix |= arg->type->isMatrix();
    onlyScalars &= arg->type->isScalar();
    onlyColumns &= type->isMatrix() && arg->type == type->element;
  }
  const std::string args = join(arguments(expr.args), ", ");
  if (type->isMatrix()) {
    if (expr.args.size() == 1 && hasMatrix)
      return {"rtsl::resize<" + name + ">(" + args + ")"};
    if (onlyColumns || onlyScalars)
      return {name + "(" + args + ")"};
    return {"rtsl::matrixOf<" + name + ">(" + args + ")"};
  }
  const bool isExact = scalars == type->count && !hasMatrix;
  const bool isOne = expr.args.size() == 1 && !hasMatrix; // to every component, or the first of a longer one
  if (isExact || isOne)
    return {name + "(" + args + ")"};
  return {"rtsl::vectorOf<" + name + ">(" + args + ")"};
}

Code FunctionPrinter::swizzle(const typed::SwizzleExpr &expr) {
  const typed::Expr &base = *expr.base;
  static const char letters[] = "xyzw";
  if (base.type->isScalar()) {
    if (expr.components.size() == 1)
      return this->expr(base);
    return {module.type(expr.type) + "(" + argument(base) + ")"};
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
    return {module.type(expr.type) + "(" + argument(*vector) + ")"};
  if (parts.size() == 1 && !dynCast<typed::ConvertExpr>(vector))
    return {operand(*vector, Binding::Primary) + "." + letters[parts[0]]};
  const bool isRepeated = std::all_of(parts.begin(), parts.end(), [&](std::uint8_t at) { return at == parts[0]; });
  if (isRepeated && isSimple(*vector))
    return {module.type(expr.type) + "(" + place(*vector).text + "." + letters[parts[0]] + ")"};
  if (isSimple(*vector)) {
    std::vector<std::string> texts;
    for (std::uint8_t part : parts)
      texts.push_back(place(*vector).text + "." + letters[part]);
    return {texts.size() == 1 ? texts.front() : module.type(expr.type) + "(" + join(texts, ", ") + ")"};
  }
  std::vector<std::string> numbers;
  for (std::uint8_t part : parts)
    numbers.push_back(std::to_string(part));
  if (parts.size() == 1)
    return {"rtsl::part<" + numbers.front() + ">(" + argument(*vector) + ")"};
  return {"rtsl::swizzle<" + join(numbers, ", ") + ">(" + argument(*vector) + ")"};
}

} // namespace rtsl::cpp
