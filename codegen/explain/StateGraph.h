//===- StateGraph.h - the states of a program as a picture ----------------===//
//
// For each function that traces a cluster: its states, and edges for what leads from one to the
// next, which is a trace with what it saves, a call, a jump, or the end of the function.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/Report.h"

namespace rtsl {

/// In the language of Graphviz, which lays it out (codegen/explain/Graphviz.h).
std::string toDot(const SplitReport &report);

} // namespace rtsl
