//===- ReportJson.cpp - a study for scripts -------------------------------===//
#include "report/Page.h"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace rtsl::report {

namespace {

using Json = nlohmann::ordered_json;

Json toJson(const Estimate &estimate) { return {{"value", estimate.value}, {"low", estimate.low}, {"high", estimate.high}}; }

Json toJson(const std::vector<std::pair<std::string, std::string>> &facts) {
  Json object = Json::object();
  for (const auto &[name, value] : facts)
    object[name] = value;
  return object;
}

Json toJson(const LineFit &fit) {
  if (fit.points == 0)
    return nullptr;
  return {{"points", fit.points}, {"slope", toJson(fit.slope)}, {"intercept", fit.intercept}, {"deviation", fit.deviation}};
}

Json toJson(const LevelSummary &level) {
  return {{"spp", level.samplesPerPixel},       {"runs", level.runs},
          {"seconds", toJson(level.seconds)},   {"rmse", toJson(level.rmse)},
          {"relMse", toJson(level.relMse)},     {"flip", toJson(level.flip)},
          {"flipHdr", toJson(level.flipHdr)},   {"variance", level.variance},
          {"efficiency", level.efficiency},     {"resolved", level.isResolved}};
}

Json toJson(const SubjectSummary &subject, double commonRelMse) {
  Json levels = Json::array();
  for (const LevelSummary &level : subject.levels)
    levels.push_back(toJson(level));
  return {{"name", subject.name},
          {"settings", toJson(subject.settings)},
          {"seconds", {{"compile", subject.compileSeconds}, {"build", toJson(subject.buildSeconds)}, {"toCommonRelMse", subject.secondsTo(commonRelMse)}}},
          {"efficiency", subject.efficiency},
          {"relMseOverSeconds", toJson(subject.relMseOverSeconds)},
          {"relMseOverSamples", toJson(subject.relMseOverSamples)},
          {"nanPixels", subject.nanPixels},
          {"infinitePixels", subject.infinitePixels},
          {"samplesNotFinite", subject.samplesNotFinite},
          {"commonPicture", fmt::format("{:016x}", subject.commonPicture)},
          {"levels", std::move(levels)}};
}

} // namespace

std::string writeJson(const Context &context, const Summary &summary, const Reference &reference) {
  Json document = {{"version", 1},
                   {"scene", context.scene},
                   {"size", {context.width, context.height}},
                   {"runs", context.runs},
                   {"budgetSeconds", context.budgetSeconds},
                   {"command", context.command},
                   {"versions", toJson(context.versions)},
                   {"machine", toJson(context.machine)}};
  document["reference"] = {{"origin", reference.origin}};
  if (reference.ownError)
    document["reference"]["ownError"] = {{"rmse", reference.ownError->rmse},
                                         {"relMse", reference.ownError->relMse},
                                         {"rounding", reference.ownError->rounding},
                                         {"runs", reference.ownError->runs},
                                         {"spp", reference.ownError->samplesPerPixel}};
  document["problems"] = summary.problems;
  document["commonRelMse"] = summary.commonRelMse;
  document["configurations"] = Json::array();
  for (const SubjectSummary &subject : summary.subjects)
    document["configurations"].push_back(toJson(subject, summary.commonRelMse));
  return document.dump(2) + "\n";
}

} // namespace rtsl::report
