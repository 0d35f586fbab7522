//===- FunctionPrinter.h - a function of the author's, as a tree ----------===//
//
// The parts of the printer, a class for each concern, and what they share while they make the tree
// of one function.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/functions/Assignments.h"
#include "codegen/cpp/functions/Builtins.h"
#include "codegen/cpp/functions/Calls.h"
#include "codegen/cpp/functions/Conversions.h"
#include "codegen/cpp/functions/Expressions.h"
#include "codegen/cpp/functions/HitAnswers.h"
#include "codegen/cpp/functions/IntRanges.h"
#include "codegen/cpp/functions/Literals.h"
#include "codegen/cpp/functions/Lvalues.h"
#include "codegen/cpp/functions/Operators.h"
#include "codegen/cpp/functions/StatementPrinter.h"

namespace rtsl::cpp {

struct FunctionPrinter {
  /// `function` is null for an initialiser outside of functions, of a member of `owner` or at file
  /// level.
  FunctionPrinter(Context &context, const typed::Function *function,
                  const typed::Class *owner = nullptr);
  FunctionPrinter(const FunctionPrinter &) = delete;

  /// The name of a variable, a constant or a member.
  const std::string &nameOf(const void *entity) const;
  /// A name that the function does not use yet.
  std::string temporaryName(const std::string &hint);
  /// Puts the value into a variable, before the statement that is being made; its name.
  Code hoist(const Type *type, const std::string &hint, Code value);

  Context &context;
  const typed::Function *const function;
  const typed::Class *const owner;

  /// Where statements go that are evaluated before the one being made; null: there is no place.
  Statements *before = nullptr;
  bool isInLambda = false; // they are in a function of their own
  /// `temporaries` are the names of variables that the printer has added.
  std::set<std::string> usedNames, temporaries;
  std::set<const typed::Variable *> readVariables, hoistedDeclarations;
  std::map<const typed::Variable *, Interval> counters; // of loops

  /// In a state: expressions that the IR has computed, and the code for their values.
  std::map<const typed::Expr *, Code> replaced;
  bool isNested = true; // parts with effects are not among them
  /// In a state: the names of constants of functions, of which several may have the author's.
  std::map<const void *, std::string> constantNames;

  Literals literals;
  Expressions expressions;
  Conversions conversions;
  Operators operators;
  IntRanges ranges;
  Assignments assignments;
  Lvalues lvalues;
  Calls calls;
  Builtins builtins;
  HitAnswers hitAnswers;
  StatementPrinter statements;
};

} // namespace rtsl::cpp
