// SPDX-License-Identifier: Apache-2.0
// Charts: what is drawn stands where its figures say.
#include <gtest/gtest.h>

#include "chart/axis.hpp"
#include "chart/bar_chart.hpp"
#include "chart/histogram.hpp"
#include "chart/sequence_chart.hpp"
#include "chart/svg.hpp"

namespace takt::chart {
namespace {

TEST(FixedAxis, LinearAndLogarithmicPixels) {
  const Axis linear(Scale::linear, 0, 10, 100, 200);
  EXPECT_DOUBLE_EQ(linear.at(0), 100);
  EXPECT_DOUBLE_EQ(linear.at(2.5), 125);
  EXPECT_DOUBLE_EQ(linear.at(11), 200) << "beyond the axis: at its end";
  const Axis logarithmic(Scale::logarithmic, 1, 10'000, 400, 0);
  EXPECT_DOUBLE_EQ(logarithmic.at(100), 200);
}

TEST(FixedAxis, TicksAreRound) {
  const auto ticks = Axis(Scale::linear, 0, 0.7, 0, 100).ticks();
  ASSERT_EQ(ticks.size(), 8u);  // steps of 0.1
  EXPECT_EQ(ticks[3].text, "0.3");
  const auto decades = Axis(Scale::logarithmic, 0.5, 2000, 0, 100).ticks();
  ASSERT_EQ(decades.size(), 4u);
  EXPECT_EQ(decades[0].text, "1");
  EXPECT_EQ(decades[3].text, "1000");
}

TEST(Svg, TextIsEscaped) {
  Svg svg(10, 10);
  svg.text({0, 0}, "a < b & \"c\"", Anchor::start, Class{"label"});
  EXPECT_NE(svg.element("t").find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
}

TEST(Histogram, ABarForEachBucket) {
  const std::string drawn = histogram({"t", "x", "y"}, {{0.2, 0.3, 1}, {0.3, 0.4, 1000}}, 0.2, 0.7);
  std::size_t bars = 0;
  for (std::size_t at = drawn.find("class=\"mark\""); at != std::string::npos;
       at = drawn.find("class=\"mark\"", at + 1))
    ++bars;
  EXPECT_EQ(bars, 2u);
}

TEST(SequenceChart, MessagesGoFromRowToRow) {
  SequenceChart chart;
  chart.title = "t";
  chart.participants = {"a", "b"};
  chart.states = {"Ready", "Ready"};
  chart.steps = {{0, 0, "Start"}};
  chart.messages = {{0, 5, 0, 1, "hello"}};
  // Two rows, 34 pixels apart, from 130 on; lines of life 320 apart, from 320 on.
  EXPECT_NE(sequence_chart(chart).find(R"(x1="320" y1="130" x2="640" y2="164")"), std::string::npos)
      << sequence_chart(chart);
}

TEST(LimitedBars, WithoutALimitThereIsNoLine) {
  const auto lines = [](const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = text.find("class=\"limit\""); at != std::string::npos;
         at = text.find("class=\"limit\"", at + 1))
      ++count;
    return count;
  };
  EXPECT_EQ(lines(bar_chart("t", "y", {"k"}, {{"g", {{1, 2}}}})), 1u);
  EXPECT_EQ(lines(bar_chart("t", "y", {"k"}, {{"g", {{1, std::nullopt}}}})), 0u);
}

}  // namespace
}  // namespace takt::chart
