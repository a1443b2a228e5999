// SPDX-License-Identifier: Apache-2.0
// The first paper in its short form: every tolerance is a hard check. The long form is `takt paper programs`.
#include <gtest/gtest.h>

#include <set>

#include "papers/report.hpp"

namespace takt::papers {
namespace {

ProgramsOptions short_options() {
  ProgramsOptions options;
  options.scenarios = std::string(TAKT_SOURCE_DIR) + "/scenarios/papers/programs";
  options.is_short = true;
  return options;
}

TEST(ProgramsPaper, ShortFormHolds) {
  json::Diagnostics diagnostics;
  const auto made = reproduce_programs(short_options(), diagnostics);
  ASSERT_TRUE(made) << diagnostics.to_text();
  std::size_t predicted = 0;
  for (const Comparison& comparison : made->comparisons) {
    EXPECT_TRUE(comparison.holds) << comparison.what << ": " << comparison.reproduced << " instead of "
                                  << comparison.published;
    if (comparison.standing == Standing::predicted) ++predicted;
  }
  EXPECT_EQ(predicted, 9u) << "three figures of rows 5, 10 and 15";
  // Three minutes at 5 kHz, less what is under way at the end.
  for (const Speed& run : made->speed) EXPECT_NEAR(static_cast<double>(run.round_trips), 900'000, 40) << run.values;

  for (const BeyondTable& table : made->beyond) {
    EXPECT_FALSE(table.rows.empty()) << table.name;
    for (const BeyondRow& row : table.rows)
      for (std::size_t k = 0; k < reaction_kinds; ++k) {
        const ReactionCell& cell = row.reactions[k];
        EXPECT_EQ(cell.reactions, 40u) << table.name << " " << row.variant << " " << reaction_names[k];
        ASSERT_TRUE(cell.simulated && cell.bound) << table.name << " " << row.variant << " " << reaction_names[k];
        EXPECT_LE(*cell.simulated, *cell.bound) << table.name << " " << row.variant << " " << reaction_names[k];
      }
  }
  std::set<std::string> figures;
  for (const Figure& figure : made->figures) figures.insert(figure.name);
  for (const char* name : {"fig-1", "fig-3", "fig-4a", "fig-4b", "fig-5a", "fig-5b", "fig-6a", "fig-6b", "fig-8a",
                           "fig-8b", "fig-8c", "fig-8d", "fig-8e"})
    EXPECT_TRUE(figures.contains(name)) << name;
}

TEST(ProgramsPaper, SaysWhereItsScenariosAreMissing) {
  json::Diagnostics diagnostics;
  ProgramsOptions options = short_options();
  options.scenarios = "/nowhere";
  EXPECT_FALSE(reproduce_programs(options, diagnostics));
  EXPECT_NE(diagnostics.to_text().find("/nowhere/round-trip-1.json"), std::string::npos) << diagnostics.to_text();
}

TEST(ProgramsPaper, ToleranceCountsEitherWay) {
  EXPECT_TRUE(compare("x", 100, 104, "ms", 1, 0.04, Standing::predicted).holds);
  EXPECT_TRUE(compare("x", 100, 96, "ms", 1, 0.04, Standing::predicted).holds);
  EXPECT_FALSE(compare("x", 100, 104.1, "ms", 1, 0.04, Standing::predicted).holds);
  EXPECT_FALSE(compare("x", 100, 95.9, "ms", 1, 0.04, Standing::predicted).holds);
}

TEST(ProgramsPaper, OneMissedFigureIsEnough) {
  Reproduction made;
  made.comparisons = {compare("x", 100, 101, "ms", 1, 0.04, Standing::predicted)};
  EXPECT_TRUE(made.holds());
  made.comparisons.push_back(compare("y", 100, 110, "ms", 1, 0.04, Standing::calibrated));
  EXPECT_FALSE(made.holds());
  made.comparisons.pop_back();
  BeyondRow row;
  row.reactions[1] = {1, sim::Duration::from_ps(2), sim::Duration::from_ps(1)};
  made.beyond.push_back({"t", "", "", {row}});
  EXPECT_FALSE(made.holds()) << "a simulated reaction above its bound";
}

}  // namespace
}  // namespace takt::papers
