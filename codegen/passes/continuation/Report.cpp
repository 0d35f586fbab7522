//===- Report.cpp - what splitting cost and saved -------------------------===//
#include "codegen/passes/continuation/Report.h"

#include "llvm/ADT/StringExtras.h"
#include "llvm/Support/JSON.h"
#include "llvm/Support/Path.h"
#include "llvm/Support/raw_ostream.h"

#include <algorithm>

namespace rtsl {

std::string TracePlace::text() const {
  if (file.empty())
    return {};
  return (llvm::sys::path::filename(file) + ":" + llvm::Twine(line) + ":" + llvm::Twine(column))
      .str();
}

std::uint32_t SplitReport::frameSize() const {
  std::uint32_t size = 0;
  for (const FunctionReport &function : functions)
    size = std::max(size, function.frame.size);
  return size;
}

static std::string list(const std::vector<std::string> &names) {
  return names.empty() ? "" : ": " + llvm::join(names, ", ");
}

std::string toText(const SplitReport &report) {
  std::string text;
  llvm::raw_string_ostream out(text);
  for (const FunctionReport &function : report.functions) {
    out << function.name << ": " << function.states.size()
        << (function.states.size() == 1 ? " state" : " states") << ", frame of "
        << function.frame.size << " bytes\n";
    for (const TraceReport &trace : function.traces) {
      const std::string place = trace.place.text();
      out << "  trace" << (place.empty() ? "" : " at " + place) << ", resumes at "
          << trace.resumesAt << "\n";
      out << "    live           " << trace.liveBytes << " bytes" << list(trace.live) << "\n";
      out << "    saved          " << trace.savedBytes << " bytes" << list(trace.saved) << "\n";
      out << "    rematerialised " << trace.rematerialised.size() << list(trace.rematerialised);
      if (trace.rematerialisedCost != 0)
        out << " (about " << trace.rematerialisedCost << " instructions)";
      out << "\n";
    }
    for (const continuation::FrameSlot &slot : function.frame.slots) {
      out << "  slot " << slot.offset;
      if (slot.bit >= 0)
        out << " bit " << slot.bit << ": ";
      else
        out << " to " << slot.offset + slot.size << ": ";
      out << slot.name << (slot.isObject ? " (an object)" : "") << "\n";
    }
  }
  return text;
}

std::string toJson(const SplitReport &report) {
  std::string text;
  llvm::raw_string_ostream out(text);
  llvm::json::OStream json(out, 2);
  auto names = [&](llvm::StringRef key, const std::vector<std::string> &values) {
    json.attributeArray(key, [&] {
      for (const std::string &value : values)
        json.value(value);
    });
  };
  json.object([&] {
    json.attribute("version", 1);
    json.attribute("frameSize", report.frameSize());
    json.attributeArray("functions", [&] {
      for (const FunctionReport &function : report.functions)
        json.object([&] {
          json.attribute("name", function.name);
          json.attribute("frameSize", function.frame.size);
          json.attribute("frameLowerBound", function.frame.lowerBound);
          names("states", function.states);
          json.attributeArray("traces", [&] {
            for (const TraceReport &trace : function.traces)
              json.object([&] {
                json.attribute("location", trace.place.text());
                json.attribute("resumesAt", trace.resumesAt);
                json.attribute("liveBytes", trace.liveBytes);
                names("live", trace.live);
                json.attribute("savedBytes", trace.savedBytes);
                names("saved", trace.saved);
                names("rematerialised", trace.rematerialised);
                json.attribute("rematerialisedCost", trace.rematerialisedCost);
              });
          });
          json.attributeArray("slots", [&] {
            for (const continuation::FrameSlot &slot : function.frame.slots)
              json.object([&] {
                json.attribute("name", slot.name);
                json.attribute("offset", slot.offset);
                json.attribute("size", slot.size);
                if (slot.bit >= 0)
                  json.attribute("bit", slot.bit);
                if (slot.isObject)
                  json.attribute("object", true);
              });
          });
        });
    });
  });
  out << "\n";
  return text;
}

} // namespace rtsl
