//===- CountedLoops.h - a loop with a counter becomes a `for` -------------===//
#pragma once

#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

///   i = a;
///   while (i < b) { ...; i = rtsl::add(i, 1); }    // at
///
/// becomes `for (int i = a; i < b; ++i) { ... }`, if nothing else in the function's body mentions
/// i: below its bound an int is counted up without overflow.
void makeCountedLoop(Statements &block, std::size_t &at, const Statements &body);

} // namespace rtsl::cpp
