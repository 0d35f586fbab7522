//===- LogPlot.h - curves on two logarithmic axes, as SVG -----------------===//
#pragma once

#include "report/measures/LineFit.h"

#include <string>
#include <vector>

namespace rtsl::report {

/// A measured point and the interval of its y, if its ends are not NaN.
struct PlotPoint {
  double x = 0;
  Estimate y;
  std::string name, figures; // shown when the pointer is on it, or when it has the focus
};

struct PlotSeries {
  std::string name;
  unsigned style = 0; // which of the eight colours and markers; the legend uses the same
  std::vector<PlotPoint> points;
  LineFit line; // of log10 y over log10 x; drawn with its band if it has points
};

struct LogPlot {
  std::string title, xLabel, yLabel;
  std::vector<PlotSeries> series;
  /// A horizontal line at `mark`, with a text; 0: none. The axis is extended to it only if it is
  /// near; otherwise the text is at the lower edge.
  double mark = 0;
  std::string markText;
  /// The least that the y axis spans.
  double leastDecades = 0.5;
  std::string nothing = "no error above 0 was measured"; // shown if there are no points
};

/// An `<svg>` of 480 by 372 units that scales with its column; plotStyle() defines its CSS classes.
/// Points that are not positive cannot be shown on a logarithmic axis and are left out; a plot
/// without points shows a text instead. Each point can be pointed at, tapped and reached by
/// keyboard, and then shows its figures.
std::string drawLogPlot(const LogPlot &plot);

/// The sample of line and marker beside a name in a legend, as a small `<svg>`.
std::string drawLegendKey(unsigned style);

/// The id of the check box that shows and hides the curves of a style, anywhere on the page.
std::string curveSwitch(unsigned style);

/// The CSS of plots and keys. The eight colours can be told apart by people who are colour-blind
/// (M. Okabe, K. Ito, "Color Universal Design", 2008); on dark paper they are lighter.
std::string plotStyle();

/// Text for use in HTML and SVG.
std::string escapeHtml(const std::string &text);

} // namespace rtsl::report
