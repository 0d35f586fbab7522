//===- StateGraph.cpp - the states of a program as a graph ----------------===//
#include "codegen/explain/StateGraph.h"

#include "codegen/explain/ReportText.h"

#include "llvm/Support/raw_ostream.h"

#include <algorithm>

namespace rtsl {

namespace {

/// "Glass.shade.state1" of function "Glass.shade" is "state1".
std::string shortName(const FunctionReport &function, const std::string &state) {
  const std::string prefix = function.name + ".";
  return state.compare(0, prefix.size(), prefix) == 0 ? state.substr(prefix.size()) : state;
}

bool isOwn(const FunctionReport &function, const std::string &state) {
  return std::find(function.states.begin(), function.states.end(), state) != function.states.end();
}

/// The text of a node: the state, and for one after a trace its location and the values saved.
std::vector<std::string> linesOf(const FunctionReport &function, const std::string &state) {
  std::vector<std::string> lines = {shortName(function, state)};
  for (const TraceReport &trace : function.traces) {
    if (trace.resumesAt != state)
      continue;
    const std::string place = trace.place.text();
    const std::string what = trace.isJoin           ? "join"
                             : trace.callee.empty() ? "trace"
                                                    : "call of " + trace.callee;
    lines.push_back(place.empty() ? "after a " + what : "after the " + what + " at " + place);
    lines.push_back(std::to_string(trace.savedBytes) + " of " + std::to_string(trace.liveBytes) +
                    " bytes saved" + listOf(trace.saved));
    if (!trace.rematerialised.empty())
      lines.push_back("recomputed" + listOf(trace.rematerialised));
    if (trace.liveBytes != 0) {
      const TraceTraffic &traffic = trace.steps.back().traffic;
      lines.push_back(toText(traffic.stored) + " stored, " + toText(traffic.restored) +
                      " restored; cost " + std::to_string(trace.extra.cost) + " of " +
                      std::to_string(trace.plainly.cost));
    }
  }
  for (const TransitionReport &transition : function.transitions) {
    if (transition.from != state)
      continue;
    if (transition.kind == TransitionReport::Last)
      lines.push_back("tail trace: its ray replaces this one");
    if (transition.kind == TransitionReport::Return)
      lines.push_back("returns to the caller");
    if (!transition.to.empty() && !isOwn(function, transition.to))
      lines.push_back("or continues in " + transition.to);
  }
  return lines;
}

std::string titleOf(const FunctionReport &function) {
  const std::size_t count = function.states.size();
  return function.name + ": " + std::to_string(count) + (count == 1 ? " state" : " states") +
         ", frame of " + std::to_string(function.frame.size) + " bytes";
}

std::string escaped(llvm::StringRef text, llvm::StringRef special,
                    llvm::ArrayRef<const char *> by) {
  std::string result;
  for (char c : text) {
    const std::size_t which = special.find(c);
    if (which == llvm::StringRef::npos)
      result += c;
    else
      result += by[which];
  }
  return result;
}

std::string inQuotes(const std::string &text) {
  return "\"" + escaped(text, "\"\\", {"\\\"", "\\\\"}) + "\"";
}

} // namespace

/// The style of an edge: a trace or a call continues elsewhere first, a jump does not.
static const char *attributesOf(TransitionReport::Kind kind) {
  switch (kind) {
  case TransitionReport::Trace:
    return "label=\"trace\"";
  case TransitionReport::Call:
    return "label=\"call\"";
  default:
    return "style=dashed";
  }
}

static void writeNodes(llvm::raw_ostream &out, const FunctionReport &function) {
  for (const std::string &state : function.states) {
    std::string label;
    for (const std::string &line : linesOf(function, state))
      label += escaped(line, "\"\\", {"\\\"", "\\\\"}) + "\\l";
    out << "    " << inQuotes(state) << " [label=\"" << label << '"'
        << (&state == &function.states.front() ? ", class=\"first\"" : "") << "];\n";
  }
}

static void writeEdges(llvm::raw_ostream &out, const FunctionReport &function) {
  for (const TransitionReport &transition : function.transitions) {
    std::string to = transition.to;
    if (to.empty()) { // the function ends: in a tail trace, or by returning
      const bool isTailTrace = transition.kind == TransitionReport::Last;
      to = transition.from + (isTailTrace ? " last" : " done");
      out << "    " << inQuotes(to)
          << (isTailTrace ? " [shape=circle, label=\"\", width=0.12];\n" : " [shape=point];\n");
      out << "    " << inQuotes(transition.from) << " -> " << inQuotes(to) << ";\n";
      continue;
    }
    out << "    " << inQuotes(transition.from) << " -> " << inQuotes(to) << " ["
        << attributesOf(transition.kind) << "];\n";
  }
}

std::string toDot(const SplitReport &report) {
  std::string text;
  llvm::raw_string_ostream out(text);
  out << "digraph states {\n"
         "  graph [fontname=\"monospace\"];\n"
         "  node [shape=box, margin=\"0.3,0.08\", fontname=\"monospace\"];\n"
         "  edge [fontname=\"monospace\"];\n";
  if (report.functions.empty())
    out << "  none [shape=plaintext, label=\"No function traces a ray.\"];\n";
  for (const FunctionReport &function : report.functions) {
    out << "  subgraph " << inQuotes("cluster " + function.name) << " {\n";
    out << "    label=" << inQuotes(titleOf(function)) << ";\n";
    writeNodes(out, function);
    writeEdges(out, function);
    out << "  }\n";
  }
  out << "}\n";
  return text;
}

} // namespace rtsl
