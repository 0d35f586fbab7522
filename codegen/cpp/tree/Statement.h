//===- Statement.h - statements of the C++ tree ---------------------------===//
#pragma once

#include "codegen/cpp/tree/Expression.h"

namespace rtsl::cpp {

/// Where something stands in the author's files, for `#line`.
struct SourcePlace {
  std::string file;
  unsigned line = 0;
};

/// A variable in a declaration.
struct Declarator {
  std::string name;
  Code value;            // empty: none
  bool isDirect = false; // `name(arguments)`, of a Construct node
  bool isCArray = false; // `name[] = {elements}`
};

/// A part of a `switch`, with its labels.
struct Arm {
  std::vector<Code> labels;
  bool isDefault = false;
  bool hasBraces = false;
  Statements body;
};

struct Statement {
  enum class Kind : std::uint8_t {
    Expression,
    Declaration, // one or several of a type
    If,          // value: the condition
    For,         // init; value; step
    While,
    DoWhile,
    Switch,
    Return, // of value, if there is one
    Break,
    Continue,
    Fallthrough,
    Block,
    Empty,   // a semicolon
    Nothing, // nothing but the comment above
  };
  Kind kind = Kind::Nothing;

  std::string comment;  // above it, with its markers
  std::string trailing; // after it or its opening brace, on the same line, with its markers
  std::optional<SourcePlace> place; // for `#line`
  bool hasSpace = false;            // an empty line above, unless it comes first

  Code value;
  // Declaration
  std::string qualifiers, type; // `static constexpr`
  std::vector<Declarator> declarators;
  // For
  Statements init; // at most one
  Code step;
  // If, loops, Block
  Statements body, otherwise;
  bool hasBraces = false, otherwiseHasBraces = false; // whether they need some or not
  // Switch
  std::vector<Arm> arms;

  bool is(Kind k) const { return kind == k; }
};
using StatementKind = Statement::Kind;

Statement statement(Code expression);
Statement declaration(std::string type, std::string name, Code value);
Statement declaration(std::string qualifiers, std::string type, std::string name, Code value);
Statement returning(Code value = {});
Statement block(Statements body);
Statement simple(StatementKind kind);
Statement branch(Code condition, Statements then, bool hasBraces = false);
Statement loop(Code condition, Statements body, bool hasBraces = false);

void append(Statements &statements, const Statements &more);

/// If the statement is `name = value;`, the name; otherwise empty.
std::string assignedName(const Statement &statement);
/// Of an assignment, without a compound operator: `x op y` for `x op= y`.
Code assignedValue(const Statement &statement);

/// Visits every expression of the statements, parts included.
void forEachPart(const Statement &statement,
                 const std::function<void(const ExpressionNode &)> &visit);
/// Does it name this variable, function or type anywhere?
bool mentions(const Statement &statement, const std::string &name);
bool mentions(const Statements &statements, const std::string &name);

} // namespace rtsl::cpp
