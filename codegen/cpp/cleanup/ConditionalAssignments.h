//===- ConditionalAssignments.h - a variable that both branches assign ----===//
#pragma once

#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

///   if (c) x = a; else x = b;    // at
///
/// becomes `x = c ? a : b;`, or with && or || where a value is `true`, `false` or the condition. A
/// condition that the compiler has named and that only this statement of the body reads is
/// inlined.
void joinConditionalAssignments(Statements &block, std::size_t &at, const Statements &body);

/// `condition ? first : second`. C++ requires both values to be of one type, and a vector of bools
/// has another type in memory: there both are made a `type`.
Code choose(Code condition, Code first, Code second, const std::string &type, bool isVectorOfBools);

} // namespace rtsl::cpp
