//===- StateGraph.h - the states of a program as a graph ------------------===//
//
// A cluster for each function that traces: its states, and edges for the transitions between them:
// a trace with the values that it saves, a call, a jump, or the end of the function.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/passes/continuation/Report.h"

namespace rtsl {

/// A graph in the language of Graphviz, which draws it (codegen/explain/Graphviz.h).
std::string toDot(const SplitReport &report);

} // namespace rtsl
