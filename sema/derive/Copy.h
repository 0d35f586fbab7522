//===- Copy.h - copies of typed trees -------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <map>

namespace rtsl::derive {

/// Copies expressions, with other variables in place of those of the original function. Derived
/// classes copy some expressions differently.
class Copier {
public:
  virtual ~Copier() = default;

  /// A copy of an expression; null for null.
  typed::ExprPtr copy(const typed::ExprPtr &expr) { return expr ? copy(*expr) : nullptr; }
  virtual typed::ExprPtr copy(const typed::Expr &expr) { return copyNode(expr); }

protected:
  /// A copy of the node, with copies of its children by `copy`.
  typed::ExprPtr copyNode(const typed::Expr &expr);
  std::vector<typed::ExprPtr> copies(const std::vector<typed::ExprPtr> &exprs);
  /// The variable of the copy.
  const typed::Variable *copyOf(const typed::Variable *variable) const;

  std::map<const typed::Variable *, const typed::Variable *> variables; // others stay

private:
  struct Filler;
};

} // namespace rtsl::derive
