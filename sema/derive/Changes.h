//===- Changes.h - which variables of a function change -------------------===//
#pragma once

#include "sema/derive/Derivation.h"

#include <set>

namespace rtsl::derive {

/// Finds which values of a function change across the footprint, and of which of them the change is
/// used.
class Changes {
public:
  Changes(Derivation &derivation, const typed::Function &function, bool isAtHit)
      : derivation(derivation), function(function), isAtHit(isAtHit) {}

  /// The function gets the changes of its parameters, along these axes.
  void addParameters(AxisSet given);
  /// Finds the variables. The changes of `returned` values are used along these axes.
  void find(AxisSet returned);

  /// May the value of the expression change? Values that cannot be followed count as constant.
  bool isVaried(const typed::Expr &expr) const;
  /// Do calls of the function also write the changes of its `out` parameters?
  bool followsOutputs(const typed::Function &called) const;
  /// Does a variable with its changes accompany this one?
  bool hasCompanions(const typed::Variable *variable) const {
    return varied.count(variable) != 0 && used.count(variable) != 0;
  }
  AxisSet usedAxes() const { return axesUsed; }
  bool atHit() const { return isAtHit; }

private:
  void collect();
  bool isFollowed(const typed::Function &called) const;
  bool isCallVaried(const typed::Function &function, const std::vector<typed::ExprPtr> &args) const;
  void use(const typed::Expr &expr);

  Derivation &derivation;
  const typed::Function &function;
  bool isAtHit;
  AxisSet axesUsed;
  // a variable, and an expression on which its value depends
  std::vector<std::pair<const typed::Variable *, const typed::Expr *>> dependences;
  /// A variable that a call writes as an `out` argument.
  struct Output {
    const typed::Variable *variable;
    const typed::Function *called;
    const std::vector<typed::ExprPtr> *args;
  };
  std::vector<Output> outputs;
  std::vector<const typed::Expr *> roots; // whose changes are used
  std::set<const typed::Variable *> varied, used;
};

} // namespace rtsl::derive
