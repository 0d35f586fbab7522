//===- HitAnswers.h - the ends of `anyHit` -------------------------------===//
//
// `ignoreIntersection()` and `terminateRay()` end `anyHit` at once, from functions that it calls
// too: in C++ each `return`s, and so does its caller. In the middle of an expression, where C++ has
// no `return`, an exception ends them all.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

class HitAnswers : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  /// `ignoreIntersection();` or `terminateRay();` as statements; empty if the expression is
  /// neither.
  Statements hitAnswer(const typed::Expr &expr);
  Code endOfAnyHit(const typed::BuiltinExpr &expr);
  /// Returns from the function if the call before it has ended `anyHit`.
  void leaveIfAnswered();
  bool mayEndAnyHit() const;
};

} // namespace rtsl::cpp
