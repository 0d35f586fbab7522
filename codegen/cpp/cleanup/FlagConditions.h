//===- FlagConditions.h - flags that the compiler has made of && and || ---===//
#pragma once

#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

///   either = a || b;
///   if (either) ...    // at
///
/// becomes `if (a || b) ...`, where the compiler has named the flag and nothing else in the body
/// reads it. Reads of members of `frame` may stand between the two.
void inlineFlag(Statements &block, std::size_t &at, const Statements &body,
                const std::string &frame);

///   both = a;
///   if (both) both = b;    // at
///
/// becomes `both = a && b;`, and `if (!either) either = b;` an ||.
void joinFlagUpdate(Statements &block, std::size_t &at);

} // namespace rtsl::cpp
