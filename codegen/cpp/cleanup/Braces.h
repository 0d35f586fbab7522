//===- Braces.h - braces of branches and cases ----------------------------===//
#pragma once

#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

/// Gives the branches of an `if` braces unless they are one short statement, and the cases of a
/// `switch` if they declare variables.
void setBraces(Statement &statement);

} // namespace rtsl::cpp
