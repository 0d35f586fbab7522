//===- CleanUp.h - rewrites that make printed functions readable ----------===//
//
// The statements of a state are made one operation of the IR after the other. Each rewrite of this
// folder has a file and replaces one pattern of such statements by what a person would write. A
// rewrite that works on one statement has the signature
//
//   void rewrite(Statements &block, std::size_t &at, ...);
//
// and may change `block[at]` and what stands before it; `at` is then where that statement is.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

/// Applies all rewrites to the body of a function, inner blocks first. `frame` names the parameter
/// whose members are values that were saved.
void cleanUp(Statements &body, const std::string &frame);

} // namespace rtsl::cpp
