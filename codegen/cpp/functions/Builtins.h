//===- Builtins.h - built-in functions -----------------------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

class Builtins : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  Code builtin(const typed::BuiltinExpr &expr);

private:
  Code withOutputs(const std::string &callee, const typed::BuiltinExpr &expr,
                   std::size_t firstOutput);
  Code print(const typed::BuiltinExpr &expr);
  Code atomic(const std::string &callee, const typed::BuiltinExpr &expr);
  Code tracePayload(const typed::BuiltinExpr &expr);
};

} // namespace rtsl::cpp
