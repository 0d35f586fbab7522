//===- Calls.h - calls of the author's functions -------------------------===//
//
// RTSL copies arguments in and results of `out` parameters out, from left to right. C++ passes a
// reference to the lvalue where that cannot be noticed: nothing else reads or writes it during the
// call.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

class Calls : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  Code call(const typed::CallExpr &expr);
  Code methodCall(const typed::MethodCallExpr &expr);
  /// A call, the statements after it, and the variable of its result; nothing if it has none.
  Code valueThen(const Type *type, const std::string &hint, const Code &call,
                 const Statements &after);

private:
  Code callWith(const Code &callee, std::vector<Code> first, const typed::Function &function,
                const std::vector<typed::ExprPtr> &args, const Type *result);
};

} // namespace rtsl::cpp
