//===- FieldAssignments.h - assignments to all fields of a struct ---------===//
#pragma once

#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

///   a.x = b.x;
///   a.y = b.y;    // at: the last field
///
/// becomes `a = b;`, and zeros for all fields `a = {};`. Passes copy and clear structs in this way.
void joinFieldAssignments(Statements &block, std::size_t &at);

} // namespace rtsl::cpp
