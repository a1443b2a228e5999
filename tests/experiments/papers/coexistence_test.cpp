// SPDX-License-Identifier: Apache-2.0
// The short form of `takt paper coexistence`: every cell within its tolerance, every claim, and what TSN changes.
#include "papers/coexistence/coexistence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "papers/coexistence/report.hpp"
#include "scenario/resolve.hpp"

namespace takt::papers::coexistence {
namespace {

Options short_options() {
  Options options;
  options.scenarios = std::string(TAKT_SOURCE_DIR) + "/scenarios/papers/coexistence";
  options.is_short = true;
  return options;
}

const Reproduction& made() {
  static const Reproduction once = [] {
    json::Diagnostics diagnostics;
    auto reproduction = reproduce(short_options(), diagnostics);
    EXPECT_TRUE(reproduction) << diagnostics.to_text();
    return reproduction.value_or(Reproduction());
  }();
  return once;
}

TEST(CoexistencePaper, EveryCellAndEveryClaim) {
  std::map<Standing, int> count;
  for (const Comparison& comparison : made().comparisons) {
    EXPECT_TRUE(comparison.holds) << comparison.what << ": " << comparison.reproduced << " instead of "
                                  << comparison.published;
    ++count[comparison.standing];
  }
  EXPECT_EQ(count[Standing::calibrated], 16);
  EXPECT_EQ(count[Standing::predicted], 16);
  EXPECT_EQ(count[Standing::flaw], 1);
  EXPECT_TRUE(made().holds());
}

// The simulated cells are of runs: chance moves them away from the law's formula, but not far.
TEST(CoexistencePaper, CellsAreDrawnNotComputed) {
  bool differs = false;
  ASSERT_EQ(made().success.size(), tables.size());
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const FittedLaw law = calibrate(Law::weibull, tables[t]);
    for (std::size_t column = 0; column < intervals.size(); ++column) {
      const double expected = 100 * law.done_within(intervals[column]);
      // Binomial, over all tests of 10 ms; four and a half deviations for 32 cells.
      const double calls = tables[t].tests * 10.0 / intervals[column] * made().repetitions;
      const double deviation = std::sqrt(expected * (100 - expected) / calls);
      EXPECT_NEAR(made().success[t][column], expected, 4.5 * deviation + 0.05) << cell_name(tables[t], column);
      differs = differs || std::abs(made().success[t][column] - expected) > 1e-6;
    }
  }
  EXPECT_TRUE(differs);
}

// The files carry the laws that the calibration gives, rounded.
TEST(CoexistencePaper, ScenariosCarryTheCalibratedLaws) {
  for (const int interval : intervals) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(
        short_options().scenarios + "/mirror-" + std::to_string(interval) + "ms.json", {}, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    for (const PublishedTable& table : tables) {
      const std::string name = (table.protocol == "DDS" ? "dds-" : "ua-") + std::string(table.node);
      const auto& applications = resolved->scenario.applications;
      const auto application =
          std::find_if(applications.begin(), applications.end(), [&](const auto& a) { return a.name == name; });
      ASSERT_NE(application, applications.end()) << name;
      const auto thread = std::find_if(application->threads.begin(), application->threads.end(),
                                       [&](const auto& t) { return t.name == table.operation; });
      ASSERT_NE(thread, application->threads.end()) << name;
      ASSERT_TRUE(thread->response && thread->response->weibull) << name;
      const FittedLaw law = calibrate(Law::weibull, table);
      EXPECT_NEAR(static_cast<double>(thread->response->weibull->scale.ps()) * 1e-9, law.scale, 6e-5) << name;
      EXPECT_NEAR(thread->response->weibull->shape, law.shape, 6e-5) << name;
      EXPECT_EQ(thread->every.ps(), interval * 1'000'000'000LL) << name;
      EXPECT_FALSE(resolved->scenario.clocks.gptp) << "no TSN";
    }
  }
}

TEST(CoexistencePaper, Figures) {
  std::set<std::string> figures;
  for (const Figure& figure : made().figures) figures.insert(figure.name);
  for (const char* name : {"criterion-1", "fig-4", "fig-5", "fig-6", "fig-7", "fig-8", "fig-9"})
    EXPECT_TRUE(figures.contains(name)) << name;
  EXPECT_EQ(made().waves.size(), 5u);
  ASSERT_EQ(made().signals.size(), 5u);
  // A pulse of 100 ms for each message of 31 s.
  EXPECT_NEAR(static_cast<double>(made().signals[0].statistics.pulses), 310, 5);
}

TEST(CoexistencePaper, RealTimeLinuxAndTsnTogetherLeaveNothingIrregular) {
  ASSERT_EQ(made().improvements.size(), 8u) << "four variants at 10 and 1 ms";
  for (const std::size_t first : {0u, 4u}) {
    const ImprovementRow& published = made().improvements[first];
    const ImprovementRow& real_time = made().improvements[first + 1];
    const ImprovementRow& tsn = made().improvements[first + 2];
    const ImprovementRow& both = made().improvements[first + 3];
    EXPECT_GE(real_time.least_success, 99.99) << published.interval;
    EXPECT_GE(both.least_success, 99.99) << published.interval;
    EXPECT_NEAR(tsn.success, published.success, 1) << "TSN does nothing for an operating system";
    EXPECT_EQ(both.signal.irregular, 0) << published.interval;
    EXPECT_GE(both.least_buffered, 99.99) << published.interval;
    EXPECT_LT(both.reaction.greatest, published.reaction.mean) << published.interval;
    EXPECT_EQ(both.reaction.answered, both.reaction.commands) << published.interval;
  }
}

TEST(CoexistencePaper, MeasuredFiguresStandBesideTheOthers) {
  Reproduction copy = made();
  MeasuredCriteria measured;
  measured.machine = "a machine";
  measured.success[2][at_2_ms] = 12.34;
  measured.buffered[1][at_1_ms] = 56.78;
  add_measured(measured, copy);
  const std::string text = text_report(copy);
  EXPECT_NE(text.find("a machine"), std::string::npos);
  EXPECT_NE(text.find("12.3 %"), std::string::npos);
  EXPECT_NE(text.find("56.8"), std::string::npos);
  EXPECT_EQ(copy.holds(), made().holds()) << "nothing is judged by them";
}

TEST(CoexistencePaper, SaysWhereItsScenariosAreMissing) {
  json::Diagnostics diagnostics;
  Options options = short_options();
  options.scenarios = "/nowhere";
  EXPECT_FALSE(reproduce(options, diagnostics));
  EXPECT_NE(diagnostics.to_text().find("/nowhere/mirror-10ms.json"), std::string::npos) << diagnostics.to_text();
}

}  // namespace
}  // namespace takt::papers::coexistence
