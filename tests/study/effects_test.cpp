// Effects by hand: 2 x 3 variants, 2 replications, figures that can be added up in one's head.
#include "study/effects.hpp"

#include <gtest/gtest.h>

#include "study/report.hpp"

namespace takt::study {
namespace {

/// Measure "y" of (a, b, replication) is 10 a + b + replication; "z" is its opposite. It passes below 12.
Content sample() {
  Content content;
  content.header = {"1", "by <hand>", "0", 6, 2};
  content.factors = {{"a", "", false, {"0", "1"}, {0, 1}}, {"b", "", false, {"1", "2", "3"}, {1, 2, 3}}};
  content.measures = {{"y", "us", true, {}}, {"z", "", true, {}}};
  for (std::uint32_t a = 0; a < 2; ++a)
    for (std::uint32_t b = 0; b < 3; ++b) {
      for (std::uint32_t r = 0; r < 2; ++r) {
        const double y = 10.0 * a + (b + 1) + r;
        content.variant.push_back(static_cast<std::uint32_t>(content.variants.size()));
        content.replication.push_back(r);
        content.status.push_back(Status::done);
        content.passes.push_back(y < 12.5);
        content.measures[0].values.push_back(y);
        content.measures[1].values.push_back(-y);
      }
      content.variants.push_back({a, b});
    }
  return content;
}

TEST(Effects, MainEffectAveragesOverTheOthers) {
  const auto effect = main_effect(sample(), 0, 0);
  // a = 0: 1, 2, 3 in replication 0, mean 2; 2, 3, 4 in replication 1, mean 3.
  EXPECT_DOUBLE_EQ(effect[0].mean, 2.5);
  EXPECT_DOUBLE_EQ(effect[1].mean, 12.5);
  EXPECT_EQ(effect[0].count, 2u) << "the replications";
  // Two values that differ by 1: variance 1/2, t(0.975, 1) = 12.7062, half width 12.7062 * sqrt(1/4).
  EXPECT_NEAR(*effect[0].half_width, 6.3531, 1e-4);
}

TEST(Effects, JointEffectAndMissingFigures) {
  Content content = sample();
  content.measures[0].values[0] = std::numeric_limits<double>::quiet_NaN();
  const auto effect = joint_effect(content, 0, 1, 0);
  EXPECT_EQ(effect[0][0].count, 1u);
  EXPECT_DOUBLE_EQ(effect[0][0].mean, 2);
  EXPECT_DOUBLE_EQ(effect[1][2].mean, 13.5);
}

TEST(Effects, ParetoFrontOfOpposites) {
  Content content = sample();
  EXPECT_EQ(pareto_front(content, 0, 1).size(), 6u) << "what is better in one is worse in the other";
  content.measures[1].lower_is_better = false;
  EXPECT_EQ(pareto_front(content, 0, 1), (std::vector<std::uint32_t>{0})) << "one is best in both";
}

// a = 0 always passes; a = 1: b = 1 gives 11 and 12, b = 2 gives 12 and 13.
TEST(Effects, WhereLimitsBreak) {
  const Content content = sample();
  const auto breaks = breaks_along(content, 1);
  ASSERT_EQ(breaks.size(), 2u);
  EXPECT_EQ(content.level_text(breaks[0].variant, 0), "1");
  EXPECT_EQ(breaks[0].last_good, 0u);
  EXPECT_EQ(breaks[0].first_bad, 1u);
  EXPECT_FALSE(breaks[1].first_bad);
  EXPECT_EQ(breaks[1].last_good, 2u);
}

TEST(Report, StandsAlone) {
  const std::string html = html_report(sample());
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(html.ends_with("</html>\n"));
  EXPECT_NE(html.find("by &lt;hand&gt;"), std::string::npos);
  for (const char* const outside : {"<script", "src=", "http-equiv", "@import", "url("}) EXPECT_EQ(html.find(outside), std::string::npos) << outside;
}

}  // namespace
}  // namespace takt::study
