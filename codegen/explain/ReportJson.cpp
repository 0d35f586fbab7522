//===- ReportJson.cpp - costs and savings of splitting, as JSON -----------===//
#include "codegen/explain/ReportJson.h"

#include <nlohmann/json.hpp>

namespace rtsl {

using Json = nlohmann::ordered_json;

static Json jsonOf(const StepReport &step) {
  return {{"after", step.step},
          {"savedBytes", step.savedBytes},
          {"storedBytes", step.traffic.stored.most},
          {"storedBytesLeast", step.traffic.stored.least},
          {"restoredBytes", step.traffic.restored.most},
          {"restoredBytesLeast", step.traffic.restored.least}};
}

static Json jsonOf(const ExtraReport &extra) {
  return {{"recomputedOperations", extra.recomputed},
          {"stores", extra.stores},
          {"loads", extra.loads},
          {"cost", extra.cost}};
}

static Json namesOf(const std::vector<LiveValue> &values) {
  Json names = Json::array();
  for (const LiveValue &value : values)
    names.push_back(value.name);
  return names;
}

static Json jsonOf(const TraceReport &trace) {
  Json json = {{"location", trace.place.text()}};
  if (trace.isJoin)
    json["join"] = true;
  if (!trace.callee.empty())
    json["callee"] = trace.callee;
  json["resumesAt"] = trace.resumesAt;
  json["liveBytes"] = trace.liveBytes;
  json["live"] = namesOf(trace.live);
  json["savedBytes"] = trace.savedBytes;
  json["saved"] = namesOf(trace.saved);
  json["rematerialised"] = namesOf(trace.rematerialised);
  json["rematerialisedBytes"] = trace.rematerialisedBytes;
  json["steps"] = Json::array();
  for (const StepReport &step : trace.steps)
    json["steps"].push_back(jsonOf(step));
  json["extra"] = jsonOf(trace.extra);
  json["extraOfPlainLiveness"] = jsonOf(trace.plainly);
  json["onlyScalesAndAdds"] = trace.onlyScalesAndAdds;
  return json;
}

static Json jsonOf(const continuation::FrameSlot &slot) {
  Json json = {{"name", slot.name}, {"offset", slot.offset}, {"size", slot.size}};
  if (slot.bit >= 0)
    json["bit"] = slot.bit;
  if (slot.isObject)
    json["object"] = true;
  return json;
}

static Json jsonOf(const FunctionReport &function) {
  Json json = {{"name", function.name},
               {"frameSize", function.frame.size},
               {"frameSizeUnshared", function.frame.unshared},
               {"frameLowerBound", function.frame.lowerBound},
               {"states", function.states},
               {"alwaysTraces", function.endings.alwaysTraces},
               {"endsBy", function.endings.by},
               {"lastTraces", Json::array()},
               {"traces", Json::array()},
               {"slots", Json::array()}};
  for (const TracePlace &last : function.tailTraces)
    json["lastTraces"].push_back(last.text());
  for (const TraceReport &trace : function.traces)
    json["traces"].push_back(jsonOf(trace));
  for (const continuation::FrameSlot &slot : function.frame.slots)
    json["slots"].push_back(jsonOf(slot));
  return json;
}

static Json describeStack(const SplitReport &report) {
  const std::uint32_t levels = report.rays.levels(report.maxDepth);
  Json json = {{"depth", report.maxDepth},
               {"levels", levels},
               {"levelBytes", report.levelBytes()},
               {"bytes", levels * report.levelBytes()},
               {"growsWithDepth", report.rays.grows()}};
  if (report.frameGrowth() != 0)
    json["levelBytesAReference"] = report.frameGrowth();
  return json;
}

Json jsonOf(const SplitReport &report) {
  Json json = {{"version", 1},
               {"frameSize", report.frameSize()},
               {"stack", describeStack(report)},
               {"payloads", Json::array()},
               {"rays", Json::array()},
               {"functions", Json::array()}};
  for (const continuation::TrimmedPayload &trimmed : report.trimmed)
    json["payloads"].push_back({{"name", trimmed.payload},
                                {"bytes", trimmed.bytes},
                                {"bytesBefore", trimmed.bytesBefore},
                                {"notPassed", trimmed.fields}});
  for (const RayGraph::Kind &kind : report.rays.kinds)
    json["rays"].push_back({{"kind", kind.name},
                            {"waitsFor", report.rays.names(kind.sent)},
                            {"givesPlaceTo", report.rays.names(kind.sentLast)}});
  for (const FunctionReport &function : report.functions)
    json["functions"].push_back(jsonOf(function));
  return json;
}

std::string toJson(const SplitReport &report) {
  return jsonOf(report).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace rtsl
