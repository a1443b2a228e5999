// SPDX-License-Identifier: Apache-2.0
// Lists that devices do not take, and what becomes of them.
#include "scenario/gates/list_limits.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "random_problem.hpp"
#include "scenario/gates/layout.hpp"
#include "schedule_check/check.hpp"

namespace takt::schedule_check {
namespace {

using namespace sim::literals;  // NOLINT
using scenario::fit_list;
using scenario::FittedList;
using scenario::GateList;
using scenario::ListLimits;
using scenario::ListObstacle;
using sim::Duration;

constexpr models::GateStates six = 1u << 6, others = static_cast<models::GateStates>(~six);

/// Two windows of class 6 with a guard of 1 us before each, in 100 us: seven entries.
GateList two_windows() {
  return {100_us,
          {{others, 19_us}, {0, 1_us}, {six, 10_us}, {others, 29_us}, {0, 1_us}, {six, 10_us}, {others, 30_us}}};
}

TEST(ListLimits, WhatADeviceTakesStays) {
  EXPECT_EQ(fit_list(two_windows(), six, false, {7, 1_us, 1_us}).list, two_windows());
}

TEST(ListLimits, TheGuardGoesToTheWindow) {
  const FittedList fitted = fit_list(two_windows(), six, false, {5, 1_ns, 1_ns});
  EXPECT_EQ(fitted.obstacle, ListObstacle::none);
  EXPECT_EQ(fitted.list,
            (GateList{100_us, {{others, 19_us}, {six, 11_us}, {others, 29_us}, {six, 11_us}, {others, 30_us}}}));
}

// Giving up the 19 us at the beginning saves one entry, the 29 us between the windows two: 14.5 us for each are
// cheaper.
TEST(ListLimits, TheShortestTimeForAnEntryIsGivenUp) {
  EXPECT_EQ(fit_list(two_windows(), six, false, {3, 1_ns, 1_ns}).list,
            (GateList{100_us, {{others, 19_us}, {six, 51_us}, {others, 30_us}}}));
  EXPECT_EQ(fit_list(two_windows(), six, false, {2, 1_ns, 1_ns}).list,
            (GateList{100_us, {{six, 70_us}, {others, 30_us}}}));
}

TEST(ListLimits, TheOtherClassesKeepTheirLongestTime) {
  const GateList ends{100_us, {{six, 10_us}, {others, 80_us}, {six, 10_us}}};
  const FittedList fitted = fit_list(ends, six, false, {2, 1_ns, 1_ns});
  EXPECT_EQ(fitted.obstacle, ListObstacle::entries);
  EXPECT_EQ(fitted.needed, 3u);
  EXPECT_EQ(fit_list(ends, six, false, {3, 1_ns, 1_ns}).obstacle, ListObstacle::none);
}

TEST(ListLimits, EndsMoveOutwards) {
  EXPECT_EQ(fit_list(two_windows(), six, false, {7, 1_ns, 4_us}).list,
            (GateList{100_us, {{others, 16_us}, {six, 16_us}, {others, 24_us}, {six, 16_us}, {others, 28_us}}}));
  EXPECT_EQ(fit_list(two_windows(), six, false, {7, 12_us, 1_us}).list,
            (GateList{100_us, {{others, 19_us}, {six, 12_us}, {others, 28_us}, {six, 12_us}, {others, 29_us}}}));
}

TEST(ListLimits, WhatCannotBeIsSaid) {
  EXPECT_EQ(fit_list(two_windows(), six, false, {7, 1_ns, 3_us}).obstacle, ListObstacle::cycle);
  EXPECT_EQ(fit_list(two_windows(), six, false, {7, 1_ns, 100_us}).obstacle, ListObstacle::no_time);
  EXPECT_EQ(fit_list(two_windows(), six, true, {7, 2_us, 1_us}).obstacle, ListObstacle::waiting);
  const FittedList waiting = fit_list(two_windows(), six, true, {6, 1_us, 1_us});
  EXPECT_EQ(waiting.obstacle, ListObstacle::entries);
  EXPECT_EQ(waiting.needed, 7u);
}

// Whatever the limits: what is laid out keeps to them and is a schedule; and with the entries that are said to do it
// holds.
TEST(ListLimits, LayoutsWithLimitsAreSound) {
  std::size_t limited = 0;
  EXPECT_TRUE(rc::check("limits are kept", [&] {
    scenario::GateProblem problem = random_problem_that_fits(*rc::gen::arbitrary<std::uint64_t>());
    const ListLimits limits{*rc::gen::elementOf(std::vector<std::size_t>{2, 3, 4, 8, 16}),
                            *rc::gen::elementOf(std::vector<Duration>{1_ns, 100_ns, 5_us}),
                            *rc::gen::elementOf(std::vector<Duration>{1_ns, 8_ns, 100_ns, 1_us})};
    const scenario::GateLayout before = scenario::lay_out_gates(problem);
    for (scenario::GatedPort& port : problem.ports) port.limits = limits;
    scenario::GateLayout layout = scenario::lay_out_gates(problem);
    for (int again = 0; !layout.conflicts.empty() && again < 2; ++again) {
      for (const scenario::GateConflict& conflict : layout.conflicts) {
        RC_ASSERT(conflict.kind == scenario::GateConflict::Kind::limits);
        RC_ASSERT(conflict.obstacle != ListObstacle::entries || conflict.entries > limits.entries);
        // Each as it asks, or as if it had none.
        if (conflict.obstacle == ListObstacle::entries)
          problem.ports[conflict.port].limits.entries = conflict.entries;
        else
          problem.ports[conflict.port].limits = {};
      }
      layout = scenario::lay_out_gates(problem);
    }
    for (const scenario::GateConflict& conflict : layout.conflicts)
      RC_ASSERT(conflict.obstacle == ListObstacle::waiting);
    if (!layout.conflicts.empty()) return;
    const std::vector<std::string> wrong = check(problem, layout.schedule);
    if (!wrong.empty()) RC_FAIL(wrong.front());
    RC_ASSERT(layout.schedule.windows == before.schedule.windows);
    if (layout.schedule.lists != before.schedule.lists) ++limited;
  }));
  EXPECT_GT(limited, 20u) << "the limits are not trivial";
}

// A list that is longer than the device takes, or of other steps, is no schedule.
TEST(ListLimits, TheCheckerSeesLimits) {
  scenario::GateProblem problem = random_problem_that_fits(7);
  const scenario::GateLayout layout = scenario::lay_out_gates(problem);
  ASSERT_TRUE(check(problem, layout.schedule).empty());
  std::size_t p = 0;
  while (layout.schedule.lists[p].entries.size() < 3) ++p;
  problem.ports[p].limits.entries = layout.schedule.lists[p].entries.size() - 1;
  EXPECT_FALSE(check(problem, layout.schedule).empty());
  problem.ports[p].limits = {};
  problem.ports[p].limits.least_interval = layout.schedule.lists[p].cycle;
  EXPECT_FALSE(check(problem, layout.schedule).empty());
}

}  // namespace
}  // namespace takt::schedule_check
