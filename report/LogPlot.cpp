//===- LogPlot.cpp --------------------------------------------------------===//
#include "report/LogPlot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::report {

namespace {

constexpr double width = 640, height = 420;
constexpr double left = 70, right = 16, top = 34, bottom = 52; // margins
constexpr unsigned styles = 8;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool isEmpty() const { return !(low <= high); }
  /// A little air on both sides, and at least half a decade.
  void widen() {
    const double air = std::max(0.06 * (high - low), (0.5 - (high - low)) / 2);
    low -= air;
    high += air;
  }
};

/// Values to places on the paper; ranges are of log10.
struct Axes {
  Range x, y;
  double toX(double logarithm) const { return left + (width - left - right) * (logarithm - x.low) / (x.high - x.low); }
  double toY(double logarithm) const { return height - bottom - (height - top - bottom) * (logarithm - y.low) / (y.high - y.low); }
};

bool isDrawable(const PlotPoint &point) {
  return point.x > 0 && point.y.value > 0 && std::isfinite(point.x) && std::isfinite(point.y.value);
}

/// The lower end of an interval may reach 0, which is nowhere on the axis.
double lowEnd(const Estimate &estimate) { return estimate.low > 0 ? estimate.low : estimate.value; }

Axes findAxes(const LogPlot &plot) {
  Axes axes;
  for (const PlotSeries &series : plot.series)
    for (const PlotPoint &point : series.points)
      if (isDrawable(point)) {
        axes.x.add(std::log10(point.x));
        axes.y.add(std::log10(lowEnd(point.y)));
        axes.y.add(std::log10(std::max(point.y.high, point.y.value)));
      }
  if (axes.x.isEmpty())
    return axes;
  if (plot.floor > 0 && std::isfinite(plot.floor))
    axes.y.add(std::log10(plot.floor));
  axes.x.widen();
  axes.y.widen();
  return axes;
}

/// 1000 is 1000, 1e-5 is 10 with a raised -5.
std::string tickText(int decade) {
  if (decade >= -3 && decade <= 4)
    return fmt::format("{:g}", std::pow(10.0, decade));
  return fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{}</tspan>", decade);
}

/// Which multiples of a decade have a grid line: the more decades there are, the fewer.
std::vector<int> gridFactors(const Range &range) {
  const double decades = range.high - range.low;
  if (decades > 2.5)
    return {1};
  if (decades > 0.9)
    return {1, 2, 5};
  return {1, 2, 3, 4, 5, 6, 7, 8, 9};
}

std::string drawGrid(const Axes &axes) {
  std::string svg;
  const auto ticks = [&](const Range &range, auto drawTick) {
    for (int decade = int(std::floor(range.low)); decade <= int(std::ceil(range.high)); ++decade)
      for (int factor : gridFactors(range)) {
        const double place = decade + std::log10(double(factor));
        if (place < range.low || place > range.high)
          continue;
        drawTick(place, factor == 1 ? tickText(decade) : decade >= -3 && decade <= 4 ? fmt::format("{:g}", factor * std::pow(10.0, decade)) : "",
                 factor == 1);
      }
  };
  ticks(axes.x, [&](double place, const std::string &text, bool isDecade) {
    const double x = axes.toX(place);
    svg += fmt::format("<line class=\"grid{}\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{}\" y2=\"{}\"/>", isDecade ? "" : " fine", x, x, top, height - bottom);
    svg += fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>", x, height - bottom + 18, text);
  });
  ticks(axes.y, [&](double place, const std::string &text, bool isDecade) {
    const double y = axes.toY(place);
    svg += fmt::format("<line class=\"grid{}\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", isDecade ? "" : " fine", left, width - right, y, y);
    svg += fmt::format("<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", left - 8, y + 4, text);
  });
  return svg;
}

std::string drawMarker(unsigned style, double x, double y, const std::string &text) {
  const double r = 4;
  const std::string title = text.empty() ? "" : fmt::format("<title>{}</title>", escapeHtml(text));
  switch (style % styles / 2) {
  case 0: return fmt::format("<circle class=\"marker\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\">{}</circle>", x, y, r, title);
  case 1: return fmt::format("<rect class=\"marker\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\">{}</rect>", x - r, y - r, 2 * r, 2 * r, title);
  case 2:
    return fmt::format("<path class=\"marker\" d=\"M{:.1f} {:.1f}l{} {}l{} {}l{} {}z\">{}</path>", x, y - 1.3 * r, 1.3 * r, 1.3 * r, -1.3 * r, 1.3 * r,
                       -1.3 * r, -1.3 * r, title);
  default:
    return fmt::format("<path class=\"marker\" d=\"M{:.1f} {:.1f}l{} {}h{}z\">{}</path>", x, y - 1.2 * r, 1.2 * r, 2.1 * r, -2.4 * r, title);
  }
}

/// The fitted line over the range of its points, with its band.
std::string drawLine(const PlotSeries &series, const Axes &axes) {
  Range range;
  for (const PlotPoint &point : series.points)
    if (isDrawable(point))
      range.add(std::log10(point.x));
  if (series.line.points == 0 || range.isEmpty())
    return {};
  constexpr int steps = 24;
  std::string upper, lower;
  for (int i = 0; i <= steps; ++i) {
    const double x = range.low + (range.high - range.low) * i / steps;
    const Estimate y = series.line.at(x);
    const auto inside = [&](double value) { return std::clamp(axes.toY(value), top, height - bottom); };
    upper += fmt::format("{}{:.1f} {:.1f}", i ? "L" : "M", axes.toX(x), inside(y.high));
    lower = fmt::format("L{:.1f} {:.1f}", axes.toX(x), inside(y.low)) + lower;
  }
  return fmt::format("<path class=\"band\" d=\"{}{}z\"/><line class=\"fit\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", upper, lower,
                     axes.toX(range.low), axes.toY(series.line.at(range.low).value), axes.toX(range.high),
                     axes.toY(series.line.at(range.high).value));
}

std::string drawSeries(const PlotSeries &series, const Axes &axes) {
  std::string svg = fmt::format("<g class=\"series s{}\">", series.style % styles) + drawLine(series, axes);
  std::string path;
  for (const PlotPoint &point : series.points) {
    if (!isDrawable(point))
      continue;
    const double x = axes.toX(std::log10(point.x));
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, axes.toY(std::log10(point.y.value)));
    svg += fmt::format("<line class=\"interval\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", x, x, axes.toY(std::log10(lowEnd(point.y))),
                       axes.toY(std::log10(std::max(point.y.high, point.y.value))));
  }
  if (series.line.points == 0)
    svg += fmt::format("<path class=\"joint\" d=\"{}\"/>", path);
  for (const PlotPoint &point : series.points)
    if (isDrawable(point))
      svg += drawMarker(series.style, axes.toX(std::log10(point.x)), axes.toY(std::log10(point.y.value)), point.text);
  return svg + "</g>";
}

} // namespace

std::string drawLogPlot(const LogPlot &plot) {
  std::string svg = fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">", width, height, escapeHtml(plot.title));
  svg += fmt::format("<text class=\"title\" x=\"{}\" y=\"20\">{}</text>", left, escapeHtml(plot.title));
  const Axes axes = findAxes(plot);
  if (axes.x.isEmpty())
    return svg + fmt::format("<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">no error above 0 was measured</text></svg>", width / 2, height / 2);
  svg += drawGrid(axes);
  svg += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>", left, top, width - left - right, height - top - bottom);
  svg += fmt::format("<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", (left + width - right) / 2, height - 12, escapeHtml(plot.xLabel));
  svg += fmt::format("<text class=\"label\" transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>", (top + height - bottom) / 2,
                     escapeHtml(plot.yLabel));
  if (plot.floor > 0 && std::isfinite(plot.floor)) {
    const double y = axes.toY(std::log10(plot.floor));
    svg += fmt::format("<line class=\"floor\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text class=\"tick\" x=\"{}\" y=\"{:.1f}\">{}</text>", left,
                       width - right, y, y, left + 6, y - 5, escapeHtml(plot.floorText));
  }
  for (const PlotSeries &series : plot.series)
    svg += drawSeries(series, axes);
  return svg + "</svg>";
}

std::string drawLegendKey(unsigned style) {
  return fmt::format("<svg class=\"key series s{}\" viewBox=\"0 0 36 14\" aria-hidden=\"true\"><line class=\"fit\" x1=\"2\" x2=\"34\" y1=\"7\" y2=\"7\"/>{}</svg>",
                     style % styles, drawMarker(style, 18, 7, ""));
}

std::string plotStyle() {
  const char *colors[styles] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7A6A00", "#555555"};
  std::string css = R"(.plot { width: 100%; height: auto; display: block; }
.plot text { fill: var(--ink); font-size: 12px; }
.plot .title { font-size: 15px; font-weight: 600; }
.plot .label { font-size: 13px; }
.plot .grid { stroke: var(--grid); stroke-width: 1; }
.plot .grid.fine { stroke-dasharray: 2 4; }
.plot .frame { fill: none; stroke: var(--muted); stroke-width: 1; }
.plot .floor { stroke: var(--muted); stroke-width: 1.5; stroke-dasharray: 6 4; }
.series .fit { stroke: currentColor; stroke-width: 1.5; }
.series .band { fill: currentColor; opacity: 0.12; stroke: none; }
.series .interval { stroke: currentColor; stroke-width: 1.2; opacity: 0.7; }
.series .joint { fill: none; stroke: currentColor; stroke-width: 1.2; }
.series .marker { fill: currentColor; stroke: var(--paper); stroke-width: 1; }
.key { width: 36px; height: 14px; vertical-align: -2px; }
)";
  for (unsigned i = 0; i < styles; ++i)
    css += fmt::format(".s{} {{ color: {}; }}\n", i, colors[i]);
  return css;
}

std::string escapeHtml(const std::string &text) {
  std::string escaped;
  for (char c : text)
    switch (c) {
    case '&': escaped += "&amp;"; break;
    case '<': escaped += "&lt;"; break;
    case '>': escaped += "&gt;"; break;
    case '"': escaped += "&quot;"; break;
    default: escaped += c;
    }
  return escaped;
}

} // namespace rtsl::report
