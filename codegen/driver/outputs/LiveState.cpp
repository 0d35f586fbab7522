//===- LiveState.cpp - -Wlive-state ---------------------------------------===//
#include "codegen/driver/Compilation.h"
#include "codegen/driver/Places.h"

#include <fmt/format.h>

#include <algorithm>

namespace rtsl {

/// Warns of a trace across which much is live: values that are saved, and variables in the frame.
static void warnOfLiveState(const TraceReport &trace, const continuation::FrameLayout &frame,
                            std::uint32_t largeLiveState, Diagnostics &diagnostics) {
  struct Part {
    std::string name;
    std::uint32_t bytes;
  };
  std::vector<Part> parts;
  std::uint32_t bytes = trace.savedBytes;
  for (std::size_t i = 0; i != trace.saved.size(); ++i)
    parts.push_back({trace.savedShown[i], trace.savedSizes[i]});
  for (const continuation::FrameSlot &slot : frame.slots)
    if (slot.isObject) {
      parts.push_back({"`" + slot.name + "`", slot.size});
      bytes += slot.size;
    }
  if (bytes <= largeLiveState)
    return;
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part &a, const Part &b) { return a.bytes > b.bytes; });

  Diagnostic &diagnostic =
      diagnostics.report(Code::liveState, driver::rangeAt(trace.place, "trace", diagnostics), bytes,
                         largeLiveState, parts.front().name, parts.front().bytes);
  std::string others;
  for (std::size_t i = 1; i < parts.size(); ++i)
    others += fmt::format("{}{} ({})", i == 1 ? "" : ", ", parts[i].name, parts[i].bytes);
  if (!others.empty())
    diagnostic.note("also saved: " + others);
}

void checkLiveState(const typed::Module &module, const CompileOptions &options,
                    Diagnostics &diagnostics) {
  if (!diagnostics.warnings.isOn(Code::liveState))
    return;
  CompileInput input;
  input.module = &module;
  Diagnostics refusals(diagnostics.sources()); // discarded: other commands report them
  driver::Compilation compilation(input, options, refusals);
  if (!driver::reachIr(compilation) || refusals.hasErrors())
    return;
  driver::reachStates(compilation);
  for (const FunctionReport &function : compilation.report.functions)
    for (const TraceReport &trace : function.traces)
      if (!trace.isJoin)
        warnOfLiveState(trace, function.frame, options.largeLiveState, diagnostics);
}

} // namespace rtsl
