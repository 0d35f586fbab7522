//===- HitAnswers.cpp - the ends of `anyHit` -------------------------------===//
//
// `ignoreIntersection()` and `terminateRay()` end `anyHit` at once, from functions that it calls
// too: in C++ each `return`s, and so does its caller. Where C++ has no `return`, in the middle of an
// expression, an exception ends them all.
//
//===----------------------------------------------------------------------===//
#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Casting.h"

namespace rtsl::cpp {

bool FunctionPrinter::mayEndAnyHit() const {
  return function && (!function->isStateMethod || function->name == "anyHit") &&
         context.signatures.mayAnswerHit(*function);
}

static Code answerIn(const typed::Expr &expr) {
  return call(std::string("rtsl::") + typed::name(cast<typed::BuiltinExpr>(expr).builtin),
              {name("rt")});
}

Statements FunctionPrinter::hitAnswer(const typed::Expr &expr) {
  if (!typed::isHitAnswer(expr))
    return {};
  if (function->returnType->is(TypeKind::Void))
    return {returning(answerIn(expr))};
  return {statement(answerIn(expr)), returning(list("", {}))};
}

Code FunctionPrinter::endOfAnyHit(const typed::BuiltinExpr &expr) {
  before->push_back(statement(answerIn(expr)));
  leaveIfAnswered();
  return {};
}

void FunctionPrinter::leaveIfAnswered() {
  if (isInLambda) {
    context.required.throwsFromAnyHit = true;
    before->push_back(statement(cpp::call("rtsl::endIfAnswered", {name("rt")})));
    return;
  }
  const Statement leave =
      returning(function->returnType->is(TypeKind::Void) ? Code() : list("", {}));
  before->push_back(branch(cpp::call("rtsl::isAnswered", {name("rt")}), {leave}));
}

} // namespace rtsl::cpp
