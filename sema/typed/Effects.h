//===- Effects.h - what evaluation reads and writes -----------------------===//
//
// The one analysis of effects on typed trees. RTSL evaluates operands from left to right, C++ in
// any order: the printer finds with it which operands depend on the order, which functions take the
// ray's state and which methods are const; reflection prints the same facts. These are properties
// of the author's expressions, which passes have changed in the IR. What operations of the IR read
// and write is found there (codegen/ir/MemoryAccesses.h). Which rays an
// expression sends is raysOf() (Analysis.h), which parts of a hit are read is found by linking
// (codegen/link/ModuleFacts.h).
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"
#include "sema/typed/Walk.h"

#include <map>
#include <set>

namespace rtsl::typed {

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
  bool raises = false;    // ends the sample at an index that is out of range

  void add(const Effects &other);
  bool operator==(const Effects &other) const;
  bool isPure() const { return writes.empty() && !random && !reportsHit && !hasOutput && !raises; }
};

/// Can it be observed if `second` is evaluated before `first`?
bool conflicts(const Effects &first, const Effects &second);

/// Is this a method of the table that no other method of the object calls?
bool isCalledByEngineAlone(const Function &function);

/// The first definition of a method, in the farthest base that has it.
const Function &overridden(const Function &function);

class EffectsOf {
public:
  /// `prints`: does `print` print? `raises`: does an index out of range end the sample?
  explicit EffectsOf(const Module &module, bool prints = false, bool raises = false);

  /// All expressions that are evaluated; the arguments of a `print` that prints nothing are not.
  template <typename Tree, typename Visit>
  void forEachEvaluated(const Tree &tree, const Visit &visit) const {
    std::set<const Expr *> silent;
    forEachExpr(tree, [&](const Expr &expr) {
      if (silent.count(&expr))
        return;
      if (isSilent(expr))
        forEachExpr(expr, [&](const Expr &inner) { silent.insert(&inner); });
      else
        visit(expr);
    });
  }
  /// A `print` that does nothing.
  bool isSilent(const Expr &expr) const;

  /// What a call does besides reading its arguments and writing its results: on members, the state
  /// and random numbers. Of a method that others override, what any of them does.
  const Effects &function(const Function &named);
  Effects expression(const Expr &expr);
  /// All that the statement does, without the variables that it declares.
  Effects statement(const Stmt &stmt);

  /// The address that stands for a state variable in `reads` and `writes`.
  static const void *place(StateVariable variable);

private:
  template <typename Tree>
  void collectAll(const Tree &tree, Effects &effects);
  void collect(const Expr &expr, Effects &effects);
  void collectBuiltin(const BuiltinExpr &builtin, Effects &effects);
  void collectWrite(const Expr &place, Effects &effects);
  void collectLights(Effects &effects);
  Effects ofBodies(const Function &function);
  void collectCall(const Function &callee, const std::vector<ExprPtr> &args, Effects &effects);

  const Module &module;
  bool prints, raises;
  std::map<const Function *, Effects> known;
  std::set<const Function *> open; // of which the effects are being found
  bool hasCycle = false;           // one of these was reached again
  bool texturesDraw = false;       // some texture's `lookup` draws random numbers
};

} // namespace rtsl::typed
