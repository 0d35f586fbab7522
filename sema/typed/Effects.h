//===- Effects.h - what evaluation reads and writes -----------------------===//
//
// RTSL evaluates operands from left to right, C++ in any order. The printer therefore finds which
// operands depend on the order; the same facts decide which functions take the ray's state and
// which methods are const, and reflection prints them. These are properties of the author's
// expressions as C++ evaluates them, which the IR does not represent. Which rays an expression
// sends is decided by sema (typed::raysOf), which parts of a hit are read by linking
// (codegen/link/ModuleFacts.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"
#include "sema/typed/Walk.h"

#include <map>
#include <set>

namespace rtsl::cpp {

/// Lvalues, each a variable, a member or a state variable; `random` is the sequence of random
/// numbers, `nearest` the hit so far.
struct Effects {
  std::set<const void *> reads, writes;
  bool random = false; // draws random numbers
  bool reportsHit = false;
  bool usesRay = false; // needs the state for anything: state variables, other objects, rays
  bool usesScratch = false;
  bool writesScratch = false;
  bool writesMembers = false;
  bool hasOutput = false; // does something that cannot be named, such as printing

  void add(const Effects &other);
  bool operator==(const Effects &other) const;
  bool isPure() const { return writes.empty() && !random && !reportsHit && !hasOutput; }
};

/// Would it show if `second` were evaluated before `first`?
bool conflicts(const Effects &first, const Effects &second);

/// Is this a method of the table that no other method of the object calls?
bool isCalledByEngineAlone(const typed::Function &function);

/// The first definition of a method, in the farthest base that has it.
const typed::Function &overridden(const typed::Function &function);

class EffectsOf {
public:
  /// `prints`: does `print` print? `raises`: does an index out of range use the state?
  explicit EffectsOf(const typed::Module &module, bool prints = false, bool raises = false);

  /// All expressions that are evaluated: not what a `print` would print that prints nothing.
  template <typename Tree, typename Visit>
  void forEachEvaluated(const Tree &tree, const Visit &visit) const {
    std::set<const typed::Expr *> silent;
    forEachExpr(tree, [&](const typed::Expr &expr) {
      if (silent.count(&expr))
        return;
      if (isSilent(expr))
        forEachExpr(expr, [&](const typed::Expr &inner) { silent.insert(&inner); });
      else
        visit(expr);
    });
  }
  /// A `print` that does nothing.
  bool isSilent(const typed::Expr &expr) const;

  /// What a call does besides reading its arguments and writing its results: on members, the state
  /// and random numbers. Of a method that others override, what any of them does.
  const Effects &function(const typed::Function &named);
  Effects expression(const typed::Expr &expr);
  /// All that the statement does, without the variables that it declares.
  Effects statement(const typed::Stmt &stmt);

  /// The address that stands for a state variable in `reads` and `writes`.
  static const void *place(typed::StateVariable variable);

private:
  template <typename Tree>
  void collectAll(const Tree &tree, Effects &effects);
  void collect(const typed::Expr &expr, Effects &effects);
  void collectBuiltin(const typed::BuiltinExpr &builtin, Effects &effects);
  void collectWrite(const typed::Expr &place, Effects &effects);
  void collectLights(Effects &effects);
  Effects ofBodies(const typed::Function &function);
  void collectCall(const typed::Function &callee, const std::vector<typed::ExprPtr> &args,
                   Effects &effects);

  const typed::Module &module;
  bool prints, raises;
  std::map<const typed::Function *, Effects> known;
  std::set<const typed::Function *> open; // of which the effects are being found
  bool hasCycle = false;                  // one of these was reached again
  bool texturesDraw = false;              // some texture's `lookup` draws random numbers
};

} // namespace rtsl::cpp
