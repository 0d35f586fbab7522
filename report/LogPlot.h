//===- LogPlot.h - curves on two logarithmic axes, as SVG -----------------===//
#pragma once

#include "report/LineFit.h"

#include <string>
#include <vector>

namespace rtsl::report {

/// A measured point and the interval of its y.
struct PlotPoint {
  double x = 0;
  Estimate y;
  std::string text; // shown when the pointer rests on it
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
  /// A horizontal line where the reference ends to tell errors apart; 0: none.
  double floor = 0;
  std::string floorText;
};

/// An `<svg>` of 640 by 420 units that scales with its column; the classes that it names are in plotStyle(). Points that
/// are not positive have no place on a logarithmic axis and are left out; a plot with no point says so.
std::string drawLogPlot(const LogPlot &plot);

/// The sample of line and marker that stands beside a name in a legend, as a small `<svg>`.
std::string drawLegendKey(unsigned style);

/// The CSS of plots and keys. The eight colours can be told apart by people who are colour-blind (M. Okabe, K. Ito,
/// "Color Universal Design", 2008).
std::string plotStyle();

/// Text for use in HTML and SVG.
std::string escapeHtml(const std::string &text);

} // namespace rtsl::report
