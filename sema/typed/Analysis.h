//===- Analysis.h - queries on typed trees --------------------------------===//
#pragma once

#include "sema/typed/Walk.h"

#include <map>
#include <string>
#include <vector>

namespace rtsl::typed {

/// Is it a variable or a parameter of the function?
bool isLocal(const Expr &expr);

/// The lvalue that a field or an element is part of.
const Expr &rootOf(const Expr &expr);

/// The lvalue that `place` is part of: as above, and also through components.
const Expr &wholeOf(const Expr &place);

/// Does it name all components of a vector in their order, such as `v.xyz` of a vec3? Then it is
/// the vector.
bool isWholeVector(const SwizzleExpr &expr);

/// Is it an element of an output buffer, or a part of one?
bool isInOutputBuffer(const Expr &place);

/// May evaluation have a side effect, or end without a value?
bool hasSideEffects(const Expr &expr);

/// No side effects, and cheaper than a branch: then `&&`, `||` and `?:` evaluate it
/// unconditionally.
bool isCheap(const Expr &expr);

/// `buffer[i][j]`: the buffer, and its indices from left to right, fewer than it has dimensions if
/// the expression is a row.
struct BufferAccess {
  const Expr *buffer;
  std::vector<const Expr *> indices;
};
BufferAccess bufferAccess(const IndexExpr &expr);

/// May the index be out of range? A constant one of an array, vector or matrix is not: the checker
/// has reported it. A row of a buffer alone is no access.
bool mayBeOutOfRange(const IndexExpr &expr);

/// The rays that evaluating this expression may send, not counting its operands: it is a built-in
/// function that sends rays, or a call. For a call that is dispatched: by any class of the module,
/// or by the function of the `concrete` class if the call is on an object of it.
SentRays raysOf(const Expr &expr, const Class *concrete = nullptr);

/// May it send rays with `trace`?
bool mayTrace(const Expr &expr, const Class *concrete = nullptr);

/// The payload of a call of `trace`; null without one.
const Expr *payloadOf(const BuiltinExpr &call);

/// Does `function`, or one of its callees, report hits or use scratch members? `concrete` is the
/// class of the object; null for a free function.
bool takesPartInIntersection(const Function &function, const Class *concrete);

/// An engine method that takes the payload of a ray as its one parameter.
bool takesPayload(const Function &function);

/// ignoreIntersection() or terminateRay()?
bool isHitAnswer(const Expr &expr);

/// Finds the functions that end `anyHit` because they, or their callees, use ignoreIntersection or
/// terminateRay. Sema ensures that only `anyHit` reaches them.
class HitAnswers {
public:
  explicit HitAnswers(const Module &module);

  /// For an object of class `concrete`, whose definitions are run by calls on the object itself;
  /// null for a free function.
  bool mayAnswer(const Function &function, const Class *concrete);
  /// For a call through a reference: for any class that derives from the function's.
  bool mayAnswerOf(const Function &function);

private:
  bool isFoundIn(const Function &function, const Class *concrete);

  const Module &module;
  const bool hasAnswers; // in some function of the module
  using Key = std::pair<const Function *, const Class *>;
  std::map<Key, bool> known;
  std::set<Key> open;         // being visited
  std::vector<Key> uncertain; // found while others were open
  bool comesRound = false;    // a visit reached an open one
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

/// The name of a method in the IR, for all classes: its name, followed by its parameters' types if
/// there are others of that name.
std::string slotName(const Module &module, const Function &method);

/// May a reference of the module refer to no object? The scene sets all public members, so this
/// requires a local variable, a private or optional member, or a buffer without elements.
bool mayReferToNothing(const Module &module);

/// Does any texture look up another one?
bool lookupsNest(const Module &module);

/// Is the expression an lvalue, or a part of a member or buffer, and not a temporary value?
bool isLvalue(const Expr &expr);

} // namespace rtsl::typed
