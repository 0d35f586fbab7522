//===- Analysis.h - facts about typed trees -------------------------------===//
#pragma once

#include "sema/typed/Walk.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::typed {

/// The arguments that a built-in function writes: the first of them, and how many; none: 0, 0.
std::pair<std::size_t, std::size_t> outputsOf(Builtin builtin);

/// Is it a variable or a parameter of the function?
bool isLocal(const Expr &expr);

/// The place that a field or an element is part of.
const Expr &rootOf(const Expr &expr);

/// What a place is part of: as above, and through components too.
const Expr &wholeOf(const Expr &place);

/// May evaluation change something, or end in another way than with a value?
bool hasSideEffects(const Expr &expr);

/// Nothing changes, and it costs less than a branch: then `&&`, `||` and `?:` evaluate it in any
/// case.
bool isCheap(const Expr &expr);

/// Does `function`, or what it calls, report hits or use scratch members? `concrete` is the class
/// of the object; null for a free function.
bool takesPartInIntersection(const Function &function, const Class *concrete);

/// A method of the engine's that answers rays with a payload, its one parameter: it comes with the
/// ray.
bool takesPayload(const Function &function);

/// ignoreIntersection() or terminateRay()?
bool isHitAnswer(const Expr &expr);

/// Which functions end `anyHit`, because they, or what they call, use ignoreIntersection or
/// terminateRay. The checker lets nothing but `anyHit` lead to these.
class HitAnswers {
public:
  explicit HitAnswers(const Module &module);

  /// For an object of class `concrete`, whose definitions calls on the object itself run; null for
  /// a free function.
  bool mayAnswer(const Function &function, const Class *concrete);
  /// For a call through a reference: whichever class below the function's has the object.
  bool mayAnswerOf(const Function &function);

private:
  bool isFoundIn(const Function &function, const Class *concrete);

  const Module &module;
  const bool hasAnswers; // in some function of the module
  using Key = std::pair<const Function *, const Class *>;
  std::map<Key, bool> known;
  std::set<Key> open;         // that are being looked at
  std::vector<Key> uncertain; // found while others were open
  bool comesRound = false;    // to one of these
};

/// The definition that a call on the object itself runs: that of the most derived class with the
/// callee's parameters.
const Function &resolve(const Function &callee, const Class *concrete);
/// The definition that a call runs on an object of this class.
const Function &resolve(const CallExpr &call, const Class *concrete);

/// Do two functions have the same parameter types?
bool sameParameters(const Function &a, const Function &b);

/// The types of a function's parameters as a part of a symbol: `.vec3.float_4`.
std::string parameterWords(const Function &function);

/// What the IR calls a method, whatever class has it: its name, with its parameters' types where
/// others have that name.
std::string slotName(const Module &module, const Function &method);

/// May a reference of the module refer to no object? The scene sets all public members, so that it
/// takes a variable, a private or an optional member that nobody has written, or a buffer without
/// elements.
bool mayReferToNothing(const Module &module);

/// Does some texture look up another?
bool lookupsNest(const Module &module);

/// Does the expression stand for a place in memory (and not for a value)?
bool isPlace(const Expr &expr);

} // namespace rtsl::typed
