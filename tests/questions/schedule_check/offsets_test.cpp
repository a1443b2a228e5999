// SPDX-License-Identifier: Apache-2.0
// Offsets that are chosen: by hand, and random problems whose choice the layout and the checker judge.
#include "scenario/gates/offsets.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <map>
#include <set>
#include <tuple>

#include "random_problem.hpp"
#include "scenario/gates/layout.hpp"
#include "schedule_check/check.hpp"
#include "sim/random.hpp"

namespace takt::schedule_check {
namespace {

using namespace sim::literals;  // NOLINT
using scenario::choose_offsets;
using scenario::ChosenOffset;
using scenario::GateConflict;
using scenario::OffsetProblem;
using scenario::ScheduledStream;
using scenario::Waiting;
using sim::Duration;

/// Six hosts at a switch at 1 Gb/s; port 6 goes from there to the listener. A frame of 100 octets lasts 864 ns, the gap
/// 96 ns: 960 ns together.
OffsetProblem star() {
  OffsetProblem problem;
  for (std::uint32_t host = 0; host < 6; ++host)
    problem.gates.ports.push_back({models::NodeIndex{host}, 0, "h" + std::to_string(host) + " to sw", 96_ns, 96_ns});
  problem.gates.ports.push_back({models::NodeIndex{6}, 6, "sw to z", 96_ns, 96_ns});
  return problem;
}
void add(OffsetProblem& problem, std::uint32_t host, Duration period, std::uint32_t train, bool is_movable = true) {
  const auto stream = static_cast<std::uint32_t>(problem.gates.streams.size());
  problem.gates.streams.push_back({"s" + std::to_string(stream),
                                   period,
                                   {},
                                   train,
                                   {{host, std::nullopt, 6, 864_ns, 1'050_ns}, {6, 0, 6, 864_ns, 50_ns}}});
  if (is_movable) problem.movable.push_back({stream});
}
std::vector<Duration> offsets_of(const std::vector<ChosenOffset>& chosen) {
  std::vector<Duration> offsets;
  for (const ChosenOffset& each : chosen) offsets.push_back(each.offset);
  return offsets;
}

// The second frame may begin on the common link when the first and its gap are over.
TEST(Offsets, TwoAndThreeOverOneLink) {
  OffsetProblem problem = star();
  add(problem, 0, 100_us, 0);
  add(problem, 1, 100_us, 1);
  EXPECT_EQ(offsets_of(choose_offsets(problem)), (std::vector<Duration>{0_ns, 960_ns}));
  add(problem, 0, 100_us, 2);  // the same talker as the first, which its own link keeps from 0, too
  EXPECT_EQ(offsets_of(choose_offsets(problem)), (std::vector<Duration>{0_ns, 960_ns, 1'920_ns}));
}

// Where first fit gives up, whoever stands in the way is moved: first fit alone solves 36 of these forty.
TEST(Offsets, MovesWhoStandsInTheWay) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    sim::RandomStream chance(seed, "full", "test");
    OffsetProblem problem = star();
    // Slots of 960 ns; periods of 12, 20 and 30 of them have 4, 6, 10 in common. Some 72 % of the common link are used.
    const std::int64_t slots[] = {12, 20, 30};
    double load = 0;
    for (std::uint32_t s = 0; load < 0.72; ++s) {
      const std::int64_t period = slots[chance.below(3)];
      add(problem, static_cast<std::uint32_t>(chance.below(6)), 960_ns * period, s);
      load += 1.0 / static_cast<double>(period);
    }
    for (const ChosenOffset& each : choose_offsets(problem)) {
      EXPECT_TRUE(each.meetings.empty()) << seed;
      EXPECT_EQ(each.offset.ps() % 1'000, 0) << seed << ": gates open on whole ns";
    }
  }
}

// With clocks that may differ by 200 ns each frame has 200 ns before it and 200 ns behind on the common link: 1360 ns.
TEST(Offsets, TheMarginKeepsThemApart) {
  OffsetProblem problem = star();
  problem.gates.margin = 200_ns;
  add(problem, 0, 100_us, 0);
  add(problem, 1, 100_us, 1);
  add(problem, 2, 100_us, 2);
  EXPECT_EQ(offsets_of(choose_offsets(problem)), (std::vector<Duration>{0_ns, 1'360_ns, 2'720_ns}));
}

// The first comes every 2 us and leaves 1040 ns between; the others, every 4 us, take one gap each: from 960 ns to
// 1920, and 2 us later.
TEST(Offsets, OverTheHyperperiod) {
  OffsetProblem problem = star();
  add(problem, 0, 4_us, 0);
  add(problem, 1, 4_us, 1);
  add(problem, 2, 2_us, 2);  // chooses first
  EXPECT_EQ(offsets_of(choose_offsets(problem)), (std::vector<Duration>{960_ns, 2'960_ns, 0_ns}));
}

// Periods of 3 us and 2 us: frames of the two come at all distances modulo 1 us, of which each takes 960 ns.
TEST(Offsets, PeriodsThatNeverFit) {
  OffsetProblem problem = star();
  add(problem, 0, 3_us, 0);
  add(problem, 1, 2_us, 1);
  const std::vector<ChosenOffset> chosen = choose_offsets(problem);
  ASSERT_EQ(chosen.size(), 2u);
  ASSERT_EQ(chosen[0].meetings.size(), 1u) << "told by the one that chose later";
  EXPECT_EQ(chosen[0].meetings[0].other, 1u);
  EXPECT_EQ(chosen[0].meetings[0].port, 6u);
  EXPECT_TRUE(chosen[1].meetings.empty());
}

// Four times 960 ns fill 4 us but for 160 ns. The fifth at 0 meets one, in between two.
TEST(Offsets, FullLink) {
  OffsetProblem problem = star();
  for (std::uint32_t i = 0; i < 5; ++i) add(problem, i, 4_us, i);
  const std::vector<ChosenOffset> chosen = choose_offsets(problem);
  EXPECT_EQ(offsets_of(chosen), (std::vector<Duration>{0_ns, 960_ns, 1'920_ns, 2'880_ns, 0_ns}));
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_TRUE(chosen[i].meetings.empty());
  ASSERT_EQ(chosen[4].meetings.size(), 1u);
  EXPECT_EQ(chosen[4].meetings[0].stream, 4u);
  EXPECT_EQ(chosen[4].meetings[0].other, 0u);
}

// What is given stays: the others go around it, before it where there is room. It takes 1 us to 1960 ns.
TEST(Offsets, AroundWhatIsGiven) {
  OffsetProblem problem = star();
  add(problem, 0, 100_us, 0, false);
  problem.gates.streams[0].release = 1_us;
  add(problem, 1, 100_us, 1);
  add(problem, 2, 100_us, 2);
  EXPECT_EQ(offsets_of(choose_offsets(problem)), (std::vector<Duration>{0_ns, 1'960_ns}));
}

// State and data of one participant leave back to back, 1920 ns, and get one offset; they need most and choose first.
TEST(Offsets, TrainsMoveTogether) {
  OffsetProblem problem = star();
  add(problem, 0, 100_us, 0);
  add(problem, 1, 100_us, 1);
  add(problem, 1, 100_us, 1);
  problem.movable = {{0}, {1, 2}};
  EXPECT_EQ(offsets_of(choose_offsets(problem)), (std::vector<Duration>{1'920_ns, 0_ns}));
}

// A talker that may be up to 500 ns early. Behind gates that does not show on the common link, where the other goes 960
// ns later; without gates its frame may be there 500 ns before: at -500 ns of the next period, and before the other's
// when that goes 960 ns later.
TEST(Offsets, EarlyFrames) {
  OffsetProblem problem = star();
  add(problem, 0, 100_us, 0);
  add(problem, 1, 100_us, 1);
  problem.gates.streams[1].early = 500_ns;
  problem.gates.streams[1].release = 500_ns;  // with an offset of 0 it comes from 0 on
  EXPECT_EQ(offsets_of(choose_offsets(problem)), (std::vector<Duration>{0_ns, 460_ns})) << "its gate opens at 960 ns";
  problem.waiting = Waiting::nowhere;
  EXPECT_EQ(offsets_of(choose_offsets(problem)), (std::vector<Duration>{1'460_ns, 0_ns}))
      << "what may come at any time for 500 ns needs most";
}

// At one talker the first to come stands in the queue: who is early comes when the window of the other is over, not
// before.
TEST(Offsets, InOrderAtTheTalker) {
  OffsetProblem problem = star();
  add(problem, 0, 100_us, 0);
  add(problem, 0, 100_us, 1);
  problem.gates.streams[1].early = 5_us;
  problem.gates.streams[1].release = 5_us;
  // At 0 or sooner after the first it might stand before it: its release 5 us + x, less 5 us, is behind 0.
  const std::vector<ChosenOffset> chosen = choose_offsets(problem);
  EXPECT_EQ(offsets_of(chosen), (std::vector<Duration>{0_ns, 1_ns}));
  problem.gates.streams[0].release += chosen[0].offset;
  problem.gates.streams[1].release += chosen[1].offset;
  EXPECT_TRUE(scenario::lay_out_gates(problem.gates).conflicts.empty());
}

/// Trains of a random problem, some of them movable.
OffsetProblem movable_problem(std::uint64_t seed) {
  OffsetProblem problem;
  problem.gates = random_problem(seed);
  sim::RandomStream chance(seed, "movable", "test");
  std::map<std::uint32_t, std::vector<std::uint32_t>> trains;
  for (std::uint32_t s = 0; s < problem.gates.streams.size(); ++s) trains[problem.gates.streams[s].train].push_back(s);
  for (const auto& [train, streams] : trains)
    if (chance.below(5) != 0) problem.movable.push_back(streams);
  return problem;
}

// They are said to meet where the layout finds conflicts, and nowhere else; what does not meet is a sound schedule.
TEST(Offsets, TheLayoutAgrees) {
  std::size_t solved = 0;
  std::size_t unsolved = 0;
  EXPECT_TRUE(rc::check("chosen offsets are judged by the layout", [&] {
    OffsetProblem problem = movable_problem(*rc::gen::arbitrary<std::uint64_t>());
    const std::vector<ChosenOffset> chosen = choose_offsets(problem);
    RC_ASSERT(chosen.size() == problem.movable.size());
    std::set<std::uint32_t> moved;
    using Pair = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;
    std::set<Pair> told;
    for (std::size_t u = 0; u < chosen.size(); ++u) {
      RC_ASSERT(chosen[u].offset >= Duration() && chosen[u].offset.ps() % 1'000 == 0 &&
                chosen[u].offset < problem.gates.streams[problem.movable[u][0]].period);
      for (const scenario::Meeting& meeting : chosen[u].meetings)
        told.emplace(std::min(meeting.stream, meeting.other), std::max(meeting.stream, meeting.other), meeting.port);
      for (const std::uint32_t s : problem.movable[u]) {
        problem.gates.streams[s].release += chosen[u].offset;
        moved.insert(s);
      }
    }
    const scenario::GateLayout layout = scenario::lay_out_gates(problem.gates);
    std::set<Pair> found;
    bool others = false;
    for (const GateConflict& conflict : layout.conflicts) {
      RC_ASSERT(conflict.kind != GateConflict::Kind::cycle_too_long);
      const ScheduledStream& first = problem.gates.streams[conflict.first];
      const ScheduledStream& second = problem.gates.streams[conflict.second];
      const bool is_chosen =
          first.train != second.train && (moved.contains(conflict.first) || moved.contains(conflict.second));
      if (is_chosen)
        found.emplace(std::min(conflict.first, conflict.second), std::max(conflict.first, conflict.second),
                      conflict.port);
      else
        others = true;  // within a train, or between streams that were given
    }
    RC_ASSERT(told == found);
    if (!found.empty()) ++unsolved;
    if (!found.empty() || others) return;
    ++solved;
    RC_ASSERT(check(problem.gates, layout.schedule).empty());
  }));
  EXPECT_GT(solved, 20u);
  EXPECT_GT(unsolved, 1u) << "some cannot be solved";
}

}  // namespace
}  // namespace takt::schedule_check
