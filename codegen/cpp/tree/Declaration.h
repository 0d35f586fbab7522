//===- Declaration.h - declarations of the C++ tree, and the file ---------===//
//
// A file is a list of declarations. Functions have statements as their bodies; structs and
// namespaces have declarations inside.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/tree/Statement.h"

#include <variant>

namespace rtsl::cpp {

struct Declaration;
using Declarations = std::vector<Declaration>;

/// A parameter of a function: `const Ray &ray`.
struct Parameter {
  enum class Pass : std::uint8_t { Value, Reference, Pointer };
  std::string type;
  std::string name; // empty: none
  Pass pass = Pass::Value;
  bool isConst = false;
  bool isUnread = false;    // `[[maybe_unused]]`
  bool isCommented = false; // the function does not mention it: its name is printed as a comment
};

struct Function {
  std::string templateParameters; // `typename Visit`; empty: it is no template
  std::string specifiers;         // `inline`, `virtual`, `friend`, ...
  std::string result, name;
  std::vector<Parameter> parameters;
  bool isConst = false, isOverride = false;
  std::optional<Statements> body; // nothing: a prototype
  std::string caught;             // the type of exceptions that end it without an effect
};

/// `qualifiers type name = value;`, at file level or in a struct.
struct Variable {
  std::string qualifiers, type; // `static constexpr`
  Declarator declarator;
  unsigned bits = 0; // of a bit field; 0: it is none
};

struct Struct {
  std::string name, base;      // the base may be empty
  bool isOnlyDeclared = false; // `struct name;`
  std::vector<Declaration> members;
};

struct Enumerator {
  std::string name;
  std::optional<unsigned> value;
};
struct Enum {
  std::string name, underlying; // the type of its values
  std::vector<Enumerator> values;
};

struct Namespace {
  std::string name; // empty: unnamed
  std::vector<Declaration> members;
};

/// `using name = type;`
struct Alias {
  std::string name, type;
};
/// `using Base::name;`
struct Using {
  std::string name;
};
/// `#include <...>`
struct Include {
  std::string file;
};
/// `#define name`
struct Define {
  std::string name;
};
/// Nothing but the comment above.
struct OnlyComment {};

struct Declaration {
  using What = std::variant<OnlyComment, Function, Variable, Struct, Enum, Namespace, Alias, Using,
                            Include, Define>;
  What what;
  std::string comment;  // above it, with its markers
  std::string trailing; // after it on the same line, with its markers; not of functions and structs
  std::optional<SourcePlace> place; // for `#line`
  bool hasSpace = false;            // an empty line above, unless it comes first
};

/// A declaration, with a comment above it.
Declaration declare(Declaration::What what, std::string comment = {});
/// `struct name;`
Declaration declareStruct(std::string name);

Parameter byValue(std::string type, std::string name);
/// `type &name`
Parameter byReference(std::string type, std::string name);
/// `const type &name`
Parameter byConstReference(std::string type, std::string name);
Parameter byPointer(std::string type, std::string name);

void append(Declarations &declarations, Declarations more);
/// The same, with an empty line between the two.
void appendApart(Declarations &declarations, Declarations more);
void appendApart(Declarations &declarations, Declaration more);

} // namespace rtsl::cpp
