//===- JoinDeclarations.h - variables are declared where they get a value -===//
#pragma once

#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

/// Declares each variable with an open declaration in this block where it is first mentioned, if
/// that is an assignment in this block: `x = value;` becomes `float x = value;`. Declarations of
/// variables that are not mentioned are removed; all others stay where they are.
void joinDeclarations(Statements &block);

} // namespace rtsl::cpp
