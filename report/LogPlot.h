//===- LogPlot.h - curves on two logarithmic axes, as SVG -----------------===//
#pragma once

#include "report/LineFit.h"

#include <string>
#include <vector>

namespace rtsl::report {

/// A measured point and the interval of its y, if its ends are numbers.
struct PlotPoint {
  double x = 0;
  Estimate y;
  std::string name, figures; // shown when the pointer rests on it, or when it has the focus
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
  /// A horizontal line at `mark`, with a text; 0: none. The axis reaches down to it only if it is
  /// near; if it is not, the text stands at the lower edge.
  double mark = 0;
  std::string markText;
  /// The least that the y axis spans.
  double leastDecades = 0.5;
  std::string nothing = "no error above 0 was measured"; // said where there is no point
};

/// An `<svg>` of 480 by 372 units that scales with its column; the classes that it names are in
/// plotStyle(). Points that are not positive have no place on a logarithmic axis and are left out;
/// a plot with no point says so. Each point can be pointed at, tapped and reached by keyboard, and
/// then shows its figures.
std::string drawLogPlot(const LogPlot &plot);

/// The sample of line and marker that stands beside a name in a legend, as a small `<svg>`.
std::string drawLegendKey(unsigned style);

/// The id of the check box that shows and hides the curves of a style, wherever it stands on the
/// page.
std::string curveSwitch(unsigned style);

/// The CSS of plots and keys. The eight colours can be told apart by people who are colour-blind
/// (M. Okabe, K. Ito, "Color Universal Design", 2008); on dark paper they are lighter.
std::string plotStyle();

/// Text for use in HTML and SVG.
std::string escapeHtml(const std::string &text);

} // namespace rtsl::report
