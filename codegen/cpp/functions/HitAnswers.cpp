#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Casting.h"

namespace rtsl::cpp {

bool HitAnswers::mayEndAnyHit() const {
  return printer.function &&
         (!printer.function->isStateMethod || printer.function->name == "anyHit") &&
         context.signatures.mayAnswerHit(*printer.function);
}

static Code answerIn(const typed::Expr &expr) {
  return call(std::string("rtsl::") + typed::name(cast<typed::BuiltinExpr>(expr).builtin),
              {name("rt")});
}

Statements HitAnswers::hitAnswer(const typed::Expr &expr) {
  if (!typed::isHitAnswer(expr))
    return {};
  if (printer.function->returnType->is(TypeKind::Void))
    return {returning(answerIn(expr))};
  return {statement(answerIn(expr)), returning(list("", {}))};
}

Code HitAnswers::endOfAnyHit(const typed::BuiltinExpr &expr) {
  printer.before->push_back(statement(answerIn(expr)));
  leaveIfAnswered();
  return {};
}

void HitAnswers::leaveIfAnswered() {
  if (printer.isInLambda) {
    context.required.throwsFromAnyHit = true;
    printer.before->push_back(statement(cpp::call("rtsl::endIfAnswered", {name("rt")})));
    return;
  }
  const Statement leave =
      returning(printer.function->returnType->is(TypeKind::Void) ? Code() : list("", {}));
  printer.before->push_back(branch(cpp::call("rtsl::isAnswered", {name("rt")}), {leave}));
}

} // namespace rtsl::cpp
