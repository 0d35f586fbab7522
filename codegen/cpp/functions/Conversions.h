//===- Conversions.h - conversions, constructors and swizzles ------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

class Conversions : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  Code convert(const typed::ConvertExpr &expr);
  Code construct(const typed::ConstructExpr &expr);
  Code swizzle(const typed::SwizzleExpr &expr);
};

} // namespace rtsl::cpp
