//===- StatementPrinter.h - statements -----------------------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

class StatementPrinter : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  /// The statements of the function's body.
  Statements body();
  /// What an expression does, as statements; its value is not used.
  Statements expressionStatement(const typed::Expr &expr);

private:
  void print(const typed::Stmt &stmt, Statements &out);
  void print(const std::vector<typed::StmtPtr> &statements, Statements &out);
  Statements block(const std::vector<typed::StmtPtr> &statements);
  /// The statement without its comment; what goes before it is put there.
  Statements construct(const typed::Stmt &stmt);
  /// The body of an `if` or a loop.
  Statements nested(const typed::StmtPtr &stmt, bool &hasBraces);
  void nest(const typed::StmtPtr &stmt, Statement &under);
  /// `inHeader`: of a `for`, whose own declaration comes last.
  Statements declaration(const typed::DeclarationStmt &stmt, bool inHeader);
  Statement ifStatement(const typed::IfStmt &stmt);
  Statement forStatement(const typed::ForStmt &stmt);
  Code stepOf(const typed::Expr &expr);
  Statement switchStatement(const typed::SwitchStmt &stmt);
  Statement illuminance(const typed::IlluminanceStmt &stmt);
  void noteCounter(const typed::ForStmt &stmt);
};

/// `for (rtsl::Lights lights(rt, arguments); lights.next();)`, without a body.
Statement lightLoop(const std::string &lights, std::vector<Code> arguments);

} // namespace rtsl::cpp
