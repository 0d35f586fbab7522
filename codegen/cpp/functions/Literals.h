//===- Literals.h - numbers in C++ ----------------------------------------===//
#pragma once

#include "codegen/cpp/tree/Expression.h"

namespace rtsl::cpp {

/// The shortest literal of a number that reads back as it.
Code floatLiteral(float value);
Code doubleLiteral(double value);

} // namespace rtsl::cpp
