//===- Assignments.h - assignments ---------------------------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPart.h"

namespace rtsl::cpp {

class Assignments : FunctionPart {
public:
  using FunctionPart::FunctionPart;

  Code assign(const typed::AssignExpr &expr, bool resultIsUsed);
  /// `target.z = from.x; target.x = from.y;`
  void assignComponents(const Code &target, const std::vector<std::uint8_t> &parts,
                        const Code &from, Statements &out);
  Code incDec(const typed::IncDecExpr &expr, bool resultIsUsed);
  /// `value + 1` or `value - 1`
  Code stepped(const Code &value, const Type *scalar, bool increment);
};

} // namespace rtsl::cpp
