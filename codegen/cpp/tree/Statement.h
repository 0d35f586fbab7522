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

/// Facts about the variable that a statement declares or assigns, from its builder. They are not
/// printed; clean-ups use them (codegen/cpp/cleanup).
struct WrittenVariable {
  const void *identity = nullptr; // null: there is none, or it is not known
  std::string type;
  bool isTemporary = false;     // the compiler has named it: its value may move to its only use
  bool isVectorOfBools = false; // whose type as a value differs from that in memory
};

/// An assignment to a field of the written variable; `all` is empty if it is none.
struct WrittenField {
  std::vector<std::string> all; // fields of the struct, in order
  bool isCopy = false;          // the value is a field of another struct of that type
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
  // Declaration, or Expression that is an assignment
  WrittenVariable written;
  WrittenField field;
  bool isOpen = false; // a declaration that is moved to the first assignment, if there is one

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
/// The value that an assignment assigns, without a compound operator: `x op y` for `x op= y`.
Code assignedValue(const Statement &statement);
/// The variable, if the statement assigns all of a known variable; otherwise null.
const void *assignedVariable(const Statement &statement);

/// Visits every expression of the statements, parts included.
void forEachPart(const Statement &statement,
                 const std::function<void(const ExpressionNode &)> &visit);
/// Does it name this variable, function or type anywhere?
bool mentions(const Statement &statement, const std::string &name);
bool mentions(const Statements &statements, const std::string &name);
/// How often the statements name it.
unsigned countMentions(const Statement &statement, const std::string &name);
unsigned countMentions(const Statements &statements, const std::string &name);

} // namespace rtsl::cpp
