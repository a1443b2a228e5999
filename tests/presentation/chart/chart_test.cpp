// SPDX-License-Identifier: Apache-2.0
// Axes have round ticks that hold all figures; charts have one mark for each figure.
#include "chart/chart.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "chart/axis.hpp"
#include "chart/svg.hpp"

namespace takt::chart {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

std::vector<double> ticks_of(const Axis& axis) {
  std::vector<double> values;
  for (const Tick& tick : axis.ticks()) values.push_back(tick.value);
  return values;
}

// 0.3 to 9.7: six steps of 9.4 / 6 = 1.57, rounded up to 2.
TEST(Axis, HasRoundTicks) {
  const Axis axis({0.3, 9.7, 5}, Scale::linear, 0, 100);
  EXPECT_EQ(ticks_of(axis), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_DOUBLE_EQ(axis.at(0), 0);
  EXPECT_DOUBLE_EQ(axis.at(10), 100);
  EXPECT_DOUBLE_EQ(axis.at(2.5), 25);
  EXPECT_DOUBLE_EQ(axis.at(1e9), 100) << "beyond the end is the end";
}

TEST(Axis, LogarithmicAxisIsEvenInRatios) {
  const Axis axis({3, 500}, Scale::logarithmic, 0, 300);
  EXPECT_DOUBLE_EQ(axis.low(), 1);
  EXPECT_DOUBLE_EQ(axis.high(), 1000);
  EXPECT_NEAR(axis.at(10), 100, 1e-9);
  EXPECT_NEAR(axis.at(100), 200, 1e-9);
  EXPECT_EQ(ticks_of(axis).front(), 1);
  EXPECT_NEAR(ticks_of(axis).back(), 1000, 1e-6);
}

TEST(Axis, TakesEqualNoAndInfiniteValues) {
  const Axis equal({5, 5}, Scale::linear, 0, 100);
  EXPECT_LT(equal.low(), 5);
  EXPECT_GT(equal.high(), 5);
  EXPECT_FALSE(Axis({}, Scale::linear, 0, 100).ticks().empty());
  EXPECT_FALSE(Axis({-1, 0}, Scale::logarithmic, 0, 100).is_logarithmic()) << "nothing above 0";
  const Axis axis({1, 2, INFINITY, NAN}, Scale::linear, 0, 100);
  EXPECT_LE(axis.high(), 3);
}

// The longest axis, the shortest: never more than a dozen ticks, all figures within.
TEST(Axis, HoldsEveryFigure) {
  for (const double scale : {1e-12, 1e-3, 1.0, 7.0, 1e9})
    for (const double span : {1e-3, 0.5, 3.0, 99.0}) {
      const double low = scale * 2;
      const double high = low + scale * span;
      const Axis axis({low, high}, Scale::linear, 0, 1);
      EXPECT_LE(axis.low(), low * (1 + 1e-9));
      EXPECT_GE(axis.high(), high * (1 - 1e-9));
      EXPECT_LE(axis.ticks().size(), 12u);
      EXPECT_GE(axis.ticks().size(), 2u);
    }
}

TEST(LineChart, HasAMarkForEachSampleAndAPathForEachCurve) {
  LineChart chart{"a < b",
                  {"x"},
                  {"y"},
                  {{"one", {{1, 1, 0.5, 1.5}, {2, 3, {}, {}}}, true, ""}, {"two", {{1, 2, {}, {}}}, true, ""}},
                  {{2.5, "limit"}},
                  560,
                  300};
  const std::string svg = draw(chart);
  EXPECT_EQ(count(svg, "class=\"mark\""), 3u);
  EXPECT_EQ(count(svg, "class=\"curve\""), 1u) << "one sample alone is no curve";
  EXPECT_EQ(count(svg, "class=\"whisker\""), 1u) << "one path: a line and its two ends";
  EXPECT_EQ(count(svg, "class=\"limit\""), 1u);
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  EXPECT_EQ(count(svg, "<svg"), 1u);
}

TEST(BarChart, HasABarForEachFigureThatIsThere) {
  BarChart chart;
  chart.title = "t";
  chart.categories = {"a", "b"};
  chart.names = {"x", "y"};
  chart.bars = {{Sample{0, 1, {}, {}}, std::nullopt}, {Sample{0, 2, {}, {}}, Sample{0, 3, {}, {}}}};
  EXPECT_EQ(count(draw(chart), "class=\"mark\""), 3u);
}

TEST(HeatMap, HasACellForEachPair) {
  HeatMap map;
  map.columns = {"1", "2", "3"};
  map.rows = {"a", "b"};
  map.cells = {{1, 2, 3}, {4, std::nullopt, 6}};
  map.marked = {{true, false, false}, {false, false, false}};
  const std::string svg = draw(map);
  EXPECT_EQ(count(svg, "class=\"mark\""), 6u);
  EXPECT_EQ(count(svg, "class=\"chosen\""), 1u);
  EXPECT_NE(svg.find("no result"), std::string::npos);
}

TEST(Svg, EscapesWhatWouldEndAnElement) { EXPECT_EQ(escaped("<a b=\"c\">&'"), "&lt;a b=&quot;c&quot;&gt;&amp;&#39;"); }

TEST(LineChart, MarksMomentsWithinItsAxisAndLeavesMarksOutWhereToldSo) {
  LineChart chart;
  chart.title = "offsets";
  chart.series.push_back({"a", {{0, 1, {}, {}}, {10, 2, {}, {}}}, true, {}, false});
  chart.moments = {{5, "gm lost"}, {50, "beyond"}};
  const std::string text = draw(chart);
  EXPECT_EQ(count(text, "gm lost"), 1u);
  EXPECT_EQ(count(text, "beyond"), 0u);
  EXPECT_EQ(count(text, "<circle"), 0u);
}

}  // namespace
}  // namespace takt::chart
