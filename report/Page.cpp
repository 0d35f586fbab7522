//===- Page.cpp - a study as an HTML page ---------------------------------===//
#include "report/Page.h"

#include "report/LogPlot.h"
#include "report/measures/ErrorMap.h"
#include "report/measures/Exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace rtsl::report {

namespace {

constexpr const char *style =
    R"(:root { color-scheme: light dark; --paper: #ffffff; --ink: #1c2126; --muted: #68707a; --grid: #e4e7eb; --card: #f6f7f9; --warn: #8a4b00; }
@media (prefers-color-scheme: dark) { :root { --paper: #16191d; --ink: #e6e9ec; --muted: #9aa3ad; --grid: #2b3138; --card: #1e2227; --warn: #f0b060; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1360px; padding: 24px clamp(12px, 3vw, 40px) 64px; background: var(--paper); color: var(--ink);
       font: 15px/1.5 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { font-size: 26px; line-height: 1.2; margin: 0 0 4px; overflow-wrap: anywhere; }
h2 { font-size: 19px; margin: 36px 0 10px; }
p, li { max-width: 78ch; }
.muted { color: var(--muted); }
.problems { background: var(--card); border-left: 4px solid var(--warn); padding: 8px 16px; margin: 16px 0; }
.problems h2 { margin: 4px 0; font-size: 16px; color: var(--warn); }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 460px), 1fr)); gap: 20px; }
.plots svg { max-width: 680px; }
.legend label { cursor: pointer; display: inline-block; padding: 4px 0; }
.legend { display: flex; flex-wrap: wrap; gap: 4px 20px; padding: 0; margin: 8px 0 14px; list-style: none; }
.legend li { white-space: nowrap; }
.table { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; font-size: 13px; }
th, td { text-align: right; padding: 5px 7px; border-bottom: 1px solid var(--grid); white-space: nowrap; }
th { color: var(--muted); font-weight: 600; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 250px), 1fr)); gap: 18px; }
figure { margin: 0; }
img { width: 100%; height: auto; display: block; border-radius: 4px; image-rendering: auto; }
figcaption { font-size: 13px; color: var(--muted); margin-top: 4px; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 18px; margin: 0; }
dt { color: var(--muted); } dd { margin: 0; overflow-wrap: anywhere; }
code { background: var(--card); padding: 1px 5px; border-radius: 3px; overflow-wrap: anywhere; }
summary { cursor: pointer; margin: 24px 0 8px; font-weight: 600; }
)";

/// Three significant digits, and words for infinities and NaN.
std::string figure(double value) {
  if (std::isnan(value))
    return "–";
  if (std::isinf(value))
    return "∞";
  return fmt::format("{:.3g}", value);
}

std::string seconds(double value) {
  if (!std::isfinite(value))
    return figure(value);
  return value < 0.1 ? fmt::format("{:.3g} ms", value * 1e3) : fmt::format("{:.3g} s", value);
}

std::string interval(const Estimate &estimate, const char *format = "{:.3f}") {
  const auto text = [&](double value) { return fmt::format(fmt::runtime(format), value); };
  return fmt::format("{} <span class=\"muted\">[{}, {}]</span>", text(estimate.value),
                     text(estimate.low), text(estimate.high));
}

/// A slope, and that of the end of a line if it bends.
std::string slope(const LineFit &line, const std::optional<Estimate> &last) {
  if (line.points == 0)
    return "–";
  return interval(line.slope) + (line.bends() ? "; bends" : "") +
         (last ? ", last " + interval(*last) : "");
}

std::string timeTo(const TimeToError &time) {
  return fmt::format("{}{} <span class=\"muted\">[{}, {}]</span>", time.isBound ? "at most " : "",
                     seconds(time.seconds.value), seconds(time.seconds.low),
                     seconds(time.seconds.high));
}

std::string row(const std::vector<std::string> &cells, const char *tag = "td") {
  std::string html = "<tr>";
  for (const std::string &cell : cells)
    html += fmt::format("<{}>{}</{}>", tag, cell, tag);
  return html + "</tr>\n";
}

std::string table(const std::vector<std::string> &header, const std::string &rows) {
  return fmt::format(
      "<div class=\"table\" tabindex=\"0\" role=\"region\" "
      "aria-label=\"table\"><table><thead>{}</thead><tbody>\n{}</tbody></table></div>\n",
      row(header, "th"), rows);
}

std::string definitions(const std::vector<std::pair<std::string, std::string>> &facts) {
  std::string html = "<dl>";
  for (const auto &[name, value] : facts)
    html += fmt::format("<dt>{}</dt><dd>{}</dd>", escapeHtml(name), escapeHtml(value));
  return html + "</dl>\n";
}

//===-- text ------------------------------------------------------===//

std::string verdict(const Estimate &slope) {
  return slope.high < -1 ? "steeper than the -1 of independent samples, as it is where samples are "
                           "spread evenly over a pixel"
         : slope.low > -1 ? "<b>flatter</b> than the -1 of independent samples: some of the error "
                            "does not fall with the samples"
                          : "as the -1 of independent samples";
}

std::vector<std::string> findings(const Summary &summary) {
  std::vector<std::string> sentences;
  std::vector<const SubjectSummary *> timed;
  for (const SubjectSummary &subject : summary.subjects)
    if (subject.toCommonRelMse)
      timed.push_back(&subject);
  if (!timed.empty()) {
    const auto sooner = [](const SubjectSummary *a, const SubjectSummary *b) {
      return a->toCommonRelMse->seconds.value < b->toCommonRelMse->seconds.value;
    };
    const SubjectSummary *fastest = *std::min_element(timed.begin(), timed.end(), sooner);
    const SubjectSummary *slowest = *std::max_element(timed.begin(), timed.end(), sooner);
    sentences.push_back(fmt::format("<b>{}</b> reaches a relMSE of {} first, in {} per picture.",
                                    escapeHtml(fastest->name), figure(summary.commonRelMse),
                                    timeTo(*fastest->toCommonRelMse)));
    if (fastest != slowest && slowest->timesTheQuickest)
      sentences.push_back(fmt::format("<b>{}</b> takes longest: {} times as long.",
                                      escapeHtml(slowest->name),
                                      interval(*slowest->timesTheQuickest, "{:.2f}")));
    const LineFit &line = fastest->relMseOverSamples;
    sentences.push_back(fmt::format("Its relMSE falls with the samples to the power of {}: {}.",
                                    slope(line, fastest->lastSlopeOverSamples),
                                    verdict(fastest->lastSlopeOverSamples.value_or(line.slope))));
  }
  std::map<std::uint64_t, std::vector<std::string>> byPicture;
  for (const SubjectSummary &subject : summary.subjects)
    if (!subject.levels.empty())
      byPicture[subject.commonPicture].push_back(subject.name);
  for (const auto &[picture, names] : byPicture)
    if (names.size() > 1) {
      std::string list;
      for (std::size_t i = 0; i < names.size(); ++i)
        list += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + escapeHtml(names[i]);
      sentences.push_back(fmt::format("The same picture, bit for bit: {}.", list));
    }
  return sentences;
}

//===-- plots -------------------------------------------------------------===//

/// "0.0012 [0.0011, 0.0013]".
std::string withInterval(const Estimate &estimate) {
  return figure(estimate.value) +
         (std::isfinite(estimate.low)
              ? fmt::format(" [{}, {}]", figure(estimate.low), figure(estimate.high))
              : "");
}

PlotPoint pointOf(const SubjectSummary &subject, const LevelSummary &level, double x,
                  const Estimate &y, const std::string &what) {
  return {x, y, fmt::format("{}, {} spp", subject.name, level.samplesPerPixel),
          what + " in " + seconds(level.seconds.value)};
}

std::string drawError(const Summary &summary, const std::string &title, const std::string &unit,
                      Estimate LevelSummary::*error, bool hasLines, double ownError) {
  LogPlot plot;
  plot.title = title;
  plot.xLabel = "seconds of rendering for one picture";
  plot.yLabel = unit;
  plot.mark = ownError;
  plot.markText = "the reference's own error";
  for (std::size_t i = 0; i < summary.subjects.size(); ++i) {
    const SubjectSummary &subject = summary.subjects[i];
    PlotSeries series{subject.name, unsigned(i), {}, {}};
    for (const LevelSummary &level : subject.levels)
      series.points.push_back(
          pointOf(subject, level, level.seconds.value, level.*error, withInterval(level.*error)));
    if (hasLines)
      series.line = subject.relMseOverSeconds;
    plot.series.push_back(std::move(series));
  }
  return drawLogPlot(plot);
}

/// Curves that coincide in the other plots are separate here.
std::string drawRatios(const Summary &summary) {
  LogPlot plot;
  const std::string first = summary.subjects.front().name;
  plot.title = "Time to the same relMSE, relative to the first";
  plot.xLabel = "relMSE";
  plot.yLabel = "times " + first;
  plot.mark = 1;
  plot.leastDecades = 0.05;
  plot.nothing = "no error was reached by two configurations";
  for (std::size_t i = 1; i < summary.subjects.size(); ++i) {
    const SubjectSummary &subject = summary.subjects[i];
    PlotSeries series{subject.name, unsigned(i), {}, {}};
    for (const LevelSummary &level : subject.levels)
      if (level.timesTheFirst)
        series.points.push_back(
            pointOf(subject, level, level.relMse.value, *level.timesTheFirst,
                    fmt::format("relMSE {}, {} times", figure(level.relMse.value),
                                withInterval(*level.timesTheFirst))));
    plot.series.push_back(std::move(series));
  }
  return drawLogPlot(plot);
}

std::string legend(const Summary &summary) {
  std::string html = "<ul class=\"legend\">";
  for (std::size_t i = 0; i < summary.subjects.size(); ++i)
    html += fmt::format("<li><label><input type=\"checkbox\" id=\"{}\" checked> {} {}</label></li>",
                        curveSwitch(unsigned(i)), drawLegendKey(unsigned(i)),
                        escapeHtml(summary.subjects[i].name));
  return html + "</ul>\n";
}

std::string plots(const Summary &summary, const Reference &reference) {
  std::string html = legend(summary) + "<div class=\"plots\">\n";
  const double ownRelMse = reference.ownError ? reference.ownError->relMse : 0,
               ownRmse = reference.ownError ? reference.ownError->rmse : 0;
  html += drawError(summary, "relMSE, with fitted lines and 95 % bands", "relMSE",
                    &LevelSummary::relMse, true, ownRelMse) +
          "\n";
  if (summary.subjects.size() > 1)
    html += drawRatios(summary) + "\n";
  html +=
      drawError(summary, "Root mean square error", "RMSE", &LevelSummary::rmse, false, ownRmse) +
      "\n";
  html +=
      drawError(summary, "FLIP, as seen on a screen", "mean FLIP", &LevelSummary::flip, false, 0) +
      "\n";
  html += drawError(summary, "HDR-FLIP, over all exposures", "mean HDR-FLIP",
                    &LevelSummary::flipHdr, false, 0) +
          "\n";
  return html +
         "</div>\n<p class=\"muted\">Points are medians of the runs, bars their 95 % intervals; "
         "the check boxes show and hide curves. The ratio compares times of the same "
         "round, so that a machine that is busy for a while disturbs it little.</p>\n";
}

//===-- tables ------------------------------------------------------------===//

std::string configurations(const Summary &summary) {
  std::string rows;
  for (const SubjectSummary &subject : summary.subjects) {
    const double lastSeconds = subject.levels.empty() ? 0 : subject.levels.back().seconds.value;
    rows += row({escapeHtml(subject.name), seconds(subject.compileSeconds),
                 seconds(subject.buildSeconds.value),
                 subject.levels.empty()
                     ? "–"
                     : fmt::format("{} <span class=\"muted\">at {} spp</span>",
                                   seconds(lastSeconds), subject.levels.back().samplesPerPixel),
                 slope(subject.relMseOverSeconds, subject.lastSlopeOverSeconds),
                 slope(subject.relMseOverSamples, subject.lastSlopeOverSamples),
                 subject.toCommonRelMse ? timeTo(*subject.toCommonRelMse) : "–",
                 subject.timesTheQuickest ? interval(*subject.timesTheQuickest, "{:.2f}") : "–",
                 subject.efficiency > 0 ? figure(subject.efficiency) : "–",
                 fmt::format("{} / {} / {}", subject.nanPixels, subject.infinitePixels,
                             subject.samplesNotFinite)});
  }
  return table({"configuration", "compile", "build", "trace", "slope over seconds",
                "slope over samples",
                fmt::format("time to relMSE {}", figure(summary.commonRelMse)),
                "times the quickest", "efficiency<br>1/(variance·s)", "NaN / Inf<br>/ samples"},
               rows);
}

std::string levels(const Summary &summary) {
  std::string rows;
  for (const SubjectSummary &subject : summary.subjects)
    for (const LevelSummary &level : subject.levels)
      rows += row({escapeHtml(subject.name), fmt::format("{}", level.samplesPerPixel),
                   fmt::format("{}", level.runs), seconds(level.seconds.value),
                   figure(level.rmse.value),
                   figure(level.relMse.value) + (level.isResolved ? "" : " *"),
                   figure(level.flip.value), figure(level.flipHdr.value), figure(level.variance),
                   level.variance > 0 ? figure(level.efficiency) : "–",
                   level.timesTheFirst ? interval(*level.timesTheFirst, "{:.3f}") : "–"});
  return table({"configuration", "spp", "runs", "seconds", "RMSE", "relMSE", "FLIP", "HDR-FLIP",
                "variance", "efficiency", "times the first"},
               rows);
}

} // namespace

std::string writePage(const Context &context, const Summary &summary, const Reference &reference,
                      const std::vector<Exhibit> &exhibits) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
                     "name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += fmt::format(
      "<title>Error against run time: {}</title>\n<style>\n{}{}</style>\n</head>\n<body>\n",
      escapeHtml(context.scene), style, plotStyle());
  html +=
      fmt::format("<h1>Error against run time</h1>\n<p class=\"muted\"><code>{}</code>, {}x{} "
                  "pixels, {} independent runs with each number of samples, {} of rendering for "
                  "each configuration.</p>\n",
                  escapeHtml(context.scene), context.width, context.height, context.runs,
                  seconds(context.budgetSeconds));
  if (!summary.problems.empty()) {
    html += "<div class=\"problems\"><h2>Before you trust a figure</h2><ul>\n";
    for (const std::string &problem : summary.problems)
      html += fmt::format("<li>{}</li>\n", escapeHtml(problem));
    html += "</ul></div>\n";
  }
  if (const std::vector<std::string> sentences = findings(summary); !sentences.empty()) {
    html += "<ul>\n";
    for (const std::string &sentence : sentences)
      html += fmt::format("<li>{}</li>\n", sentence);
    html += "</ul>\n";
  }
  html += fmt::format("<p>The reference is {}.</p>\n", escapeHtml(reference.origin));
  html += "<h2>Error against seconds</h2>\n" + plots(summary, reference);
  html += "<h2>Configurations</h2>\n" + configurations(summary);
  html +=
      "<p class=\"muted\">Slopes are of log relMSE, less that of the reference, with 95 % "
      "confidence "
      "intervals: they are computed from the differences between rounds of runs, because the "
      "runs of a round share disturbances of the machine. Where a line bends (a test of lack of "
      "fit, at 1 %) the slope of its end is given too. The time to an error is read off the "
      "points on both sides of it. Compile, build and trace are apart: compiling the shaders, "
      "building acceleration structures, tracing one picture.</p>\n";
  if (!exhibits.empty()) {
    html += "<h2>Pictures</h2>\n<div class=\"pictures\">\n";
    for (const Exhibit &exhibit : exhibits)
      html += fmt::format("<figure><img alt=\"{}\" src=\"{}\" width=\"{}\" "
                          "height=\"{}\"><figcaption>{}</figcaption></figure>\n",
                          escapeHtml(exhibit.caption), dataUrl(exhibit.rgb), exhibit.rgb.width,
                          exhibit.rgb.height, escapeHtml(exhibit.caption));
    html += "</div>\n";
  }
  html += "<details><summary>All numbers of samples</summary>\n" + levels(summary) +
          "<p class=\"muted\">* the reference's own error is more than a tenth of this one; the "
          "fitted line leaves it out.</p></details>\n";
  html += "<h2>How it was made</h2>\n" + definitions(context.versions) + "<br>" +
          definitions(context.machine);
  html += fmt::format("<p>Again: <code>{}</code></p>\n", escapeHtml(context.command));
  html += "<p class=\"muted\">RMSE: root mean square difference. relMSE: mean of (difference)² / "
          "(reference² + 0.01). FLIP: Andersson et al. 2020; HDR-FLIP: Andersson et al. 2021; 67 "
          "pixels a degree. Variance: of a picture over the runs, mean over pixels and "
          "channels.</p>\n</body>\n</html>\n";
  return html;
}

} // namespace rtsl::report
