//===- Builtins.h - built-in functions -----------------------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

class Builtins : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  Code builtin(const typed::BuiltinExpr &expr);

private:
  // The functions that Builtins.def names
  Code atomic(const typed::BuiltinExpr &expr);
  Code hit(const typed::BuiltinExpr &expr);
  Code hitAnswer(const typed::BuiltinExpr &expr);
  Code print(const typed::BuiltinExpr &expr);
  Code tracePayload(const typed::BuiltinExpr &expr);
  Code withRay(const typed::BuiltinExpr &expr);

  Code withOutputs(const typed::BuiltinExpr &expr);
  Code callWith(std::vector<Code> first, const typed::BuiltinExpr &expr);
};

} // namespace rtsl::cpp
