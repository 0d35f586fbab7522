//===- Walk.h - traversing a typed tree -----------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <functional>
#include <set>

namespace rtsl {

using ExprVisitor = std::function<void(const typed::Expr &)>;
using StmtVisitor = std::function<void(const typed::Stmt &)>;

/// Calls the visitors for the direct children of an expression or statement, in source order.
void forEachChild(const typed::Expr &expr, const ExprVisitor &visit);
void forEachChild(const typed::Stmt &stmt, const StmtVisitor &visitStmt,
                  const ExprVisitor &visitExpr);

/// Calls `visit` for each expression of a statement or below an expression, in preorder.
void forEachExpr(const typed::Stmt &stmt, const ExprVisitor &visit);
void forEachExpr(const typed::Expr &expr, const ExprVisitor &visit);
/// Calls `visit` for a statement and each nested one, in preorder.
void forEachStmt(const typed::Stmt &stmt, const StmtVisitor &visit);

/// The variable that an lvalue is, or is part of; null if it is not part of a variable.
const typed::Variable *rootVariable(const typed::Expr &place);

/// The variables that are assigned somewhere in a statement or expression, as a whole or in part.
std::set<const typed::Variable *> assignedVariables(const typed::Stmt &stmt);
std::set<const typed::Variable *> assignedVariables(const typed::Expr &expr);

} // namespace rtsl
