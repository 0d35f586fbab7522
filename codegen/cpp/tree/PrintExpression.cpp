#include "codegen/cpp/tree/Print.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl::cpp {

//===----------------------------------------------------------------------===//
// Parentheses
//===----------------------------------------------------------------------===//

static Binding tighter(Binding binding) {
  return static_cast<Binding>(static_cast<int>(binding) + 1);
}

static bool isBinary(const Code &code, Operator op) {
  return code->is(ExpressionKind::Binary) && code->op == op;
}

/// The lowest precedence with which an operand of `op` needs no parentheses. Some parentheses are
/// there only for readers, and to avoid warnings: around operators whose precedence is not well
/// known, and around `&&` within `||`.
static Binding needed(Operator op, const Code &operand, bool isRight) {
  const Binding own = bindingOf(op);
  const bool isSame = !isRight && isBinary(operand, op);
  if (op == Operator::And || op == Operator::Or)
    return isSame ? own : Binding::BitOr;
  if (op == Operator::BitAnd || op == Operator::BitOr || op == Operator::BitXor)
    return isSame ? own : Binding::Unary;
  if (own == Binding::Equality || own == Binding::Relation || own == Binding::Shift)
    return Binding::Unary;
  return isRight ? tighter(own) : own;
}

/// Does its text begin with a minus sign?
static bool beginsWithMinus(const Code &code) {
  switch (code->kind) {
  case ExpressionKind::Unary:
    return code->unary == UnaryOperator::Minus || code->unary == UnaryOperator::Decrement;
  case ExpressionKind::Binary: {
    const Code &left = code->parts[0];
    return bindingOf(left) >= needed(code->op, left, false) && beginsWithMinus(left);
  }
  case ExpressionKind::Postfix:
  case ExpressionKind::Member:
  case ExpressionKind::MemberOfPointer:
  case ExpressionKind::Subscript:
    return false; // their base binds more tightly than a sign
  default:
    return false;
  }
}

static std::string inParentheses(const std::string &text) {
  return "(" + text + ")";
}

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

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

static std::string arguments(const std::vector<Code> &codes, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < codes.size(); ++i)
    text += (i == first ? "" : ", ") + print(codes[i], Binding::Assignment);
  return text;
}

static std::string printBinary(const ExpressionNode &node) {
  const Code &left = node.parts[0], &right = node.parts[1];
  std::string second = print(right, needed(node.op, right, true));
  const bool isSum = node.op == Operator::Add || node.op == Operator::Subtract;
  if (isSum && bindingOf(right) >= needed(node.op, right, true) && beginsWithMinus(right))
    second = inParentheses(second); // a - -b
  return print(left, needed(node.op, left, false)) + " " + spelling(node.op) + " " + second;
}

static std::string printUnary(const ExpressionNode &node) {
  const Code &operand = node.parts[0];
  const std::string text = print(operand, Binding::Unary);
  const bool isDouble = node.unary == UnaryOperator::Minus &&
                        bindingOf(operand) >= Binding::Unary && beginsWithMinus(operand);
  return spelling(node.unary) + (isDouble ? inParentheses(text) : text);
}

static std::string printBare(const Code &code) {
  const ExpressionNode &node = *code;
  auto part = [&](std::size_t i, Binding atLeast) { return print(node.parts[i], atLeast); };
  switch (node.kind) {
  case ExpressionKind::Name:
  case ExpressionKind::Literal:
    return node.name;
  case ExpressionKind::String:
    return quoted(node.name);
  case ExpressionKind::Member:
    return part(0, Binding::Primary) + "." + node.name;
  case ExpressionKind::MemberOfPointer:
    return part(0, Binding::Primary) + "->" + node.name;
  case ExpressionKind::Subscript:
    return part(0, Binding::Primary) + "[" + part(1, Binding::Comma) + "]";
  case ExpressionKind::Call:
    return part(0, Binding::Primary) + "(" + arguments(node.parts, 1) + ")";
  case ExpressionKind::Construct:
    return node.name + "(" + arguments(node.parts, 0) + ")";
  case ExpressionKind::List:
    return node.name + "{" + arguments(node.parts, 0) + "}";
  case ExpressionKind::Array:
    return node.name + "{{" + arguments(node.parts, 0) + "}}";
  case ExpressionKind::Cast:
    return "static_cast<" + node.name + ">(" + part(0, Binding::Comma) + ")";
  case ExpressionKind::Unary:
    return printUnary(node);
  case ExpressionKind::Postfix:
    return part(0, Binding::Primary) + spelling(node.unary);
  case ExpressionKind::Binary:
    return printBinary(node);
  case ExpressionKind::Assign:
    return part(0, Binding::Unary) + " " + (node.compound ? spelling(node.op) : "") + "= " +
           part(1, Binding::Assignment);
  case ExpressionKind::Conditional:
    return part(0, Binding::Or) + " ? " + part(1, Binding::Assignment) + " : " +
           part(2, Binding::Assignment);
  case ExpressionKind::Comma:
    return part(0, Binding::Comma) + ", " + part(1, Binding::Assignment);
  case ExpressionKind::Parentheses:
    return inParentheses(part(0, Binding::Comma));
  case ExpressionKind::Lambda: {
    std::string body; // on the line of the expression, if the formatter leaves it there
    for (const Statement &statement : *node.statements)
      body += print(statement);
    std::replace(body.begin(), body.end(), '\n', ' ');
    return "[&] { " + body + "}()";
  }
  case ExpressionKind::Remark:
    return "/*" + node.name + "*/" + printBare(node.parts[0]);
  }
  return {};
}

std::string print(const Code &code, Binding atLeast) {
  if (!code)
    return {};
  const std::string text = printBare(code);
  return bindingOf(code) < atLeast ? inParentheses(text) : text;
}

std::string print(const std::vector<Code> &codes) {
  return arguments(codes, 0);
}

} // namespace rtsl::cpp
