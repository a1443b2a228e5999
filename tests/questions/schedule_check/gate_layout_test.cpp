// SPDX-License-Identifier: Apache-2.0
// Automatic gates: by hand, and what is said where they do not fit.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "random_problem.hpp"
#include "scenario/gates/layout.hpp"

namespace takt::schedule_check {
namespace {

using namespace sim::literals;  // NOLINT
using scenario::GateConflict;
using scenario::GateLayout;
using scenario::GateList;
using scenario::GateProblem;
using scenario::lay_out_gates;
using scenario::StreamWindow;
using sim::Duration;

/// Host, switch, host at 1 Gb/s: the frame of 100 octets lasts 864 ns, the gap 96 ns.
GateProblem two_hops() {
  GateProblem problem;
  problem.margin = 200_ns;
  problem.ports = {{models::NodeIndex{0}, 0, "a to sw", 96_ns, 96_ns},
                   {models::NodeIndex{1}, 1, "sw to b", 96_ns, 96_ns}};
  problem.streams = {{"x", 100_us, 10_us, 0, {{0, std::nullopt, 6, 864_ns, 1'050_ns}, {1, 0, 6, 864_ns, 50_ns}}}};
  return problem;
}

TEST(GateLayout, ByHand) {
  const GateLayout layout = lay_out_gates(two_hops());
  ASSERT_TRUE(layout.conflicts.empty());
  ASSERT_EQ(layout.schedule.windows.size(), 1u);
  // At the talker no margin before; 10 us + 864 ns + 1050 ns later the frame is ready at the switch.
  EXPECT_EQ(layout.schedule.windows[0][0], (StreamWindow{10_us, 10_us, 11'064_ns}));
  EXPECT_EQ(layout.schedule.windows[0][1], (StreamWindow{11'914_ns, 11'714_ns, 12'978_ns}));
  EXPECT_EQ(layout.schedule.lists[0].cycle, 100_us);
  EXPECT_EQ(layout.schedule.lists[0].entries,
            (std::vector<GateList::Entry>{{0xBF, 9'904_ns}, {0x00, 96_ns}, {0x40, 1'064_ns}, {0xBF, 88'936_ns}}));
  EXPECT_EQ(layout.schedule.lists[1].entries,
            (std::vector<GateList::Entry>{{0xBF, 11'618_ns}, {0x00, 96_ns}, {0x40, 1'264_ns}, {0xBF, 87'022_ns}}));
}

// A window over the end of the cycle is at its beginning and at its end.
TEST(GateLayout, OverTheEndOfTheCycle) {
  GateProblem problem = two_hops();
  problem.streams[0].release = 99'500_ns;
  const GateLayout layout = lay_out_gates(problem);
  EXPECT_EQ(layout.schedule.lists[0].entries,
            (std::vector<GateList::Entry>{{0x40, 564_ns}, {0xBF, 98'840_ns}, {0x00, 96_ns}, {0x40, 500_ns}}));
}

// What one participant publishes at one instant leaves back to back, and stays so.
TEST(GateLayout, ATrain) {
  GateProblem problem = two_hops();
  problem.streams.push_back(problem.streams[0]);
  problem.streams[1].name = "y";
  const GateLayout layout = lay_out_gates(problem);
  ASSERT_TRUE(layout.conflicts.empty());
  EXPECT_EQ(layout.schedule.windows[1][0].start, 10_us + 864_ns + 96_ns);
  EXPECT_EQ(layout.schedule.windows[1][1].start, layout.schedule.windows[0][1].start + 864_ns + 96_ns);
  EXPECT_EQ(layout.schedule.lists[1].entries.size(), 4u) << "their windows are one";
  problem.streams[1].train = 1;
  const GateLayout others = lay_out_gates(problem);
  ASSERT_EQ(others.conflicts.size(), 2u) << "two talkers at one instant: at both ports";
  const GateConflict& conflict = others.conflicts[1];
  EXPECT_EQ(conflict.kind, GateConflict::Kind::overlap);
  EXPECT_EQ(conflict.first, 0u);
  EXPECT_EQ(conflict.second, 1u);
  EXPECT_EQ(conflict.port, 1u);
  EXPECT_EQ(conflict.first_from, 11'714_ns);
  EXPECT_EQ(conflict.first_until, 12'978_ns);
  EXPECT_EQ(conflict.second_from, 11'714_ns);
}

// Behind the train of 1 Gb/s a link of 100 Mb/s: the second frame waits for the first one, and is known to.
TEST(GateLayout, ATrainBeforeASlowLink) {
  GateProblem problem = two_hops();
  problem.ports[1].gap = problem.ports[1].guard = 960_ns;
  problem.streams[0].hops[1].transmission = 8'640_ns;
  problem.streams.push_back(problem.streams[0]);
  const GateLayout layout = lay_out_gates(problem);
  ASSERT_TRUE(layout.conflicts.empty());
  EXPECT_EQ(layout.schedule.windows[1][1].start, layout.schedule.windows[0][1].start + 9'600_ns);
}

TEST(GateLayout, TheCycleIsTheHyperperiod) {
  GateProblem problem = two_hops();
  problem.streams.push_back(problem.streams[0]);
  problem.streams[1].train = 1;
  problem.streams[1].release = 60_us;
  problem.streams[1].period = 250_us;
  // They meet if 50 us divides the distance of some pair: 60 - 10 = 50.
  const GateLayout meets = lay_out_gates(problem);
  ASSERT_EQ(meets.conflicts.size(), 2u);
  EXPECT_EQ(meets.conflicts[0].cycle, 500_us);
  EXPECT_EQ(meets.conflicts[0].first_from % 100_us, 10_us);
  EXPECT_EQ(meets.conflicts[0].second_from % 250_us, 60_us);
  EXPECT_EQ(meets.conflicts[0].first_from, meets.conflicts[0].second_from);
  problem.streams[1].release = 40_us;
  const GateLayout layout = lay_out_gates(problem);
  ASSERT_TRUE(layout.conflicts.empty());
  EXPECT_EQ(layout.schedule.lists[0].cycle, 500_us);
  EXPECT_EQ(layout.schedule.lists[0].entries.size(), 7u * 3 + 1);
}

// Two streams of one host: the one that may come early stands in the other's window, if it is of the same class.
TEST(GateLayout, FramesThatMayComeInAnyOrder) {
  GateProblem problem = two_hops();
  problem.streams.push_back(problem.streams[0]);
  problem.streams[1].name = "y";
  problem.streams[1].train = 1;
  problem.streams[1].release = 50_us;
  problem.streams[1].early = 39'999_ns;
  EXPECT_TRUE(lay_out_gates(problem).conflicts.empty()) << "y comes a nanosecond behind x";
  problem.streams[1].early = 40_us;
  const GateLayout layout = lay_out_gates(problem);
  ASSERT_EQ(layout.conflicts.size(), 1u);
  EXPECT_EQ(layout.conflicts[0].kind, GateConflict::Kind::order);
  EXPECT_EQ(layout.conflicts[0].second_from, 10_us);
  EXPECT_EQ(layout.conflicts[0].second_until, 50_us);
  problem.streams[1].hops[0].traffic_class = 5;
  problem.streams[1].hops[1].traffic_class = 5;
  EXPECT_TRUE(lay_out_gates(problem).conflicts.empty()) << "in another queue it is nobody's hindrance";
  // The last of one turn and the first of the next.
  problem = two_hops();
  problem.streams.push_back(problem.streams[0]);
  problem.streams[1].train = 1;
  problem.streams[1].release = 5_us;
  problem.streams[0].early = 5_us;
  ASSERT_EQ(lay_out_gates(problem).conflicts.size(), 1u);
  problem.streams[0].early = 4'999_ns;
  EXPECT_TRUE(lay_out_gates(problem).conflicts.empty());
  problem.streams[0].release = 104_us;
  problem.streams[0].early = 0_ns;
  problem.streams[1].early = 1_us;
  EXPECT_EQ(lay_out_gates(problem).conflicts.at(0).kind, GateConflict::Kind::order);
}

TEST(GateLayout, ACycleOfTooManyEntries) {
  GateProblem problem = two_hops();
  problem.streams.push_back(problem.streams[0]);
  problem.streams[1].train = 1;
  problem.streams[1].release = 50_us;
  problem.streams[1].period = 99'999_ns;  // 100 us and 99.999 us: ten seconds
  const GateLayout layout = lay_out_gates(problem);
  ASSERT_EQ(layout.conflicts.size(), 2u);
  EXPECT_EQ(layout.conflicts[0].kind, GateConflict::Kind::cycle_too_long);
  EXPECT_EQ(layout.conflicts[0].cycle, Duration::from_ps(99'999'000) * 100'000);
  EXPECT_EQ(layout.conflicts[0].entries, 199'999u);
}

TEST(GateLayout, AFrameThatIsLongerThanItsPeriod) {
  GateProblem problem = two_hops();
  problem.streams[0].period = 1'100_ns;
  const GateLayout layout = lay_out_gates(problem);
  ASSERT_EQ(layout.conflicts.size(), 2u);
  EXPECT_EQ(layout.conflicts[0].first, layout.conflicts[0].second);
}

// A conflict names instants at which both are really there.
TEST(GateLayout, ConflictsAreReal) {
  std::size_t seen = 0;
  EXPECT_TRUE(rc::check("conflicts are real", [&] {
    const GateProblem problem = random_problem(*rc::gen::arbitrary<std::uint64_t>());
    const GateLayout layout = lay_out_gates(problem);
    for (const GateConflict& conflict : layout.conflicts) {
      if (conflict.kind != GateConflict::Kind::overlap) continue;
      ++seen;
      const auto window_of = [&](std::uint32_t stream) {
        const auto& hops = problem.streams[stream].hops;
        for (std::size_t h = 0; h < hops.size(); ++h)
          if (hops[h].port == conflict.port) return layout.schedule.windows[stream][h];
        return StreamWindow{};
      };
      const StreamWindow first = window_of(conflict.first);
      const StreamWindow second = window_of(conflict.second);
      RC_ASSERT((conflict.first_from - first.open) % problem.streams[conflict.first].period == Duration());
      RC_ASSERT((conflict.second_from - second.open) % problem.streams[conflict.second].period == Duration());
      const Duration gap = problem.ports[conflict.port].gap + 1_ns;
      // A train that is longer than its period overtakes itself, which is no better.
      if (problem.streams[conflict.first].train != problem.streams[conflict.second].train)
        RC_ASSERT(conflict.first_from < conflict.second_until + gap);
      RC_ASSERT(conflict.second_from < conflict.first_until + gap);
    }
  }));
  EXPECT_GT(seen, 50u);
}

}  // namespace
}  // namespace takt::schedule_check
