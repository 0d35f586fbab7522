//===- LogPlot.cpp --------------------------------------------------------===//
#include "report/LogPlot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::report {

namespace {

constexpr double width = 480, height = 372;
constexpr double left = 66, right = 14, top = 62, bottom = 52; // margins
constexpr double textLeft = 8;                                 // of the text above the frame
constexpr double nearMark = 0.35; // decades by which an axis may be extended to include a mark
constexpr unsigned styles = 8;

struct Range {
  double low = std::numeric_limits<double>::infinity(),
         high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool isEmpty() const { return !(low <= high); }
  /// Adds a margin on both sides, and extends the range to at least this number of decades.
  void widen(double least) {
    const double air = std::max(0.06 * (high - low), (least - (high - low)) / 2);
    low -= air;
    high += air;
  }
};

/// Maps values to positions in the plot; ranges are of log10.
struct Axes {
  Range x, y;
  double toX(double logarithm) const {
    return left + (width - left - right) * (logarithm - x.low) / (x.high - x.low);
  }
  double toY(double logarithm) const {
    return height - bottom - (height - top - bottom) * (logarithm - y.low) / (y.high - y.low);
  }
};

bool isDrawable(const PlotPoint &point) {
  return point.x > 0 && point.y.value > 0 && std::isfinite(point.x) && std::isfinite(point.y.value);
}

/// The lower end of an interval may be 0, which is not on the axis, and an estimate may have no
/// interval.
double lowEnd(const Estimate &estimate) {
  return estimate.low > 0 ? estimate.low : estimate.value;
}
double highEnd(const Estimate &estimate) {
  return estimate.high > estimate.value && std::isfinite(estimate.high) ? estimate.high
                                                                        : estimate.value;
}

bool hasMark(const LogPlot &plot) {
  return plot.mark > 0 && std::isfinite(plot.mark);
}

Axes findAxes(const LogPlot &plot) {
  Axes axes;
  for (const PlotSeries &series : plot.series)
    for (const PlotPoint &point : series.points)
      if (isDrawable(point)) {
        axes.x.add(std::log10(point.x));
        axes.y.add(std::log10(lowEnd(point.y)));
        axes.y.add(std::log10(highEnd(point.y)));
      }
  if (axes.x.isEmpty())
    return axes;
  if (hasMark(plot) && std::log10(plot.mark) > axes.y.low - nearMark &&
      std::log10(plot.mark) < axes.y.high + nearMark)
    axes.y.add(std::log10(plot.mark));
  axes.x.widen(0.5);
  axes.y.widen(plot.leastDecades);
  return axes;
}

/// 1000 as 1000, 2e-5 as 2·10 with a superscript -5.
std::string tickText(int factor, int decade) {
  if (decade >= -3 && decade <= 4)
    return fmt::format("{:g}", factor * std::pow(10.0, decade));
  return fmt::format("{}10<tspan dy=\"-5\" class=\"raised\">{}</tspan>",
                     factor == 1 ? "" : fmt::format("{}·", factor), decade);
}

struct Tick {
  double place; // log10
  std::string text;
  bool isMain = true;
};

/// Multiples of powers of ten: fewer for more decades. Only some have labels, so that labels do not
/// overlap.
std::vector<Tick> decadeTicks(const Range &range) {
  const double decades = range.high - range.low;
  const std::vector<int> factors = decades > 2.5   ? std::vector<int>{1}
                                   : decades > 0.9 ? std::vector<int>{1, 2, 5}
                                                   : std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8, 9};
  std::vector<Tick> ticks;
  for (int decade = int(std::floor(range.low)); decade <= int(std::ceil(range.high)); ++decade)
    for (int factor : factors)
      if (const double place = decade + std::log10(double(factor));
          place >= range.low && place <= range.high) {
        const bool hasText = factor <= 3 || factor == 5 || factor == 7;
        ticks.push_back({place, hasText ? tickText(factor, decade) : "", factor == 1});
      }
  return ticks;
}

/// Equal steps of 1, 2 or 5 times a power of ten, for less than half a decade.
std::vector<Tick> evenTicks(const Range &range) {
  const double low = std::pow(10, range.low), high = std::pow(10, range.high),
               rough = (high - low) / 5;
  const double decade = std::pow(10, std::floor(std::log10(rough)));
  const double step = decade * (rough <= 1.5 * decade   ? 1
                                : rough <= 3.5 * decade ? 2
                                : rough <= 7.5 * decade ? 5
                                                        : 10);
  std::vector<Tick> ticks;
  for (double number = std::ceil(low / step); number * step <= high; ++number)
    ticks.push_back({std::log10(number * step), fmt::format("{:.4g}", number * step)});
  return ticks;
}

std::vector<Tick> ticksFor(const Range &range) {
  return range.high - range.low < 0.45 ? evenTicks(range) : decadeTicks(range);
}

std::string drawGrid(const Axes &axes) {
  std::string svg;
  for (const Tick &tick : ticksFor(axes.x)) {
    const double x = axes.toX(tick.place);
    svg += fmt::format("<line class=\"grid{}\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{}\" y2=\"{}\"/>",
                       tick.isMain ? "" : " fine", x, x, top, height - bottom);
    svg +=
        fmt::format("<text class=\"tick\" x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                    x, height - bottom + 18, tick.text);
  }
  for (const Tick &tick : ticksFor(axes.y)) {
    const double y = axes.toY(tick.place);
    svg += fmt::format("<line class=\"grid{}\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>",
                       tick.isMain ? "" : " fine", left, width - right, y, y);
    svg += fmt::format("<text class=\"tick\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>",
                       left - 6, y + 4, tick.text);
  }
  return svg;
}

std::string drawMarker(unsigned style, double x, double y) {
  const double r = 3.4;
  switch (style % styles / 2) {
  case 0:
    return fmt::format("<circle class=\"marker\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", x, y, r);
  case 1:
    return fmt::format(
        "<rect class=\"marker\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\"/>", x - r,
        y - r, 2 * r, 2 * r);
  case 2:
    return fmt::format(
        "<path class=\"marker\" d=\"M{:.1f} {:.1f}l{:.2f} {:.2f}l{:.2f} {:.2f}l{:.2f} {:.2f}z\"/>",
        x, y - 1.3 * r, 1.3 * r, 1.3 * r, -1.3 * r, 1.3 * r, -1.3 * r, -1.3 * r);
  default:
    return fmt::format("<path class=\"marker\" d=\"M{:.1f} {:.1f}l{:.2f} {:.2f}h{:.2f}z\"/>", x,
                       y - 1.2 * r, 1.2 * r, 2.1 * r, -2.4 * r);
  }
}

/// A marker that can be pointed at, tapped and reached by keyboard. Its text is shown above the
/// frame, where there are no curves.
std::string drawPoint(const PlotPoint &point, unsigned style, double x, double y) {
  std::string svg = fmt::format("<g class=\"point\" tabindex=\"0\" role=\"img\" aria-label=\"{}, "
                                "{}\"><circle class=\"halo\" cx=\"{:.1f}\" cy=\"{:.1f}\"/>",
                                escapeHtml(point.name), escapeHtml(point.figures), x, y);
  svg += drawMarker(style, x, y);
  svg += fmt::format(
      "<text class=\"tip\" x=\"{}\" y=\"34\">{}<tspan x=\"{}\" dy=\"1.25em\">{}</tspan></text></g>",
      textLeft, escapeHtml(point.name), textLeft, escapeHtml(point.figures));
  return svg;
}

/// The part of `x` where the line is within the range `y`; a steep line leaves the frame.
Range withinFrame(const LineFit &line, const Range &x, const Range &y) {
  const double first = line.at(x.low).value, rise = line.at(x.high).value - first;
  if (rise == 0 || x.low == x.high)
    return first >= y.low && first <= y.high ? x : Range();
  const auto where = [&](double value) {
    return x.low + (value - first) / rise * (x.high - x.low);
  };
  const auto [enters, leaves] = std::minmax({where(y.low), where(y.high)});
  Range shown;
  shown.low = std::max(x.low, enters);
  shown.high = std::min(x.high, leaves);
  return shown;
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
    const auto inside = [&](double value) {
      return std::clamp(axes.toY(value), top, height - bottom);
    };
    upper += fmt::format("{}{:.1f} {:.1f}", i ? "L" : "M", axes.toX(x), inside(y.high));
    lower = fmt::format("L{:.1f} {:.1f}", axes.toX(x), inside(y.low)) + lower;
  }
  std::string svg = fmt::format("<path class=\"band\" d=\"{}{}z\"/>", upper, lower);
  const Range shown = withinFrame(series.line, range, axes.y);
  if (!shown.isEmpty())
    svg += fmt::format("<line class=\"fit{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" "
                       "y2=\"{:.1f}\"/>",
                       series.line.bends() ? " bent" : "", axes.toX(shown.low),
                       axes.toY(series.line.at(shown.low).value), axes.toX(shown.high),
                       axes.toY(series.line.at(shown.high).value));
  return svg;
}

std::string drawSeries(const PlotSeries &series, const Axes &axes) {
  std::string svg =
      fmt::format("<g class=\"series s{}\">", series.style % styles) + drawLine(series, axes);
  std::string path;
  for (const PlotPoint &point : series.points) {
    if (!isDrawable(point))
      continue;
    const double x = axes.toX(std::log10(point.x));
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x,
                        axes.toY(std::log10(point.y.value)));
    svg += fmt::format(
        "<line class=\"interval\" x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/>", x, x,
        axes.toY(std::log10(lowEnd(point.y))), axes.toY(std::log10(highEnd(point.y))));
  }
  if (series.line.points == 0 || series.line.bends())
    svg += fmt::format("<path class=\"joint\" d=\"{}\"/>", path);
  for (const PlotPoint &point : series.points)
    if (isDrawable(point))
      svg += drawPoint(point, series.style, axes.toX(std::log10(point.x)),
                       axes.toY(std::log10(point.y.value)));
  return svg + "</g>";
}

std::string drawMark(const LogPlot &plot, const Axes &axes) {
  if (!hasMark(plot))
    return {};
  const double place = std::log10(plot.mark);
  if (place < axes.y.low || place > axes.y.high) {
    const bool isBelow = place < axes.y.low;
    return fmt::format("<text class=\"tick\" x=\"{}\" y=\"{}\">{} {}: {:.2g}</text>", left + 6,
                       isBelow ? height - bottom - 6 : top + 14, isBelow ? "↓" : "↑",
                       escapeHtml(plot.markText), plot.mark);
  }
  const double y = axes.toY(place);
  return fmt::format("<line class=\"mark\" x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" y2=\"{:.1f}\"/><text "
                     "class=\"tick\" x=\"{}\" y=\"{:.1f}\">{}</text>",
                     left, width - right, y, y, left + 6, y - 5, escapeHtml(plot.markText));
}

} // namespace

std::string drawLogPlot(const LogPlot &plot) {
  std::string svg =
      fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"group\" aria-label=\"{}\">",
                  width, height, escapeHtml(plot.title));
  svg += fmt::format("<text class=\"title\" x=\"{}\" y=\"15\">{}</text>", textLeft,
                     escapeHtml(plot.title));
  const Axes axes = findAxes(plot);
  if (axes.x.isEmpty())
    return svg +
           fmt::format(
               "<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text></svg>",
               width / 2, height / 2, escapeHtml(plot.nothing));
  svg += fmt::format("<text class=\"hint\" x=\"{}\" y=\"34\">Point at a marker, tap it or tab to "
                     "it for its figures.</text>",
                     textLeft);
  svg += drawGrid(axes);
  svg += fmt::format("<rect class=\"frame\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>", left,
                     top, width - left - right, height - top - bottom);
  svg += fmt::format("<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                     (left + width - right) / 2, height - 12, escapeHtml(plot.xLabel));
  svg += fmt::format("<text class=\"label\" transform=\"translate(13 {}) rotate(-90)\" "
                     "text-anchor=\"middle\">{}</text>",
                     (top + height - bottom) / 2, escapeHtml(plot.yLabel));
  svg += drawMark(plot, axes);
  for (const PlotSeries &series : plot.series)
    svg += drawSeries(series, axes);
  return svg + "</svg>";
}

std::string drawLegendKey(unsigned style) {
  return fmt::format(
      "<svg class=\"key series s{}\" viewBox=\"0 0 36 14\" aria-hidden=\"true\"><line "
      "class=\"fit\" x1=\"2\" x2=\"34\" y1=\"7\" y2=\"7\"/>{}</svg>",
      style % styles, drawMarker(style, 18, 7));
}

std::string curveSwitch(unsigned style) {
  return fmt::format("curve{}", style % styles);
}

std::string plotStyle() {
  const char *onWhite[styles] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                 "#E69F00", "#56B4E9", "#7A6A00", "#555555"};
  const char *onBlack[styles] = {"#3E9FE0", "#F07A2E", "#22B98E", "#E39AC4",
                                 "#F2B63C", "#9AD4F5", "#BFAE3A", "#B5B5B5"};
  // Text is at least 12 pixels high on a phone (a column of 366) and on a desktop (580).
  std::string css = R"(.plot { width: 100%; height: auto; display: block; overflow: visible; }
.plot text { fill: var(--ink); font-size: 11px; }
.plot .raised { font-size: 0.8em; }
.plot .title { font-size: 13px; font-weight: 600; }
.plot .hint { fill: var(--muted); }
.plot .tip { display: none; }
.plot .point { outline: none; cursor: default; }
.plot .point:hover .tip, .plot .point:focus .tip { display: block; }
.plot:has(.point:hover, .point:focus) .hint { display: none; }
.plot:has(.point:hover) .point:focus:not(:hover) .tip { display: none; }
.plot .halo { r: 8px; fill: currentColor; fill-opacity: 0; stroke: none; pointer-events: all; }
.plot .point:hover .halo, .plot .point:focus .halo { fill-opacity: 0.35; }
.plot .grid { stroke: var(--grid); stroke-width: 1; }
.plot .grid.fine { stroke-dasharray: 2 4; }
.plot .frame { fill: none; stroke: var(--muted); stroke-width: 1; }
.plot .mark { stroke: var(--muted); stroke-width: 1.5; stroke-dasharray: 6 4; }
.series .fit { stroke: currentColor; stroke-width: 1.5; }
.series .fit.bent { stroke-dasharray: 1 4; }
.series .band { fill: currentColor; opacity: 0.12; stroke: none; }
.series .interval { stroke: currentColor; stroke-width: 1.2; opacity: 0.7; }
.series .joint { fill: none; stroke: currentColor; stroke-width: 1.2; }
.series .marker { fill: currentColor; stroke: var(--paper); stroke-width: 1; }
.key { width: 36px; height: 14px; vertical-align: -2px; }
@media (max-width: 640px) { .plot text { font-size: 16px; } .plot .title { font-size: 16px; } }
@media (pointer: coarse) { .plot .halo { r: 15px; } }
)";
  for (unsigned i = 0; i < styles; ++i)
    css += fmt::format(".s{0} {{ color: {1}; }}\n@media (prefers-color-scheme: dark) {{ .s{0} {{ "
                       "color: {2}; }} }}\n"
                       "body:has(#{3}:not(:checked)) .plot .s{0} {{ display: none; }}\n",
                       i, onWhite[i], onBlack[i], curveSwitch(i));
  return css;
}

std::string escapeHtml(const std::string &text) {
  std::string escaped;
  for (char c : text)
    switch (c) {
    case '&':
      escaped += "&amp;";
      break;
    case '<':
      escaped += "&lt;";
      break;
    case '>':
      escaped += "&gt;";
      break;
    case '"':
      escaped += "&quot;";
      break;
    default:
      escaped += c;
    }
  return escaped;
}

} // namespace rtsl::report
