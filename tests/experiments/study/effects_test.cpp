// SPDX-License-Identifier: Apache-2.0
// Effects by hand: 2 x 3 variants, 2 replications, figures that can be added up in one's head.
#include "study/effects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "study/report.hpp"
#include "study/report_answers.hpp"
#include "study/spread_order.hpp"

namespace takt::study {
namespace {

/// Measure "y" of (a, b, replication) is 10 a + b + replication; "z" is its opposite. It passes below 12.
Content sample() {
  Content content;
  content.header = {{"1", 1}, "by <hand>", "0", 6, 2};
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

TEST(Effects, InfluencesAreSharesOfTheVariance) {
  // Means of the variants of a = 0 are 1.5, 2.5, 3.5, of a = 1 ten more; all of them 7.5. a: 6 * 5^2 = 150; b: 2 * (1 +
  // 0 + 1) = 4; the whole 154.
  const auto found = influences(sample(), 0);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].factor, 0u);
  EXPECT_NEAR(found[0].share, 150.0 / 154, 1e-12);
  EXPECT_NEAR(found[1].share, 4.0 / 154, 1e-12);
  Content flat = sample();
  for (double& value : flat.measures[0].values) value = 1;
  EXPECT_TRUE(influences(flat, 0).empty()) << "nothing varies";
}

TEST(Effects, FactorsThatAreNotCrossedCannotBeToldApart) {
  Content content = sample();
  EXPECT_TRUE(are_crossed(content, 0, 1));
  // One at a time: (0, 1) is the baseline, then only a or only b changes: 4 of 6 pairs.
  for (std::size_t row = 0; row < content.rows(); ++row)
    if (content.variants[content.variant[row]][0] == 1 && content.variants[content.variant[row]][1] > 0)
      content.status[row] = Status::failed;
  EXPECT_TRUE(are_crossed(content, 0, 1));
  // Two of six: each level of a with one of b.
  for (std::size_t row = 0; row < content.rows(); ++row)
    if (content.variants[content.variant[row]][0] == 0 && content.variants[content.variant[row]][1] > 0)
      content.status[row] = Status::failed;
  EXPECT_FALSE(are_crossed(content, 0, 1));
}

TEST(SpreadOrder, MeetsEachPointOnceAndEveryBeginningIsASample) {
  for (const std::uint64_t points : {1u, 2u, 3u, 10u, 100u, 618u, 1000u, 4096u}) {
    const SpreadOrder order(points);
    std::vector<bool> met(points);
    for (std::uint64_t i = 0; i < points; ++i) met[order[i]] = true;
    EXPECT_EQ(static_cast<std::uint64_t>(std::count(met.begin(), met.end(), true)), points);
  }
  // The first fifth of a hundred points has at least one of every ten.
  const SpreadOrder order(100);
  std::vector<int> of_ten(10);
  for (std::uint64_t i = 0; i < 20; ++i) ++of_ten[order[i] / 10];
  for (const int count : of_ten) EXPECT_GE(count, 1);
}

TEST(Report, AnswersOnTop) {
  Content content = sample();
  std::string html = html_report(content);
  // (1, 2) and (1, 3) have points of 12.5 and more: y = 12 + 1 and 13; (1, 1) has 11 and 12.
  EXPECT_NE(html.find("4 of 6 variants pass"), std::string::npos);
  EXPECT_NE(
      html.find("<td>b</td><td class=\"n\">1</td><td class=\"n fail\">2</td><td>a = 1</td><td class=\"n\">1 of 2</td>"),
      std::string::npos)
      << html.substr(0, 4000);
  EXPECT_NE(html.find("a 97 %"), std::string::npos);
  EXPECT_EQ(html.find("have been run"), std::string::npos);
  EXPECT_NE(html.find("takt study shrink FILE 9 --out worst.json"), std::string::npos)
      << "point 9 is variant 4, (1, 2), replication 1: 13";
  content.header.variants = 60;
  EXPECT_NE(html_report(content).find("12 of 120 points have been run"), std::string::npos);
}

TEST(Report, StandsAlone) {
  const std::string html = html_report(sample());
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(html.ends_with("</html>\n"));
  EXPECT_NE(html.find("by &lt;hand&gt;"), std::string::npos);
  for (const char* const outside : {"<script", "src=", "http-equiv", "@import", "url("})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
}

/// Which protection survives? Three protections, two links; "both" keeps the limit on either link, "one" on the first
/// only, "none" on neither.
Content protections() {
  Content content;
  content.header = {{"1", 1}, "cut", "0", 6, 1};
  content.factors = {{"protection", "", false, {"none", "both", "one"}, {NAN, NAN, NAN}},
                     {"link", "", false, {"a-b", "b-c"}, {NAN, NAN}}};
  content.measures = {{"lost", "frames", true, {3, 4, 0, 0, 0, 12}, true}};
  content.limits = {{{scenario::Relation::at_most, 0, "0 frames"}, 0}};
  content.limits[0].text = "lost <= 0";
  for (std::uint32_t v = 0; v < 6; ++v) {
    content.variants.push_back({v / 2, v % 2});
    content.variant.push_back(v);
    content.replication.push_back(0);
    content.status.push_back(Status::done);
    content.passes.push_back(content.measures[0].values[v] == 0);
    content.verdict.emplace_back("pass");
  }
  return content;
}

TEST(Answers, LevelsWithNamesByWhatPasses) {
  const Content content = protections();
  const std::vector<LevelScore> scores = level_scores(content, 0);
  ASSERT_EQ(scores.size(), 3u);
  EXPECT_EQ(scores[0].level, 1u);
  EXPECT_EQ(scores[0].passing, 2u);
  EXPECT_FALSE(scores[0].first_break);
  EXPECT_EQ(scores[1].level, 2u);
  EXPECT_EQ(scores[1].passing, 1u);
  EXPECT_EQ(*scores[1].first_break, 5u);
  EXPECT_EQ(scores[2].passing, 0u);
  const std::string summary = text_summary(content);
  EXPECT_NE(summary.find("protection: variants that pass\n"
                         "  both  2 of 2\n"
                         "  one   1 of 2, the first to break: link = b-c: lost <= 0: 12 frames\n"
                         "  none  0 of 2, the first to break: link = a-b: lost <= 0: 3 frames\n"
                         "link: variants that pass\n"
                         "  a-b  2 of 3, the first to break: protection = none: lost <= 0: 3 frames\n"),
            std::string::npos)
      << summary;
  EXPECT_LT(summary.find("protection: variants"), summary.find("  lost  ")) << "the answer stands first";
  const std::string page = html_report(content);
  EXPECT_NE(page.find("<th>greatest lost</th>"), std::string::npos);
  EXPECT_LT(page.find("2 of 2"), page.find("What matters")) << "the answer stands first";
}

TEST(Answers, NumbersAreNoNames) { EXPECT_EQ(level_text(sample()), ""); }

TEST(Answers, WhatFiguresAre) {
  Content content = protections();
  EXPECT_NE(meaning_of(content, 0).find("of runs: 1 of each variant, phases that nobody gave drawn by the seed"),
            std::string::npos);
  EXPECT_NE(
      html_report(content).find("3 of 6 variants pass in 1 run each, which is no proof that they do in every run"),
      std::string::npos);
  content.measures[0].basis = Basis::bound;
  content.measures[0].values[5] = NAN;
  EXPECT_EQ(
      meaning_of(content, 0),
      "bound: no run exceeds it, whatever phases and chance bring; missing in 1 of 6 points, where nothing bounds it");
  content.measures[0].basis = Basis::worst;
  content.budget = 2;
  EXPECT_EQ(meaning_of(content, 0),
            "worst found: the greatest of any run that a search of 2 million events a point found; missing in 1 of 6 "
            "points, where some run has no such figure");
  content.verdict[2] = "undecided";
  EXPECT_NE(html_report(content).find("3 of 6 variants pass; the requirements of 1 point are undecided"),
            std::string::npos);
}

}  // namespace
}  // namespace takt::study
