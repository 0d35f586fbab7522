//===- ReportText.cpp - costs and savings of splitting, as text -----------===//
#include "codegen/explain/ReportText.h"

#include "llvm/ADT/StringExtras.h"
#include "llvm/Support/raw_ostream.h"

namespace rtsl {

/// Writes "rays: P waits for P, Shadow" and the like, and the size of the stack that follows from
/// it.
static void writeRays(llvm::raw_ostream &out, const SplitReport &report) {
  for (const RayGraph::Kind &kind : report.rays.kinds) {
    if (kind.sent == 0 && kind.sentLast == 0)
      continue;
    out << "rays: " << kind.name;
    if (kind.sent != 0)
      out << " waits for " << llvm::join(report.rays.names(kind.sent), ", ");
    if (kind.sentLast != 0)
      out << (kind.sent != 0 ? ", and" : "") << " is replaced by "
          << llvm::join(report.rays.names(kind.sentLast), ", ");
    out << "\n";
  }
  for (const continuation::TrimmedPayload &trimmed : report.trimmed)
    out << "payload " << trimmed.payload << ": " << trimmed.bytes << " bytes of "
        << trimmed.bytesBefore << "; not passed, because the methods for the ray do not use it: "
        << llvm::join(trimmed.fields, ", ") << "\n";
  const std::uint32_t levels = report.rays.levels(report.maxDepth);
  out << "stack: " << levels << (levels == 1 ? " level" : " levels") << " of "
      << report.levelBytes() << " bytes for rays as deep as " << report.maxDepth << ", "
      << (report.rays.grows() ? "more if that is larger" : "and no more if that is larger") << "\n";
  if (const std::uint32_t growth = report.frameGrowth())
    out << "stack: " << growth
        << " more bytes for each level and each object in the scene's longest chain of references, "
        << "because methods call themselves through them\n";
}

std::string listOf(const std::vector<LiveValue> &values) {
  const auto constants =
      llvm::count_if(values, [](const LiveValue &value) { return value.isConstant; });
  std::vector<std::string> shown;
  if (constants != 0)
    shown.push_back(constants == 1 ? "a constant" : std::to_string(constants) + " constants");
  for (const LiveValue &value : values)
    if (!value.isConstant)
      shown.push_back(value.name);
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

/// Writes which values are live, and how many remain to be saved after each optimisation.
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
    for (const TracePlace &last : function.tailTraces)
      out << "  trace" << (last.text().empty() ? "" : " at " + last.text())
          << ", a tail trace: its ray replaces this one, so recursion runs as a loop\n";
    for (const TraceReport &trace : function.traces) {
      const std::string place = trace.place.text();
      out << (trace.isJoin           ? "  join"
              : trace.callee.empty() ? "  trace"
                                     : "  call of " + trace.callee)
          << (place.empty() ? "" : " at " + place) << ", resumes at " << trace.resumesAt << "\n";
      writeTrace(out, trace);
      if (trace.onlyScalesAndAdds)
        out << "    then           only sums and products\n";
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
    if (!function.traces.empty() || !function.tailTraces.empty()) {
      if (function.endings.alwaysTraces)
        out << "  traces on every path: ends at the depth limit, or by what its rays hit\n";
      else if (!function.endings.by.empty())
        out << "  traces depending on " << llvm::join(function.endings.by, " and ") << "\n";
    }
  }
  if (!report.functions.empty())
    writeRays(out, report);
  return text;
}

} // namespace rtsl
