//===- OverwrittenZeros.h - `x = {}; x = value;` --------------------------===//
#pragma once

#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

///   x = {};
///   x = value;    // at
///
/// loses its first statement if the value does not read x.
void removeOverwrittenZero(Statements &block, std::size_t &at);

} // namespace rtsl::cpp
