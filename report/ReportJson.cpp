//===- ReportJson.cpp - a study for scripts -------------------------------===//
#include "report/Page.h"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

namespace rtsl::report {

namespace {

using Json = nlohmann::ordered_json;

Json toJson(const Estimate &estimate) {
  return {{"value", estimate.value}, {"low", estimate.low}, {"high", estimate.high}};
}

Json toJson(const std::vector<std::pair<std::string, std::string>> &facts) {
  Json object = Json::object();
  for (const auto &[name, value] : facts)
    object[name] = value;
  return object;
}

Json toJson(const std::optional<Estimate> &estimate) {
  return estimate ? toJson(*estimate) : Json(nullptr);
}

Json toJson(const LineFit &fit, const std::optional<Estimate> &lastSlope) {
  if (fit.points == 0)
    return nullptr;
  return {{"points", fit.points},       {"rounds", fit.rounds},
          {"slope", toJson(fit.slope)}, {"intercept", fit.intercept},
          {"lackOfFit", fit.lackOfFit}, {"largestResidual", fit.largestResidual},
          {"bends", fit.bends()},       {"lastSlope", toJson(lastSlope)}};
}

Json toJson(const LevelSummary &level) {
  return {{"spp", level.samplesPerPixel},
          {"runs", level.runs},
          {"seconds", toJson(level.seconds)},
          {"rmse", toJson(level.rmse)},
          {"relMse", toJson(level.relMse)},
          {"flip", toJson(level.flip)},
          {"flipHdr", toJson(level.flipHdr)},
          {"variance", level.variance},
          {"efficiency", level.efficiency},
          {"resolved", level.isResolved},
          {"timesTheFirst", toJson(level.timesTheFirst)}};
}

Json toJson(const std::optional<TimeToError> &time) {
  if (!time)
    return nullptr;
  Json json = toJson(time->seconds);
  json["isBound"] = time->isBound;
  return json;
}

Json toJson(const SubjectSummary &subject) {
  Json levels = Json::array();
  for (const LevelSummary &level : subject.levels)
    levels.push_back(toJson(level));
  return {{"name", subject.name},
          {"settings", toJson(subject.settings)},
          {"seconds",
           {{"compile", subject.compileSeconds},
            {"build", toJson(subject.buildSeconds)},
            {"toCommonRelMse", toJson(subject.toCommonRelMse)}}},
          {"timesTheQuickest", toJson(subject.timesTheQuickest)},
          {"efficiency", subject.efficiency},
          {"relMseOverSeconds", toJson(subject.relMseOverSeconds, subject.lastSlopeOverSeconds)},
          {"relMseOverSamples", toJson(subject.relMseOverSamples, subject.lastSlopeOverSamples)},
          {"nanPixels", subject.nanPixels},
          {"infinitePixels", subject.infinitePixels},
          {"samplesNotFinite", subject.samplesNotFinite},
          {"raysTooDeep", subject.raysTooDeep},
          {"commonPicture", fmt::format("{:016x}", subject.commonPicture)},
          {"levels", std::move(levels)}};
}

} // namespace

std::string writeJson(const Context &context, const Summary &summary, const Reference &reference) {
  Json document = {{"version", 2},
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
                                         {"spp", reference.ownError->samplesPerPixel},
                                         {"heavyTails", reference.ownError->tail.isHeavy()},
                                         {"maximumShare", reference.ownError->tail.maximumShare},
                                         {"tailIndex", reference.ownError->tail.tailIndex}};
  document["heavyTails"] = summary.heavyTails.empty() ? Json(nullptr) : Json(summary.heavyTails);
  document["problems"] = summary.problems;
  document["commonRelMse"] = summary.commonRelMse;
  document["configurations"] = Json::array();
  for (const SubjectSummary &subject : summary.subjects)
    document["configurations"].push_back(toJson(subject));
  return document.dump(2) + "\n";
}

} // namespace rtsl::report
