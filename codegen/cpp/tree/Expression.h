//===- Expression.h - expressions of the C++ tree -------------------------===//
//
// C++ is a tree before it is printed. Only the printer (Print.h) has the spelling of nodes, and
// decides which of them need parentheses and where lines end. A node never
// changes once it is made, so parts are shared freely.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::cpp {

struct ExpressionNode;
struct Statement;
using Statements = std::vector<Statement>;

/// How tightly an expression's outermost operator binds, in the order of C++.
enum class Binding : std::uint8_t {
  Comma,
  Assignment, // and ?:
  Or,
  And,
  BitOr,
  BitXor,
  BitAnd,
  Equality,
  Relation,
  Shift,
  Sum,
  Product,
  Unary,
  Primary, // names, calls, members, indices
};

/// Operators with two operands, in the order of their table in Expression.cpp.
enum class Operator : std::uint8_t {
  Multiply,
  Divide,
  Remainder,
  Add,
  Subtract,
  ShiftLeft,
  ShiftRight,
  Less,
  Greater,
  LessEqual,
  GreaterEqual,
  Equal,
  NotEqual,
  BitAnd,
  BitXor,
  BitOr,
  And,
  Or,
};
const char *spelling(Operator op);
Binding bindingOf(Operator op);

enum class UnaryOperator : std::uint8_t {
  Minus,
  Not,
  BitNot,
  Increment,
  Decrement,
  Address,
  Dereference
};
const char *spelling(UnaryOperator op);

/// An expression in C++; empty where there is nothing to evaluate.
class Code {
public:
  Code() = default;
  explicit Code(ExpressionNode node);

  explicit operator bool() const { return node != nullptr; }
  const ExpressionNode &operator*() const { return *node; }
  const ExpressionNode *operator->() const { return node.get(); }

private:
  std::shared_ptr<const ExpressionNode> node;
};

struct ExpressionNode {
  enum class Kind : std::uint8_t {
    Name,            // `x`, `rtsl::infinity`, `Step::shade`
    Literal,         // `1.0f`, `true`
    String,          // the text, without quotes
    Member,          // parts[0].name
    MemberOfPointer, // parts[0]->name
    Subscript,       // parts[0][parts[1]]
    Call,            // parts[0](parts[1], ...)
    Construct,       // name(parts...), name being a type
    List,            // name{parts...}; without a type where `name` is empty
    Array,           // name{{parts...}}
    Cast,            // static_cast<name>(parts[0])
    Unary,           // unary parts[0]
    Postfix,         // parts[0] unary
    Binary,          // parts[0] op parts[1]
    Assign,          // parts[0] = parts[1], or parts[0] op= parts[1] if `compound`
    Conditional,     // parts[0] ? parts[1] : parts[2]
    Comma,           // parts[0], parts[1]
    Parentheses,     // the author's own round parts[0]
    Lambda,          // [&] { statements }()
    Remark,          // /*name*/parts[0]
  };
  Kind kind = Kind::Name;
  std::string name; // or the spelling of a literal
  std::vector<Code> parts;
  Operator op = Operator::Add;
  UnaryOperator unary = UnaryOperator::Minus;
  bool compound = false;                        // Assign
  bool isZero = false;                          // Literal: 0 or false
  std::shared_ptr<const Statements> statements; // Lambda

  bool is(Kind k) const { return kind == k; }
};
using ExpressionKind = ExpressionNode::Kind;

//===----------------------------------------------------------------------===//
// Making nodes
//===----------------------------------------------------------------------===//

Code name(std::string text);
/// A literal as it is spelled, without a sign.
Code literal(std::string spelling, bool isZero = false);
Code boolean(bool value);
Code integer(std::int64_t value);
Code string(std::string text);
Code member(Code base, std::string name);
/// `base->name`
Code memberOfPointer(Code base, std::string name);
/// Component 0 to 3 of a vector: `base.x`.
Code component(Code base, std::size_t number);
Code subscript(Code base, Code index);
Code call(Code callee, std::vector<Code> arguments);
Code call(std::string callee, std::vector<Code> arguments);
/// `base.method(arguments)`
Code callMember(Code base, std::string method, std::vector<Code> arguments);
/// `name<parameters>`, to be called.
std::string withParameters(const std::string &name, const std::vector<std::string> &parameters);
Code construct(std::string type, std::vector<Code> arguments);
Code list(std::string type, std::vector<Code> elements);
Code array(std::string type, std::vector<Code> elements);
Code staticCast(std::string type, Code operand);
/// `static_cast<void>(operand)`: its value is not used.
Code discarded(Code operand);
Code unary(UnaryOperator op, Code operand);
Code postfix(UnaryOperator op, Code operand);
Code binary(Operator op, Code left, Code right);
Code assign(Code target, Code value);
Code assign(Operator op, Code target, Code value);
Code conditional(Code condition, Code whenTrue, Code whenFalse);
Code comma(Code left, Code right);
Code parentheses(Code inside);
Code lambda(Statements statements);
Code remark(std::string text, Code inside);

//===----------------------------------------------------------------------===//
// Facts about nodes
//===----------------------------------------------------------------------===//

/// How tightly it binds.
Binding bindingOf(const Code &code);
/// Are both the same expression, parentheses aside?
bool same(const Code &a, const Code &b);
/// The expression without the author's parentheses around it.
Code bare(Code code);
bool isName(const Code &code);
/// A number that is 0, `false`, `{}`, or a vector or color made of one zero.
bool isZero(const Code &code);
/// The literal `true` or `false`.
bool isBoolean(const Code &code, bool value);
/// A call of the function of that name.
bool isCallOf(const Code &code, const std::string &callee);
/// Visits the expression and all its parts, statements of lambdas included.
void forEachPart(const Code &code, const std::function<void(const ExpressionNode &)> &visit);
/// Does it name this variable, function or type anywhere?
bool mentions(const Code &code, const std::string &name);
/// Is the other one part of it, or all of it?
bool contains(const Code &code, const Code &part);
/// The opposite of a condition.
Code negated(const Code &condition);

} // namespace rtsl::cpp
