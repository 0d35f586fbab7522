#include "report/LogPlot.h"

#include <gtest/gtest.h>

#include <regex>

using namespace rtsl::report;

namespace {

LogPlot falling(double first, double last, double mark) {
  LogPlot plot;
  plot.series.push_back({"one", 0, {}, {}});
  plot.series.back().points = {{1, {first, first, first}, "one, 1 spp", "a"},
                               {10, {last, last, last}, "one, 10 spp", "b"}};
  plot.mark = mark;
  plot.markText = "the mark";
  return plot;
}

/// The y of the halos: where the points are.
std::vector<double> heights(const std::string &svg) {
  std::vector<double> found;
  const std::regex halo("class=\"halo\" cx=\"[0-9.]+\" cy=\"([0-9.]+)\"");
  for (std::sregex_iterator at(svg.begin(), svg.end(), halo), end; at != end; ++at)
    found.push_back(std::stod((*at)[1]));
  return found;
}

std::size_t count(const std::string &text, const std::string &part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

} // namespace

// The frame is 258 units high.
TEST(LogPlot, AFarMarkLeavesThePlotToItsPoints) {
  const std::vector<double> without = heights(drawLogPlot(falling(1, 0.01, 0)));
  const std::string svg = drawLogPlot(falling(1, 0.01, 1e-9));
  EXPECT_EQ(heights(svg), without);
  EXPECT_GT(without[1] - without[0], 200);
  EXPECT_EQ(count(svg, "class=\"mark\""), 0u);
  EXPECT_NE(svg.find("↓ the mark: 1e-09"), std::string::npos);
}

TEST(LogPlot, ANearMarkIsDrawn) {
  const std::string svg = drawLogPlot(falling(1, 0.01, 0.007));
  EXPECT_EQ(count(svg, "class=\"mark\""), 1u);
  EXPECT_EQ(count(svg, "↓"), 0u);
}

// Where intervals are wide, a line may be far steeper than the points beside it.
TEST(LogPlot, ASteepLineStaysInItsFrame) {
  for (const double slope : {-45.0, -2.0, 45.0}) {
    LogPlot plot = falling(1, 0.01, 0);
    LineFit &line = plot.series.front().line;
    line.points = 2;
    line.slope = {slope, slope - 1, slope + 1};
    line.intercept = slope < 0 ? 0 : -46;
    const std::string svg = drawLogPlot(plot);
    std::smatch ends;
    ASSERT_TRUE(std::regex_search(
        svg, ends,
        std::regex(
            "<line class=\"fit\" x1=\"([0-9.]+)\" y1=\"(.*?)\" x2=\"([0-9.]+)\" y2=\"(.*?)\"")))
        << slope;
    for (const int end : {2, 4}) {
      EXPECT_GE(std::stod(ends[end]), 61.9) << slope;
      EXPECT_LE(std::stod(ends[end]), 320.1) << slope;
    }
    EXPECT_LT(std::stod(ends[1]), std::stod(ends[3])) << slope;
  }
}

TEST(LogPlot, EveryAxisHasTicksWithTexts) {
  for (const auto &[first, last] : {std::pair(1.02, 0.99),
                                    {3.0, 1.1},
                                    {5e-5, 2e-5},
                                    {1e3, 1e-6},
                                    {2e-8, 1.9e-8},
                                    {40000, 9000}}) {
    LogPlot plot = falling(first, last, 0);
    plot.leastDecades = 0.01;
    const std::string svg = drawLogPlot(plot);
    const std::regex text("text-anchor=\"end\">[^<]");
    const std::ptrdiff_t ticks =
        std::distance(std::sregex_iterator(svg.begin(), svg.end(), text), std::sregex_iterator());
    EXPECT_GE(ticks, 2) << first << " to " << last;
    EXPECT_LE(ticks, 12) << first << " to " << last;
  }
}

TEST(LogPlot, ReportsThatThereAreNoPoints) {
  EXPECT_NE(drawLogPlot({}).find("no error above 0 was measured"), std::string::npos);
}

// In a column of 366 pixels, as on a telephone: 12 pixels are 16 of 480 units.
TEST(LogPlot, HasTextsThatCanBeReadOnATelephone) {
  const std::string style = plotStyle(), svg = drawLogPlot(falling(1, 0.01, 0));
  std::smatch size;
  ASSERT_TRUE(std::regex_search(
      style, size, std::regex("max-width: 640px\\) \\{ \\.plot text \\{ font-size: ([0-9]+)px")));
  std::smatch box;
  ASSERT_TRUE(std::regex_search(svg, box, std::regex("viewBox=\"0 0 ([0-9]+) ")));
  EXPECT_GE(std::stod(size[1]) * 366 / std::stod(box[1]), 12);
}
