//===- StateGraph.h - the states of a program as a picture ----------------===//
//
// For each function that traces, its states from the top to the bottom and the ways between them: a
// trace and what it saves, a jump, the end. As text for Graphviz, or drawn.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/Report.h"

namespace rtsl {

/// A `digraph` with a cluster a function.
std::string toDot(const SplitReport &report);
/// A document of its own, legible on light and dark pages.
std::string toSvg(const SplitReport &report);

} // namespace rtsl
