//===- ReportText.cpp - what splitting cost and saved, as text ------------===//
#include "codegen/explain/ReportText.h"

#include "llvm/ADT/StringExtras.h"
#include "llvm/Support/raw_ostream.h"

namespace rtsl {

/// "rays: P waits for P, Shadow" and the like, and how large a stack follows from it.
static void writeRays(llvm::raw_ostream &out, const SplitReport &report) {
  for (const RayGraph::Kind &kind : report.rays.kinds) {
    if (kind.sent == 0 && kind.sentLast == 0)
      continue;
    out << "rays: " << kind.name;
    if (kind.sent != 0)
      out << " waits for " << llvm::join(report.rays.names(kind.sent), ", ");
    if (kind.sentLast != 0)
      out << (kind.sent != 0 ? ", and" : "") << " gives its place to "
          << llvm::join(report.rays.names(kind.sentLast), ", ");
    out << "\n";
  }
  for (const continuation::TrimmedPayload &trimmed : report.trimmed)
    out << "payload " << trimmed.payload << ": " << trimmed.bytes << " bytes of "
        << trimmed.bytesBefore << "; not passed, for nobody there reads it, "
        << llvm::join(trimmed.fields, ", ") << "\n";
  const std::uint32_t levels = report.rays.levels(report.maxDepth);
  out << "stack: " << levels << (levels == 1 ? " level" : " levels") << " of "
      << report.levelBytes() << " bytes for rays as deep as " << report.maxDepth << ", "
      << (report.rays.grows() ? "more if that is larger" : "and no more if that is larger") << "\n";
  if (const std::uint32_t growth = report.frameGrowth())
    out << "stack: " << growth
        << " bytes more a level for each object in the scene's longest chain of references, "
        << "for methods call themselves through them\n";
}

/// "constant", or "constant.2": one that the author has not named.
static bool isConstant(llvm::StringRef name) {
  return name == "constant" || name.starts_with("constant.");
}

std::string listOf(const std::vector<std::string> &names) {
  const auto constants = llvm::count_if(names, isConstant);
  std::vector<std::string> shown;
  if (constants != 0)
    shown.push_back(constants == 1 ? "a constant" : std::to_string(constants) + " constants");
  llvm::copy_if(names, std::back_inserter(shown),
                [](const std::string &name) { return !isConstant(name); });
  return shown.empty() ? "" : ": " + llvm::join(shown, ", ");
}

std::string toText(const BytesRange &range) {
  const std::string least = range.least == range.most ? "" : std::to_string(range.least) + " to ";
  return least + std::to_string(range.most) + " bytes";
}

static std::string count(unsigned number, llvm::StringRef what) {
  return (std::to_string(number) + " " + what + (number == 1 ? "" : "s")).str();
}

static std::string describe(const ExtraReport &extra) {
  std::string text = extra.recomputed == 0 ? "" : count(extra.recomputed, "operation") + " again, ";
  return text + count(extra.stores, "store") + ", " + count(extra.loads, "load") + ", cost " +
         std::to_string(extra.cost);
}

/// What is live, and how much of it is left after each optimisation.
static void writeTrace(llvm::raw_ostream &out, const TraceReport &trace) {
  out << "    live           " << trace.liveBytes << " bytes" << listOf(trace.live) << "\n";
  for (const StepReport &step : trace.steps)
    if (llvm::StringRef(step.step) == "trim-vectors" && step.savedBytes != trace.liveBytes)
      out << "    trimmed        " << step.savedBytes << " bytes\n";
  out << "    rematerialised " << trace.rematerialisedBytes << " bytes"
      << listOf(trace.rematerialised) << "\n";
  out << "    saved          " << trace.savedBytes << " bytes" << listOf(trace.saved) << "\n";
  if (trace.liveBytes == 0 && trace.savedBytes == 0)
    return;
  const TraceTraffic &traffic = trace.steps.back().traffic;
  out << "    stored         " << toText(traffic.stored) << "\n";
  out << "    restored       " << toText(traffic.restored) << "\n";
  out << "    extra          " << describe(trace.extra) << "; of plain liveness "
      << describe(trace.plainly) << "\n";
}

std::string toText(const SplitReport &report) {
  std::string text;
  llvm::raw_string_ostream out(text);
  for (const FunctionReport &function : report.functions) {
    out << function.name << ": " << function.states.size()
        << (function.states.size() == 1 ? " state" : " states") << ", frame of "
        << function.frame.size << " bytes\n";
    for (const TracePlace &last : function.lastTraces)
      out << "  trace" << (last.text().empty() ? "" : " at " + last.text())
          << ", the last: its ray takes the place of this one, so recursion runs as a loop\n";
    for (const TraceReport &trace : function.traces) {
      const std::string place = trace.place.text();
      out << (trace.isJoin           ? "  join"
              : trace.callee.empty() ? "  trace"
                                     : "  call of " + trace.callee)
          << (place.empty() ? "" : " at " + place) << ", resumes at " << trace.resumesAt << "\n";
      writeTrace(out, trace);
      if (trace.onlyScalesAndAdds)
        out << "    then           sums and products alone\n";
    }
    if (function.frame.unshared != function.frame.size)
      out << "  frame: " << function.frame.unshared << " bytes if nothing shared words, at least "
          << function.frame.lowerBound << "\n";
    for (const continuation::FrameSlot &slot : function.frame.slots) {
      out << "  slot " << slot.offset;
      if (slot.bit >= 0)
        out << " bit " << slot.bit << ": ";
      else
        out << " to " << slot.offset + slot.size << ": ";
      out << slot.name << (slot.isObject ? " (an object)" : "") << "\n";
    }
    if (!function.traces.empty() || !function.lastTraces.empty()) {
      if (function.endings.alwaysTraces)
        out << "  traces on every way: the limit of depth ends it, or what its rays meet\n";
      else if (!function.endings.by.empty())
        out << "  traces or not by " << llvm::join(function.endings.by, " and ") << "\n";
    }
  }
  if (!report.functions.empty())
    writeRays(out, report);
  return text;
}

} // namespace rtsl
