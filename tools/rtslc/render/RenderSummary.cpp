#include "RenderSummary.h"

#include "codegen/driver/machine/CodeCache.h"
#include "tools/common/Interruption.h"
#include "tools/common/Outcome.h"
#include "tools/common/Output.h"
#include "tools/rtslc/render/RenderTarget.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace rtsl::tool {

namespace {

/// What samples met, by RTSL_EXCEPTION_*.
constexpr const char *exceptionNames[RTSL_EXCEPTIONS] = {"", "stackOverflow", "badRay", "index"};

nlohmann::ordered_json toJson(const SampleNotFinite &one) {
  // JSON has no numbers that are not finite
  nlohmann::ordered_json color = nlohmann::ordered_json::array();
  for (const float value : one.color)
    color.push_back(std::isfinite(value) ? nlohmann::ordered_json(value)
                    : std::isnan(value)  ? nlohmann::ordered_json("nan")
                                         : nlohmann::ordered_json(value > 0 ? "inf" : "-inf"));
  nlohmann::ordered_json document = {{"pixel", {one.sample.x, one.sample.y}},
                                     {"sample", one.sample.sample % RTSL_SECOND_HALF},
                                     {"color", color}};
  if (one.sample.sample >= RTSL_SECOND_HALF)
    document["half"] = 2;
  if (one.place)
    document["place"] = {
        {"file", one.place->file}, {"line", one.place->line}, {"column", one.place->column}};
  return document;
}

/// The mean number of samples of a pixel, which are not the same for all if they are adaptive.
double samplesOfPixel(const PictureSummary &summary) {
  return double(summary.statistics.samples) / double(windowOf(summary.render).pixels());
}

/// The name of a step, by its place in RenderStatistics::steps.
std::string nameOfStep(const PictureSummary &summary, std::size_t place) {
  return place == 0 ? "traversal" : place == 1 ? "begin samples" : summary.stateNames.at(place - 2);
}

double perRay(const RtslTreeVisits &visits, std::uint64_t count) {
  return double(count) / double(visits.rays);
}

std::string toJson(const RenderCommandOptions &options, const PictureSummary &summary) {
  const runtime::RenderOptions &render = summary.render;
  const runtime::RenderStatistics &statistics = summary.statistics;
  nlohmann::ordered_json document = {{"version", 1},
                                     {"output", options.output},
                                     {"size", {render.width, render.height}},
                                     {"spp", render.samplesPerPixel},
                                     {"seed", render.seed},
                                     {"seconds",
                                      {{"compile", summary.times.compile},
                                       {"scene", summary.times.scene},
                                       {"build", statistics.buildSeconds},
                                       {"render", statistics.renderSeconds},
                                       {"image", summary.times.image}}},
                                     {"processorSeconds", statistics.processorSeconds},
                                     {"samples", statistics.samples},
                                     {"pixels", statistics.pixels},
                                     {"badRays", statistics.badRays},
                                     {"retracedRays", statistics.retracedRays},
                                     {"rescaledRays", statistics.rescaledRays},
                                     {"raysTooDeep", statistics.raysTooDeep},
                                     {"samplesNotFinite", statistics.samplesNotFinite},
                                     {"pixelsWithoutSample", statistics.pixelsWithoutSample},
                                     {"notFinite", nlohmann::ordered_json::array()}};
  for (const SampleNotFinite &one : summary.notFinite)
    document["notFinite"].push_back(toJson(one));
  if (const auto &cache = options.common.compile.codeCache; cache && cache->read())
    document["modulesOfEarlierRuns"] = cache->read(); // whose machine code was in files
  if (std::isfinite(summary.error))
    document["noise"] = summary.error;
  if (render.isAdaptive)
    document["adaptive"] = {{"mean", samplesOfPixel(summary)},
                            {"openPixels", statistics.openPixels}};
  if (summary.resumedAt)
    document["resumedAt"] = summary.resumedAt;
  if (statistics.isUnfinished || (options.isOpenEnded() && interruption()))
    document["stoppedBy"] = interruption();
  if (options.prints)
    document["printed"] = summary.printed;
  for (std::uint32_t i = 1; i < RTSL_EXCEPTIONS; ++i)
    if (statistics.exceptions[i])
      document["exceptions"][exceptionNames[i]] = statistics.exceptions[i];
  if (statistics.tree)
    document["tree"] = tool::toJson(*statistics.tree);
  if (const RtslTreeVisits &visits = statistics.visits; visits.rays > 0) {
    document["tree"]["rays"] = visits.rays;
    document["tree"]["nodesPerRay"] = perRay(visits, visits.nodes);
    document["tree"]["itemsPerRay"] = perRay(visits, visits.items);
  }
  for (std::size_t i = 0; i < statistics.steps.size(); ++i)
    document["steps"].push_back({{"step", nameOfStep(summary, i)},
                                 {"steps", statistics.steps[i].steps},
                                 {"lanes", statistics.steps[i].lanes}});
  if (!summary.gpus.empty())
    (document["gpu"] = tool::toJson(summary.gpus.front()))["kernelSeconds"] =
        statistics.kernelSeconds;
  if (summary.gpus.size() > 1)
    for (const runtime::GpuStatistics &gpu : summary.gpus)
      document["gpus"].push_back(tool::toJson(gpu));
  return document.dump(2) + "\n";
}

/// Empty if they were not counted.
std::string visitsText(const RtslTreeVisits &visits) {
  return visits.rays == 0
             ? ""
             : fmt::format("{} rays in the tree: {:.1f} nodes and {:.1f} items each\n", visits.rays,
                           perRay(visits, visits.nodes), perRay(visits, visits.items));
}

/// A line for each step that was taken, the most frequent first; empty if they were not counted.
std::string stepsText(const PictureSummary &summary) {
  std::vector<std::pair<RtslStepCount, std::string>> taken;
  RtslStepCount all{};
  for (std::size_t i = 0; i < summary.statistics.steps.size(); ++i) {
    const RtslStepCount count = summary.statistics.steps[i];
    all.steps += count.steps;
    all.lanes += count.lanes;
    if (count.steps > 0)
      taken.emplace_back(count, nameOfStep(summary, i));
  }
  if (taken.empty())
    return {};
  std::stable_sort(taken.begin(), taken.end(),
                   [](const auto &a, const auto &b) { return a.first.steps > b.first.steps; });
  const auto line = [](const RtslStepCount &count, const std::string &name) {
    return fmt::format("{:>14} {:>7.2f}  {}\n", count.steps,
                       double(count.lanes) / double(count.steps), name);
  };
  std::string text = "steps of warps   lanes\n" + line(all, "all");
  for (const auto &[count, name] : taken)
    text += line(count, name);
  return text;
}

} // namespace

void printSummary(const RenderCommandOptions &options, const PictureSummary &summary) {
  const runtime::RenderOptions &render = summary.render;
  const runtime::RenderStatistics &statistics = summary.statistics;
  if (options.json)
    return printOut(toJson(options, summary));
  if (options.quiet || options.common.jsonDiagnostics) // there standard error is one JSON document
    return;
  const std::string adaptive =
      render.isAdaptive ? fmt::format(" at most, {:.1f} on average", samplesOfPixel(summary)) : "";
  fmt::print(stderr,
             "{}: {}x{}, {} spp{}; compiled in {:.0f} ms, rendered in {:.2f} s ({:.2f} million "
             "samples/s)\n",
             options.output == "-" ? "standard output" : options.output, render.width,
             render.height, render.samplesPerPixel, adaptive, summary.times.compile * 1e3,
             statistics.renderSeconds,
             double(statistics.samples) / statistics.renderSeconds * 1e-6);
  if (const auto &cache = options.common.compile.codeCache; cache && cache->reused())
    fmt::print(stderr, "machine code of the picture before: {} module{}\n", cache->reused(),
               cache->reused() == 1 ? "" : "s");
  if (statistics.isRefitted)
    fmt::print(stderr, "trees of the picture before: refitted\n");
  if (summary.resumedAt)
    fmt::print(stderr, "resumed at {} spp\n", summary.resumedAt);
  if (std::isfinite(summary.error))
    fmt::print(stderr, "noise: {:.4g}\n", summary.error);
  for (const runtime::GpuStatistics &gpu : summary.gpus)
    fmt::print(stderr, "{}\n", gpuText(gpu));
  if (statistics.tree)
    fmt::print(stderr, "{}\n", treeText(*statistics.tree));
  fmt::print(stderr, "{}{}", visitsText(statistics.visits), stepsText(summary));
  for (const std::string &text : exceptionTexts(statistics, render))
    fmt::print(stderr, "{}\n", text);
  if (const std::string text = tool::badRaysText(statistics); !text.empty())
    fmt::print(stderr, "{}\n", text);
}

void warn(const PictureSummary &summary, Messages &messages) {
  const runtime::RenderStatistics &statistics = summary.statistics;
  if (!summary.unfinished.empty())
    messages.diagnostics.reportText(Code::unfinishedPicture, {}, summary.unfinished);
  if (statistics.samplesNotFinite) {
    SourceRange range;
    for (const SampleNotFinite &one : summary.notFinite)
      if (one.place && !range.isValid())
        range = messages.rangeOf(*one.place);
    Diagnostic &diagnostic =
        messages.diagnostics.reportText(Code::samplesNotFinite, range, notFiniteText(statistics));
    for (const SampleNotFinite &one : summary.notFinite) {
      const auto isNan = [](float value) { return std::isnan(value); };
      const char *const what = one.color.empty() ? "not finite"
                               : std::any_of(one.color.begin(), one.color.end(), isNan)
                                   ? "not a number"
                                   : "infinite";
      const std::string place = one.place ? fmt::format("since {}:{}:{}", one.place->file,
                                                        one.place->line, one.place->column)
                                          : "and the source line was not found";
      diagnostic.note(fmt::format("{} is {}, {}", sampleText(one.sample), what, place));
    }
    if (statistics.samplesNotFinite > summary.notFinite.size())
      diagnostic.note(fmt::format("and {} more samples",
                                  statistics.samplesNotFinite - summary.notFinite.size()));
  }
  if (statistics.raysTooDeep && !statistics.exceptions[RTSL_EXCEPTION_STACK_OVERFLOW])
    messages.diagnostics.reportText(Code::raysTooDeep, {}, tooDeepText(statistics, summary.render));
}

} // namespace rtsl::tool
