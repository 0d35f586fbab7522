//===- DerivedBody.h - the derivation of one function ---------------------===//
#pragma once

#include "sema/derive/Changes.h"
#include "sema/derive/Copy.h"
#include "sema/derive/Derivation.h"
#include "sema/derive/Term.h"

namespace rtsl::derive {

/// A new variable with the same properties, without an initialiser.
std::unique_ptr<typed::Variable> variableLike(const typed::Variable &from);

/// The name, with underscores after it if a variable of the function has it already.
std::string freeName(const typed::Function &function, std::string name);

/// Writes a function without dFdx and dFdy: one that replaces it, or a variant of it. The copy has
/// variables of its own.
class DerivedBody : protected Copier {
public:
  /// `isAtHit`: rays have footprints there.
  DerivedBody(Derivation &derivation, const typed::Function &from, typed::Function &to,
              bool isAtHit);

  /// The same function: it keeps its parameters, whose changes are not known.
  void replace();
  /// A variant of it.
  void vary(Result result);

protected:
  // DerivedBody.cpp
  typed::Variable &addLocal(std::string name, const Type *type, SourceRange range);
  /// A variable for a value that is computed once, declared before the statement.
  const typed::Variable &addKept(const Type *type, SourceRange range);
  typed::StmtPtr declaration(const typed::Variable &variable) const;
  // DerivedStatements.cpp
  virtual void statement(const typed::Stmt &from, std::vector<typed::StmtPtr> &out);
  // DerivedExpressions.cpp
  typed::ExprPtr copy(const typed::Expr &expr) override;
  using Copier::copy;

  TypeContext &types;
  typed::Function &to;

private:
  /// Variables with the changes of another one; null along an axis for which it is not used.
  struct Companions {
    const typed::Variable *along[2] = {nullptr, nullptr};
  };

  // DerivedBody.cpp
  void run();
  void addCompanions(const typed::Variable &of, std::vector<typed::StmtPtr> &out,
                     const Term (&changes)[2]);
  const Companions *companionsOf(const typed::Expr &place) const;
  /// Moves the declarations of variables made by addKept to `out`.
  void declareKept(std::vector<typed::StmtPtr> &out);
  typed::StmtPtr assignment(const typed::Variable &variable, typed::ExprPtr value);

  // DerivedStatements.cpp
  typed::StmtPtr statement(const typed::StmtPtr &from);
  void declare(const typed::Variable &from, std::vector<typed::StmtPtr> &out);
  void evaluate(const typed::Expr &expr, SourceRange range, std::vector<typed::StmtPtr> &out);
  void forgetWritten(const typed::Expr &expr, std::vector<typed::StmtPtr> &out);
  void loop(const typed::ForStmt &from, std::vector<typed::StmtPtr> &out);
  typed::StmtPtr single(const typed::Stmt &from);
  typed::StmtPtr nested(const typed::StmtPtr &from);
  std::unique_ptr<typed::SwitchStmt> choice(const typed::SwitchStmt &from);
  std::unique_ptr<typed::IlluminanceStmt> illuminance(const typed::IlluminanceStmt &from);
  typed::ExprPtr returned(const typed::ExprPtr &value);

  // DerivedExpressions.cpp
  typed::ExprPtr derivativeOf(const typed::Expr &expr, Axis axis);
  typed::ExprPtr callWithFootprint(const typed::Expr &expr, const typed::Function &function,
                                   const std::vector<typed::ExprPtr> &args);
  bool isCalledWithFootprint(const typed::Function &function,
                             const std::vector<typed::ExprPtr> &args);
  typed::ExprPtr changeOfOutput(const typed::Variable &parameter, const typed::Expr &arg,
                                Axis axis);
  std::vector<typed::ExprPtr> assignmentSteps(const typed::AssignExpr &expr);

  // DerivedChanges.cpp
  /// The change of an expression's value.
  Term change(const typed::Expr &expr, Axis axis);
  Term changeOfState(const typed::StateExpr &expr, Axis axis);
  Term changeOfBinary(ast::BinaryOp op, const typed::Expr &left, const typed::Expr &right,
                      const Type *type, Axis axis);
  Term changeOfConstruct(const typed::ConstructExpr &expr, Axis axis);
  Term changeOfBuiltin(const typed::BuiltinExpr &expr, Axis axis);
  Term changeOfCall(const typed::Expr &expr, const typed::Function &function,
                    const std::vector<typed::ExprPtr> &args, Axis axis);
  typed::ExprPtr callOfVariant(const typed::Expr &call, const typed::Function &variant,
                               std::vector<typed::ExprPtr> args);
  /// The part of the companion that corresponds to a part of a variable.
  typed::ExprPtr companionPlace(const typed::Expr &place, Axis axis);
  /// The value of an expression again. If evaluating it twice could be observed, it is kept in a
  /// variable, which the next `copy` of the expression sets.
  Term factor(const typed::Expr &expr);

  Derivation &derivation;
  const typed::Function &from;
  Changes changes;
  Result result = Result::Value;
  std::map<const typed::Variable *, Companions> companions; // by variable of the original
  std::map<const typed::Expr *, const typed::Variable *> kept;
  std::vector<typed::StmtPtr> keptDeclarations; // before the next statement
  unsigned keptCount = 0;
};

} // namespace rtsl::derive
