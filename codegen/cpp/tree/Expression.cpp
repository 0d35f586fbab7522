#include "codegen/cpp/tree/Expression.h"

#include "codegen/cpp/tree/Statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace rtsl::cpp {

namespace {
struct OperatorFacts {
  const char *spelling;
  Binding binding;
};
} // namespace

static const OperatorFacts &facts(Operator op) {
  static constexpr OperatorFacts all[] = {
      {"*", Binding::Product},   {"/", Binding::Product},   {"%", Binding::Product},
      {"+", Binding::Sum},       {"-", Binding::Sum},       {"<<", Binding::Shift},
      {">>", Binding::Shift},    {"<", Binding::Relation},  {">", Binding::Relation},
      {"<=", Binding::Relation}, {">=", Binding::Relation}, {"==", Binding::Equality},
      {"!=", Binding::Equality}, {"&", Binding::BitAnd},    {"^", Binding::BitXor},
      {"|", Binding::BitOr},     {"&&", Binding::And},      {"||", Binding::Or},
  };
  return all[static_cast<std::size_t>(op)];
}

const char *spelling(Operator op) {
  return facts(op).spelling;
}
Binding bindingOf(Operator op) {
  return facts(op).binding;
}

const char *spelling(UnaryOperator op) {
  static constexpr const char *all[] = {"-", "!", "~", "++", "--", "&", "*"};
  return all[static_cast<std::size_t>(op)];
}

Code::Code(ExpressionNode node) : node(std::make_shared<const ExpressionNode>(std::move(node))) {}

//===----------------------------------------------------------------------===//
// Making nodes
//===----------------------------------------------------------------------===//

static ExpressionNode node(ExpressionKind kind, std::string name, std::vector<Code> parts) {
  ExpressionNode made;
  made.kind = kind;
  made.name = std::move(name);
  made.parts = std::move(parts);
  return made;
}

Code name(std::string text) {
  return Code(node(ExpressionKind::Name, std::move(text), {}));
}

Code literal(std::string spelling, bool isZero) {
  ExpressionNode made = node(ExpressionKind::Literal, std::move(spelling), {});
  made.isZero = isZero;
  return Code(std::move(made));
}

Code boolean(bool value) {
  return literal(value ? "true" : "false", !value);
}

Code integer(std::int64_t value) {
  if (value == std::numeric_limits<std::int32_t>::min()) // its opposite is no int
    return call("std::numeric_limits<int>::min", {});
  if (value < 0)
    return unary(UnaryOperator::Minus, integer(-value));
  return literal(std::to_string(value), value == 0);
}

Code string(std::string text) {
  return Code(node(ExpressionKind::String, std::move(text), {}));
}

Code member(Code base, std::string name) {
  return Code(node(ExpressionKind::Member, std::move(name), {std::move(base)}));
}

Code memberOfPointer(Code base, std::string name) {
  return Code(node(ExpressionKind::MemberOfPointer, std::move(name), {std::move(base)}));
}

Code component(Code base, std::size_t number) {
  return member(std::move(base), std::string(1, "xyzw"[number]));
}

Code subscript(Code base, Code index) {
  return Code(node(ExpressionKind::Subscript, {}, {std::move(base), std::move(index)}));
}

Code call(Code callee, std::vector<Code> arguments) {
  arguments.insert(arguments.begin(), std::move(callee));
  return Code(node(ExpressionKind::Call, {}, std::move(arguments)));
}

Code call(std::string callee, std::vector<Code> arguments) {
  return call(name(std::move(callee)), std::move(arguments));
}

Code callMember(Code base, std::string method, std::vector<Code> arguments) {
  return call(member(std::move(base), std::move(method)), std::move(arguments));
}

std::string withParameters(const std::string &name, const std::vector<std::string> &parameters) {
  return fmt::format("{}<{}>", name, fmt::join(parameters, ", "));
}

Code construct(std::string type, std::vector<Code> arguments) {
  return Code(node(ExpressionKind::Construct, std::move(type), std::move(arguments)));
}

Code list(std::string type, std::vector<Code> elements) {
  return Code(node(ExpressionKind::List, std::move(type), std::move(elements)));
}

Code array(std::string type, std::vector<Code> elements) {
  return Code(node(ExpressionKind::Array, std::move(type), std::move(elements)));
}

Code staticCast(std::string type, Code operand) {
  return Code(node(ExpressionKind::Cast, std::move(type), {std::move(operand)}));
}

Code discarded(Code operand) {
  return staticCast("void", std::move(operand));
}

Code unary(UnaryOperator op, Code operand) {
  ExpressionNode made = node(ExpressionKind::Unary, {}, {std::move(operand)});
  made.unary = op;
  return Code(std::move(made));
}

Code postfix(UnaryOperator op, Code operand) {
  ExpressionNode made = node(ExpressionKind::Postfix, {}, {std::move(operand)});
  made.unary = op;
  return Code(std::move(made));
}

Code binary(Operator op, Code left, Code right) {
  ExpressionNode made = node(ExpressionKind::Binary, {}, {std::move(left), std::move(right)});
  made.op = op;
  return Code(std::move(made));
}

Code assign(Code target, Code value) {
  return Code(node(ExpressionKind::Assign, {}, {std::move(target), std::move(value)}));
}

Code assign(Operator op, Code target, Code value) {
  ExpressionNode made = node(ExpressionKind::Assign, {}, {std::move(target), std::move(value)});
  made.op = op;
  made.compound = true;
  return Code(std::move(made));
}

Code conditional(Code condition, Code whenTrue, Code whenFalse) {
  return Code(node(ExpressionKind::Conditional, {},
                   {std::move(condition), std::move(whenTrue), std::move(whenFalse)}));
}

Code comma(Code left, Code right) {
  return Code(node(ExpressionKind::Comma, {}, {std::move(left), std::move(right)}));
}

Code parentheses(Code inside) {
  return inside->is(ExpressionKind::Parentheses)
             ? inside
             : Code(node(ExpressionKind::Parentheses, {}, {std::move(inside)}));
}

Code lambda(Statements statements) {
  ExpressionNode made = node(ExpressionKind::Lambda, {}, {});
  made.statements = std::make_shared<const Statements>(std::move(statements));
  return Code(std::move(made));
}

Code remark(std::string text, Code inside) {
  return Code(node(ExpressionKind::Remark, std::move(text), {std::move(inside)}));
}

//===----------------------------------------------------------------------===//
// Facts about nodes
//===----------------------------------------------------------------------===//

Binding bindingOf(const Code &code) {
  switch (code->kind) {
  case ExpressionKind::Unary:
  case ExpressionKind::Postfix:
    return Binding::Unary;
  case ExpressionKind::Binary:
    return bindingOf(code->op);
  case ExpressionKind::Assign:
  case ExpressionKind::Conditional:
    return Binding::Assignment;
  case ExpressionKind::Comma:
    return Binding::Comma;
  case ExpressionKind::Remark:
    return bindingOf(code->parts.front());
  default:
    return Binding::Primary;
  }
}

Code bare(Code code) {
  while (code && code->is(ExpressionKind::Parentheses))
    code = Code(code->parts.front());
  return code;
}

bool same(const Code &first, const Code &second) {
  const Code a = bare(first), b = bare(second);
  if (!a || !b)
    return !a && !b;
  if (&*a == &*b)
    return true;
  return a->kind == b->kind && a->name == b->name && a->op == b->op && a->unary == b->unary &&
         a->compound == b->compound && !a->statements && !b->statements &&
         std::equal(a->parts.begin(), a->parts.end(), b->parts.begin(), b->parts.end(), same);
}

bool isName(const Code &code) {
  return code && code->is(ExpressionKind::Name);
}

bool isZero(const Code &code) {
  switch (code->kind) {
  case ExpressionKind::Literal:
    return code->isZero;
  case ExpressionKind::List:
    return code->parts.empty();
  case ExpressionKind::Construct:
    return code->parts.size() == 1 && isZero(code->parts.front());
  default:
    return false;
  }
}

bool isBoolean(const Code &code, bool value) {
  return code->is(ExpressionKind::Literal) && code->name == (value ? "true" : "false");
}

bool isCallOf(const Code &code, const std::string &callee) {
  return code && code->is(ExpressionKind::Call) && isName(code->parts.front()) &&
         code->parts.front()->name == callee;
}

void forEachPart(const Code &code, const std::function<void(const ExpressionNode &)> &visit) {
  if (!code)
    return;
  visit(*code);
  for (const Code &part : code->parts)
    forEachPart(part, visit);
  if (code->statements)
    for (const Statement &statement : *code->statements)
      forEachPart(statement, visit);
}

bool mentions(const Code &code, const std::string &name) {
  bool found = false;
  forEachPart(code, [&](const ExpressionNode &part) {
    found |= part.is(ExpressionKind::Name) && part.name == name;
  });
  return found;
}

bool contains(const Code &code, const Code &part) {
  return code && (same(code, part) ||
                  std::any_of(code->parts.begin(), code->parts.end(),
                              [&](const Code &inner) { return contains(inner, part); }));
}

Code negated(const Code &condition) {
  const Code inner = bare(condition);
  if (inner->is(ExpressionKind::Unary) && inner->unary == UnaryOperator::Not)
    return bare(inner->parts.front());
  return unary(UnaryOperator::Not, inner);
}

} // namespace rtsl::cpp
