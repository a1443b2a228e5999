// SPDX-License-Identifier: Apache-2.0
// In which order lists and talkers change: streams at one port, whose windows are given by hand.
#include "synthesis/transition.hpp"

#include <gtest/gtest.h>

namespace takt::synthesis::transition_test {
namespace {

using scenario::GateList;
using scenario::GateProblem;
using scenario::ScheduledStream;
using sim::Duration;

constexpr Duration us(std::int64_t n) { return Duration::from_ps(n * 1'000'000); }

/// Frames of 10 us at one port, each `period`, from `release` on.
ScheduledStream flow(const std::string& name, std::int64_t release, std::int64_t period) {
  ScheduledStream made;
  made.name = name;
  made.period = us(period);
  made.release = us(release);
  scenario::ScheduledHop hop;
  hop.traffic_class = 6;
  hop.transmission = us(10);
  made.hops.push_back(hop);
  return made;
}

/// What is laid for these alone.
GateList list_of(const GateProblem& problem, const std::vector<FlowIndex>& flows);

/// A port with a gap of 1 us; `present` flows run.
TransitionProblem at_one_port(std::vector<ScheduledStream> flows, const std::vector<FlowIndex>& present,
                              std::vector<FlowChange> changes) {
  TransitionProblem problem;
  problem.flows.ports.push_back({models::NodeIndex{0}, 0, "sw to h", us(1), us(1)});
  for (std::uint32_t f = 0; f < flows.size(); ++f) flows[f].train = f;
  problem.flows.streams = std::move(flows);
  problem.changes = std::move(changes);
  problem.begin = us(1'000);
  problem.lead = us(100);
  problem.lists = {list_of(problem.flows, present)};
  return problem;
}

/// Closed from 1 us before each frame, 6 while it is sent; by definition, in steps of 1 us.
GateList list_of(const GateProblem& problem, const std::vector<FlowIndex>& flows) {
  std::int64_t cycle = 0;
  for (const FlowIndex f : flows)
    cycle = std::max(cycle, problem.streams[f].period.ps());  // periods here divide each other
  GateList list{Duration::from_ps(cycle), {}};
  for (std::int64_t at = 0; at < cycle; at += us(1).ps()) {
    models::GateStates open = 0xBF;
    for (const FlowIndex f : flows) {
      const std::int64_t period = problem.streams[f].period.ps();
      const std::int64_t into = ((at - problem.streams[f].release.ps()) % period + period) % period;
      if (into < us(10).ps())
        open = 0x40;
      else if (into == period - us(1).ps())
        open = 0;
    }
    if (!list.entries.empty() && list.entries.back().open == open)
      list.entries.back().interval += us(1);
    else
      list.entries.push_back({open, us(1)});
  }
  return list;
}

TEST(Transition, WindowsComeFirstAndGoLast) {
  // "a" moves from 0 to 50 of each 100 us.
  const TransitionProblem problem =
      at_one_port({flow("a", 0, 100), flow("b", 20, 100), flow("a", 50, 100)}, {0, 1}, {{0, 2, false}});
  const Transition transition = plan_transition(problem);
  ASSERT_EQ(transition.steps.size(), 3u);
  ASSERT_EQ(transition.steps[0].lists.size(), 1u);
  const WrittenList& both = transition.steps[0].lists[0];
  EXPECT_EQ(both.list, list_of(problem.flows, {0, 1, 2}));
  EXPECT_EQ(both.written, us(1'000));
  EXPECT_EQ(both.holds_from, us(1'100));
  // The guard of 1 us is over when the first frame comes, at 1150; the last one at its old time is 50 us before rather
  // than 150: 50 is no more than half a period, so it is the one at 1000.
  ASSERT_EQ(transition.steps[1].talkers.size(), 1u);
  EXPECT_EQ(transition.steps[1].talkers[0].first, us(1'150));
  EXPECT_EQ(transition.steps[1].talkers[0].last, us(1'000));
  const WrittenList& after = transition.steps[2].lists.at(0);
  EXPECT_EQ(after.list, list_of(problem.flows, {1, 2}));
  EXPECT_EQ(after.written, us(1'150));
  EXPECT_EQ(after.holds_from, us(1'300));
  EXPECT_EQ(transition.end, us(1'300));
  EXPECT_EQ(transition.lists, std::vector<GateList>{after.list});
}

TEST(Transition, CyclesChangeAtACommonMultiple) {
  // "b" comes with a period of 400 us to a cycle of 100 us, and goes again.
  TransitionProblem problem = at_one_port({flow("a", 0, 100), flow("b", 50, 400)}, {0}, {{{}, 1, false}});
  const Transition coming = plan_transition(problem);
  ASSERT_EQ(coming.steps.size(), 2u);
  EXPECT_EQ(coming.steps[0].lists.at(0).list, list_of(problem.flows, {0, 1}));
  EXPECT_EQ(coming.steps[0].lists.at(0).holds_from, us(1'200));
  EXPECT_EQ(coming.steps[1].talkers.at(0).first, us(1'250));
  EXPECT_FALSE(coming.steps[1].talkers.at(0).last);
  problem = at_one_port({flow("a", 0, 100), flow("b", 50, 400)}, {0, 1}, {{1, {}, false}});
  const Transition going = plan_transition(problem);
  ASSERT_EQ(going.steps.size(), 2u);
  EXPECT_EQ(going.steps[0].talkers.at(0).last, us(850));
  EXPECT_EQ(going.steps[1].lists.at(0).list, list_of(problem.flows, {0}));
  EXPECT_EQ(going.steps[1].lists.at(0).written, us(1'000));
  EXPECT_EQ(going.steps[1].lists.at(0).holds_from, us(1'200));
}

TEST(Transition, APortWithoutWindowsIsOpen) {
  const Transition transition = plan_transition(at_one_port({flow("a", 0, 100)}, {0}, {{0, {}, false}}));
  EXPECT_EQ(transition.lists, (std::vector<GateList>{{us(100), {{models::all_gates_open, us(100)}}}}));
}

TEST(Transition, WhoTakesAPlaceComesWhenItIsFree) {
  // "b" takes the place of "a", which moves to 50.
  const TransitionProblem problem =
      at_one_port({flow("a", 0, 100), flow("b", 20, 100), flow("a", 50, 100), flow("b", 0, 100)}, {0, 1},
                  {{1, 3, false}, {0, 2, false}});
  const Transition transition = plan_transition(problem);
  ASSERT_EQ(transition.steps.size(), 6u);
  EXPECT_EQ(transition.steps[1].talkers.at(0).change, 1u);
  EXPECT_EQ(transition.steps[4].talkers.at(0).change, 0u);
  EXPECT_LT(transition.steps[2].lists.at(0).holds_from, *transition.steps[4].talkers.at(0).first);
  EXPECT_EQ(transition.lists.front(), list_of(problem.flows, {2, 3}));
}

TEST(Transition, WhoGoesMakesRoomFirst) {
  const TransitionProblem problem =
      at_one_port({flow("a", 0, 100), flow("new", 5, 100)}, {0}, {{{}, 1, false}, {0, {}, false}});
  const Transition transition = plan_transition(problem);
  ASSERT_EQ(transition.steps.size(), 4u);
  EXPECT_EQ(transition.steps[0].talkers.at(0).change, 1u);
  EXPECT_EQ(transition.steps[3].talkers.at(0).change, 0u);
}

TEST(Transition, AStreamThatMovesALittleMeetsItselfAlone) {
  // From 0 to 5: its windows overlap, its frames never do.
  const TransitionProblem problem = at_one_port({flow("a", 0, 100), flow("a", 5, 100)}, {0}, {{0, 1, false}});
  const Transition transition = plan_transition(problem);
  ASSERT_EQ(transition.steps.size(), 3u);
  EXPECT_EQ(transition.steps[0].lists.at(0).list, (GateList{us(100), {{0x40, us(15)}, {0xBF, us(84)}, {0, us(1)}}}));
  EXPECT_EQ(*transition.steps[1].talkers.at(0).first - *transition.steps[1].talkers.at(0).last, us(105));
}

TEST(Transition, WhoWouldPauseIsNamed) {
  // Two change places, and no third is looked for: neither can be first.
  std::vector<FlowChange> changes{{0, 2, false}, {1, 3, false}};
  const std::vector<ScheduledStream> flows{flow("a", 0, 100), flow("b", 50, 100), flow("a", 50, 100),
                                           flow("b", 0, 100)};
  const Transition stuck = plan_transition(at_one_port(flows, {0, 1}, changes));
  EXPECT_EQ(stuck.stuck, (std::vector<std::size_t>{0, 1}));
  EXPECT_TRUE(stuck.steps.empty());
  EXPECT_EQ(stuck.why, R"("b" and "a" meet at "sw to h")");
  // One whose frames are lost in any case makes room for the other.
  changes[1].may_pause = true;
  const TransitionProblem problem = at_one_port(flows, {0, 1}, changes);
  const Transition paused = plan_transition(problem);
  EXPECT_TRUE(paused.stuck.empty());
  EXPECT_EQ(paused.lists.front(), list_of(problem.flows, {2, 3}));
  Duration last, first, first_of_other;
  for (const TransitionStep& step : paused.steps)
    for (const TalkerSwitch& each : step.talkers) {
      if (each.change == 1 && each.last) last = *each.last;
      if (each.change == 1 && each.first) first = *each.first;
      if (each.change == 0) first_of_other = *each.first;
    }
  EXPECT_LT(last, first_of_other);
  EXPECT_LT(first_of_other, first);
}

TEST(Transition, ListsThatNoDeviceTakesAreNotWritten) {
  // Four windows ask for twelve entries; for a port that takes 6 some of the time between them is given up.
  TransitionProblem problem =
      at_one_port({flow("a", 0, 100), flow("b", 50, 100), flow("a", 25, 100), flow("b", 75, 100)}, {0, 1},
                  {{0, 2, false}, {1, 3, false}});
  problem.flows.ports[0].limits.entries = 6;
  const Transition one_by_one = plan_transition(problem);
  EXPECT_TRUE(one_by_one.stuck.empty()) << one_by_one.why;
  for (const TransitionStep& step : one_by_one.steps)
    for (const WrittenList& each : step.lists) EXPECT_LE(each.list.entries.size(), 6u);
  // Intervals of at least 30 us leave no list with three windows.
  problem.flows.ports[0].limits.least_interval = us(30);
  const Transition stuck = plan_transition(problem);
  EXPECT_EQ(stuck.stuck, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(stuck.why, R"("sw to h" takes no list with all windows that are needed at a time)");
}

}  // namespace
}  // namespace takt::synthesis::transition_test
