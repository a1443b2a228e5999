// SPDX-License-Identifier: Apache-2.0
// Gates as a function of time against the state machines run tick by tick, and against numbers worked out by hand.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <utility>
#include <vector>

#include "models/egress/gate_schedule.hpp"
#include "tests/models/schedule_executor.hpp"

namespace takt::models::gate_control_list_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
using test::Ns;

constexpr LocalTime at(Duration since_start) { return LocalTime() + since_start; }
constexpr LocalTime at_ns(Ns ns) { return LocalTime::from_ps(ns * 1'000); }
constexpr LocalTime never = LocalTime::never();
constexpr GateOperation set = GateOperation::set_gate_states;
constexpr GateOperation hold = GateOperation::set_and_hold_mac;
constexpr GateOperation release = GateOperation::set_and_release_mac;

GateSchedule running_from_0(const GateControlList& list, Duration extension = 0_ns) {
  GateSchedule gates;
  gates.request_change(at(0_ns), {&list, at(0_ns), extension});
  return gates;
}
StartAnswer ask_again_at(LocalTime time) { return {false, time}; }

// Cycle 1 ms, H 0x80 for 100 us, R 0x7F for 900 us.
const std::vector<GateControlEntry> worked_entries = {{hold, 0x80, 100_us}, {release, 0x7F, 900_us}};

// At 1 Gb/s, 1522 octets and the preamble take 1530 * 8 ns = 12.24 us: 995 + 12.24 > 1000. 500 octets take 4.064 us and
// fit.
TEST(WorkedSchedule, AFrameStartsOnlyIfItEndsBeforeItsGateCloses) {
  const GateControlList list(worked_entries, 1_ms);
  GateSchedule gates = running_from_0(list);
  EXPECT_EQ(gates.may_start(0, at(995_us), 12'240_ns), ask_again_at(at(1'100_us)));
  EXPECT_TRUE(gates.may_start(0, at(995_us), 4'064_ns).may_start);
  EXPECT_TRUE(gates.may_start(0, at(995_us), 5_us).may_start);  // ends exactly at the close
  EXPECT_FALSE(gates.may_start(0, at(995_us), 5_us + 1_ps).may_start);
  EXPECT_EQ(gates.may_start(7, at(995_us), 672_ns), ask_again_at(at(1_ms)));
  EXPECT_EQ(gates.may_start(7, at(1'000_us - 1_ps), 100_us), ask_again_at(at(1_ms)));
  EXPECT_TRUE(gates.may_start(7, at(1_ms), 100_us).may_start);
  EXPECT_EQ(gates.may_start(7, at(1_ms), 100_us + 1_ps), ask_again_at(never));  // no window is as long
  EXPECT_EQ(gates.open_share(7, at(1_ms)), (OpenShare{100_us, 1_ms}));
  EXPECT_EQ(gates.open_share(3, at(1_ms)), (OpenShare{900_us, 1_ms}));
  EXPECT_EQ(list.longest_window(3), 900_us);
}

TEST(WorkedSchedule, AnExplicitGuardBandClosesTheGateItself) {
  const std::vector<GateControlEntry> entries = {{hold, 0x80, 100_us}, {set, 0x7F, 887'664_ns}, {set, 0x00, 12'336_ns}};
  const GateControlList list(entries, 1_ms);
  GateSchedule gates = running_from_0(list);
  EXPECT_EQ(gates.close_time(0, at(500_us)), at(987'664_ns));
  EXPECT_EQ(gates.gate_states(at(987'664_ns)), 0x00);
  EXPECT_EQ(gates.open_time(0, at(990_us)), at(1'100_us));
  EXPECT_EQ(gates.next_change(at(987'664_ns)), at(1_ms));
}

// Asked at 3.25 ms for 4.4 ms: the cycle that starts at 4.0 ms is cut short, whatever the extension.
TEST(WorkedSchedule, AChangeThatComesTooLateForTheExtensionCutsACycleShort) {
  for (const Duration extension : {0_us, 500_us}) {
    const GateControlList list(worked_entries, 1_ms), next(std::vector<GateControlEntry>{{set, 0x0F, 50_us}}, 50_us);
    GateSchedule gates = running_from_0(list, extension);
    const ConfigChange change = gates.request_change(at(3'250_us), {&next, at(4'400_us), 0_ns});
    EXPECT_EQ(change.config_change_time, at(4'400_us));
    EXPECT_FALSE(change.error_counted);
    EXPECT_TRUE(gates.config_pending(at(3'250_us)));
    EXPECT_EQ(gates.close_time(0, at(3'500_us)), at(4_ms));
    EXPECT_EQ(gates.gate_states(at(4'050_us)), 0x80);
    EXPECT_EQ(gates.gate_states(at(4'100_us)), 0x7F);
    EXPECT_EQ(gates.close_time(6, at(4'200_us)), at(4'400_us));
    EXPECT_EQ(gates.close_time(0, at(4'200_us)), never);  // the new list keeps it open
    EXPECT_EQ(gates.gate_states(at(4'400_us)), 0x0F);
    EXPECT_FALSE(gates.config_pending(at(4'400_us)));
    EXPECT_EQ(gates.oper_base_time(at(4'400_us)), at(4'400_us));
  }
}

// Asked before 3.0 ms: T = 4.4 <= 3.0 + 1.0 + 0.5, so the cycle from 3.0 on lasts until 4.4 with the last entry's
// gates.
TEST(WorkedSchedule, AChangeWithinReachOfTheExtensionStretchesTheLastCycle) {
  const GateControlList list(worked_entries, 1_ms), next(std::vector<GateControlEntry>{{set, 0x80, 50_us}}, 50_us);
  GateSchedule gates = running_from_0(list, 500_us);
  gates.request_change(at(2'900_us), {&next, at(4'400_us), 0_ns});
  EXPECT_EQ(gates.close_time(0, at(2'950_us)), at(3_ms));
  EXPECT_EQ(gates.window(0, at(3_ms)), (GateWindow{at(3'100_us), at(4'400_us)}));
  EXPECT_EQ(gates.gate_states(at(4'050_us)), 0x7F);
  EXPECT_FALSE(gates.holds(at(4'050_us)));
  // The stretched window takes a frame that no regular one does.
  EXPECT_TRUE(gates.may_start(0, at(4'050_us), 350_us).may_start);
  EXPECT_EQ(gates.may_start(0, at(4'050_us), 351_us), ask_again_at(never));
}

TEST(WorkedSchedule, ABaseTimeInThePastWhileAListRunsIsCounted) {
  const GateControlList list(worked_entries, 1_ms), next(std::vector<GateControlEntry>{{set, 0x01, 700_us}}, 700_us);
  GateSchedule gates = running_from_0(list);
  const ConfigChange change = gates.request_change(at(3'250_us), {&next, at(1_ms), 0_ns});
  EXPECT_EQ(change.config_change_time, at(3'800_us));  // 1 + 4 * 0.7 ms
  EXPECT_TRUE(change.error_counted);
  EXPECT_EQ(gates.config_change_error(), 1u);
}

TEST(GateSchedule, WithoutAListTheAdminGateStatesHold) {
  GateSchedule gates(0x05);
  EXPECT_EQ(gates.gate_states(at(1_s)), 0x05);
  EXPECT_EQ(gates.close_time(0, at(1_s)), never);
  EXPECT_EQ(gates.open_time(1, at(1_s)), never);
  EXPECT_TRUE(gates.may_start(0, at(1_s), 1_s).may_start);
  EXPECT_EQ(gates.may_start(1, at(1_s), 1_ns), ask_again_at(never));
  EXPECT_EQ(gates.next_change(at(1_s)), never);
  EXPECT_EQ(gates.open_share(0, at(1_s)), (OpenShare{1_ps, 1_ps}));
}

// Base -250 us, cycle 1 ms: the first start at or after 0 is 750 us; nothing ran, so nothing is counted.
TEST(GateSchedule, TheFirstListWaitsForItsCycle) {
  const GateControlList list(worked_entries, 1_ms);
  GateSchedule gates;
  const ConfigChange change = gates.request_change(at(0_ns), {&list, at(-250_us), 0_ns});
  EXPECT_EQ(change.config_change_time, at(750_us));
  EXPECT_FALSE(change.error_counted);
  EXPECT_EQ(gates.close_time(0, at(10_us)), at(750_us));
  EXPECT_EQ(gates.close_time(7, at(10_us)), at(850_us));  // open before, and in the first entry
  EXPECT_EQ(gates.may_start(0, at(749_us), 2_us), ask_again_at(at(850_us)));
  EXPECT_EQ(gates.gate_states(at(800_us)), 0x80);
}

// 30 of 100 us: the second entry stays for 80. 100 + 100 us in a cycle of 150: the third is never executed.
TEST(GateSchedule, AListMayBeShorterOrLongerThanItsCycle) {
  const GateControlList brief(std::vector<GateControlEntry>{{set, 1, 20_us}, {set, 2, 10_us}}, 100_us);
  EXPECT_EQ(running_from_0(brief).window(1, at(0_ns)), (GateWindow{at(20_us), at(100_us)}));
  EXPECT_EQ(brief.open_share(1), (OpenShare{80_us, 100_us}));
  const GateControlList lengthy(std::vector<GateControlEntry>{{set, 1, 100_us}, {set, 2, 100_us}, {set, 4, 100_us}},
                                150_us);
  EXPECT_EQ(running_from_0(lengthy).window(1, at(0_ns)), (GateWindow{at(100_us), at(150_us)}));
  EXPECT_EQ(running_from_0(lengthy).open_time(2, at(0_ns)), never);
  EXPECT_EQ(lengthy.open_share(2), (OpenShare{0_us, 150_us}));
  // But a stretched cycle goes on through the list: from 150 to 390 us all three entries have their turn.
  GateSchedule gates = running_from_0(lengthy, 100_us);
  gates.request_change(at(100_us), {&brief, at(390_us), 0_ns});
  EXPECT_EQ(gates.window(2, at(100_us)), (GateWindow{at(350_us), at(390_us)}));
}

TEST(GateSchedule, AnIntervalOfZeroIsOneTick) {
  const GateControlList list(std::vector<GateControlEntry>{{set, 1, 0_ns}, {set, 2, 10_us}}, 10_us);
  EXPECT_EQ(running_from_0(list).close_time(0, at(0_ns)), at(1_ns));
}

TEST(GateSchedule, ConsecutiveOpenEntriesAreOneWindowOverTheEndOfTheCycle) {
  const GateControlList list(std::vector<GateControlEntry>{{set, 3, 10_us}, {set, 2, 10_us}, {set, 3, 5_us}}, 25_us);
  GateSchedule gates = running_from_0(list);
  EXPECT_EQ(gates.window(0, at(12_us)), (GateWindow{at(20_us), at(35_us)}));
  EXPECT_EQ(list.longest_window(0), 15_us);
  EXPECT_EQ(gates.close_time(1, at(12_us)), never);
  EXPECT_EQ(list.longest_window(1), Duration::max());
  EXPECT_EQ(gates.may_start(0, at(24_us), 12_us), ask_again_at(at(45_us)));
  EXPECT_TRUE(gates.may_start(1, at(24_us), 10_s).may_start);
}

// Windows of 10 us each 100 us for 30 years of cycles; only the one that meets the new list's lasts longer.
TEST(GateSchedule, ALongFrameWaitsForTheChangeOfLists) {
  const GateControlList list(std::vector<GateControlEntry>{{set, 0, 90_us}, {set, 1, 10_us}}, 100_us);
  const GateControlList next(std::vector<GateControlEntry>{{set, 1, 40_us}, {set, 0, 60_us}}, 100_us);
  GateSchedule gates = running_from_0(list);
  gates.request_change(at(5_us), {&next, at(1'000'000_s), 0_ns});
  EXPECT_EQ(gates.may_start(0, at(95_us), 10_us), ask_again_at(at(190_us)));
  EXPECT_EQ(gates.may_start(0, at(95_us), 11_us), ask_again_at(at(1'000'000_s - 10_us)));
  EXPECT_EQ(gates.may_start(0, at(95_us), 50_us), ask_again_at(at(1'000'000_s - 10_us)));
  EXPECT_EQ(gates.may_start(0, at(95_us), 51_us), ask_again_at(never));
}

TEST(GateSchedule, AnotherRequestTakesThePlaceOfThePendingOne) {
  const GateControlList list(worked_entries, 1_ms), a(worked_entries, 2_ms), b(worked_entries, 3_ms);
  GateSchedule gates = running_from_0(list);
  gates.request_change(at(100_us), {&a, at(5_ms), 0_ns});
  gates.request_change(at(200_us), {&b, at(4_ms), 0_ns});
  EXPECT_EQ(gates.config_change_time(), at(4_ms));
  EXPECT_EQ(gates.oper_control_list(at(3'999_us)), &list);
  EXPECT_EQ(gates.oper_control_list(at(6_ms)), &b);
}

// The clock is set back by 30 us: the list goes on backwards.
TEST(GateSchedule, AClockThatIsSetBackFindsItsCycle) {
  const GateControlList list(worked_entries, 1_ms);
  GateSchedule gates = running_from_0(list);
  EXPECT_EQ(gates.gate_states(at(2'110_us)), 0x7F);
  EXPECT_EQ(gates.gate_states(at(2'080_us)), 0x80);
  EXPECT_EQ(gates.gate_states(at(-1_us)), 0x7F);
}

TEST(HoldAndRelease, TheRequestComesInAdvance) {
  const GateControlList list(worked_entries, 1_ms);
  GateSchedule gates = running_from_0(list);
  EXPECT_TRUE(gates.holds(at(0_ns)));
  EXPECT_EQ(gates.next_hold_change(at(0_ns)), at(100_us));
  EXPECT_EQ(gates.hold_request(at(50_us), 1'144_ns, 200_ns), (HoldRequest{true, at(99'800_ns)}));
  EXPECT_EQ(gates.hold_request(at(99'800_ns), 1'144_ns, 200_ns), (HoldRequest{false, at(1_ms - 1'144_ns)}));
  EXPECT_EQ(gates.hold_request(at(1_ms - 1'144_ns), 1'144_ns, 200_ns), (HoldRequest{true, at(1'099'800_ns)}));
  // A release that is shorter than the advance is none.
  EXPECT_EQ(gates.hold_request(at(1'050_us), 950_us, 0_us), (HoldRequest{true, never}));
}

// Each period joins the next, for as long as the list runs; a port that asks for each frame could not walk to there.
// Another list ends it after a minute.
TEST(HoldAndRelease, PeriodsThatJoinAreNotWalkedThrough) {
  const GateControlList joining(worked_entries, 1_ms);
  const GateControlList released(std::vector<GateControlEntry>{{release, 0xFF, 1_ms}}, 1_ms);
  GateSchedule gates = running_from_0(joining);
  for (int ask = 0; ask < 20'000; ++ask)
    ASSERT_EQ(gates.hold_request(at(50_us + 1_us * ask), 950_us, 0_us), (HoldRequest{true, never}));
  gates.request_change(at(30_ms), {&released, at(60'000_ms), {}});
  for (int ask = 0; ask < 20'000; ++ask)
    ASSERT_EQ(gates.hold_request(at(50_ms + 1_us * ask), 950_us, 0_us), (HoldRequest{true, at(59'999_ms + 100_us)}));
}

// SetGateStates leaves hold as it is: the first entry does not hold in the first cycle, and does from the second on.
TEST(HoldAndRelease, SetGateStatesLeavesItAsItIs) {
  const GateControlList list(std::vector<GateControlEntry>{{set, 1, 10_us}, {hold, 1, 10_us}, {set, 3, 10_us}}, 30_us);
  const GateControlList plain(std::vector<GateControlEntry>{{set, 1, 10_us}}, 10_us);
  GateSchedule gates = running_from_0(list);
  EXPECT_FALSE(gates.holds(at(5_us)));
  EXPECT_EQ(gates.next_hold_change(at(5_us)), at(10_us));
  EXPECT_TRUE(gates.holds(at(25_us)));
  EXPECT_TRUE(gates.holds(at(35_us)));
  EXPECT_EQ(gates.next_hold_change(at(35_us)), never);
  gates.request_change(at(40_us), {&plain, at(100_us), 0_ns});
  EXPECT_TRUE(gates.holds(at(200_us)));
}

TEST(GateControlList, AThousandEntriesAreFoundAtOnce) {
  std::vector<GateControlEntry> entries;
  for (int i = 0; i < 1024; ++i) entries.push_back({set, static_cast<GateStates>(i), 1_us});
  const GateControlList list(entries, 1'024_us);
  GateSchedule gates = running_from_0(list);
  for (int i = 0; i < 5'000; ++i) {
    const LocalTime now = at_ns(i * 777 + i / 1000 * 3'000'000);
    EXPECT_EQ(gates.gate_states(now), static_cast<GateStates>(now.ps() / 1'000'000 % 1024));
  }
}

// As many as 16 bits count: the last one is reached, names itself as what toggles the gate, and there is no further
// one.
TEST(GateControlList, TheGreatestNumberOfEntries) {
  std::vector<GateControlEntry> entries;
  for (std::size_t i = 0; i < CyclicIntervals::entry_limit; ++i)
    entries.push_back({set, static_cast<GateStates>(i % 2 == 0 ? 0x01 : 0x02), 1_us});
  const GateControlList list(entries, 65'536_us);
  GateSchedule gates = running_from_0(list);
  for (const std::int64_t us : {0, 1, 1'023, 1'024, 1'025, 65'534, 65'535, 65'536, 131'071})
    EXPECT_EQ(gates.gate_states(at_ns(us * 1'000)), us % 2 == 0 ? 0x01 : 0x02) << us;
  EXPECT_EQ(list.ahead(65'534, 0).toggled_by, 65'535u);
  EXPECT_EQ(list.ahead(65'535, 0).toggled_by, 0u);
  EXPECT_EQ(list.open_share(1), (OpenShare{32'768_us, 65'536_us}));
  entries.push_back({set, 1, 1_us});
  EXPECT_THROW(GateControlList(entries, 65'537_us), sim::InvariantBroken);
}

// ---- Against the state machines

struct TickEntry {
  GateOperation operation = set;
  GateStates gate_states = 0;
  Ns interval_ns = 0;
};
using Executor = test::ScheduleExecutor<TickEntry>;

/// What gates and hold are at one tick and each that follows, if no other change is requested.
struct Future {
  Ns now = 0;
  std::vector<GateStates> states;
  std::vector<bool> held;
  Ns end() const { return now + static_cast<Ns>(states.size()); }
  bool is_open(TrafficClass q, Ns time) const { return (states[static_cast<std::size_t>(time - now)] >> q & 1) != 0; }
};

/// The executor with what lasts longer than an entry.
struct Plant {
  Executor executor;
  GateStates admin_gate_states = 0;
  bool held = false;

  std::vector<Executor::Change> tick(Ns now, const std::vector<Executor::Config>& requests = {}) {
    const std::vector<Executor::Change> changes = executor.tick(now, requests);
    for (const TickEntry& entry : executor.drain_executed())
      if (entry.operation != set) held = entry.operation == hold;
    return changes;
  }
  GateStates states() const { return executor.running() ? executor.entry().gate_states : admin_gate_states; }
  Future future(Ns now, Ns length) const {
    Plant copy = *this;
    Future future;
    future.now = now;
    for (Ns time = now; time < now + length; ++time) {
      if (time > now) copy.tick(time);
      future.states.push_back(copy.states());
      future.held.push_back(copy.held);
    }
    return future;
  }
};

/// The answer is the first instant in [from, end) at which `holds_at` is true; or lies beyond what the future shows.
template <class Predicate>
void expect_first(const char* what, LocalTime answer, Ns from, Ns end, Predicate holds_at) {
  for (Ns time = from; time < end; ++time) {
    if (!holds_at(time)) continue;
    RC_LOG() << what << '\n';
    RC_ASSERT(answer.ps() == time * 1'000);
    return;
  }
  RC_LOG() << what << " (not in sight)\n";
  RC_ASSERT(answer.ps() >= end * 1'000);
}

void compare_with_future(GateSchedule& gates, const Future& future, Ns duration, Ns hold_advance, Ns release_advance) {
  const Ns now = future.now;
  RC_LOG() << "at " << now << '\n';
  RC_ASSERT(gates.gate_states(at_ns(now)) == future.states[0]);
  RC_ASSERT(gates.holds(at_ns(now)) == future.held[0]);
  expect_first("next_change", gates.next_change(at_ns(now)), now + 1, future.end(),
               [&](Ns time) { return future.states[static_cast<std::size_t>(time - now)] != future.states[0]; });
  expect_first("next_hold_change", gates.next_hold_change(at_ns(now)), now + 1, future.end(),
               [&](Ns time) { return future.held[static_cast<std::size_t>(time - now)] != future.held[0]; });
  for (TrafficClass q = 0; q < 3; ++q) {
    expect_first("close_time", gates.close_time(q, at_ns(now)), now, future.end(),
                 [&](Ns t) { return !future.is_open(q, t); });
    expect_first("open_time", gates.open_time(q, at_ns(now)), now, future.end(),
                 [&](Ns t) { return future.is_open(q, t); });
    const auto fits = [&](Ns start) {
      if (!future.is_open(q, start)) return false;
      for (Ns time = start; time < start + duration; ++time)
        if (!future.is_open(q, time)) return false;
      return true;
    };
    const StartAnswer answer = gates.may_start(q, at_ns(now), Duration::from_ps(duration * 1'000));
    RC_ASSERT(answer.may_start == fits(now));
    if (!answer.may_start) expect_first("ask_again", answer.ask_again, now + 1, future.end() - duration, fits);
    const GateWindow window = gates.window(q, at_ns(now));
    RC_ASSERT(window.from == gates.open_time(q, at_ns(now)));
    if (window.from != never && window.from < at_ns(future.end()))
      expect_first("window", window.until, window.from.ps() / 1'000, future.end(),
                   [&](Ns t) { return !future.is_open(q, t); });
  }
  // The MAC is asked to hold at t if a period that holds, advanced at both ends, covers t.
  std::vector<bool> asked(future.held.size(), false);
  for (std::size_t begin = 0; begin < asked.size(); ++begin) {
    if (!future.held[begin]) continue;
    std::size_t end = begin;
    while (end < asked.size() && future.held[end]) ++end;
    const Ns from = begin == 0 ? 0 : static_cast<Ns>(begin) - hold_advance;
    const Ns until = end == asked.size() ? static_cast<Ns>(end) : static_cast<Ns>(end) - release_advance;
    for (Ns t = std::max<Ns>(from, 0); t < until; ++t) asked[static_cast<std::size_t>(t)] = true;
    begin = end;
  }
  const HoldRequest request = gates.hold_request(at_ns(now), Duration::from_ps(hold_advance * 1'000),
                                                 Duration::from_ps(release_advance * 1'000));
  RC_ASSERT(request.hold == asked[0]);
  RC_ASSERT(request.until > at_ns(now));
  const Ns in_sight = static_cast<Ns>(asked.size()) - hold_advance - release_advance - 1;
  for (Ns t = 0; t < in_sight && at_ns(now + t) < request.until; ++t)
    RC_ASSERT(asked[static_cast<std::size_t>(t)] == request.hold);
  const Ns until = request.until.ps() / 1'000 - now;
  if (until < in_sight && hold_advance + release_advance == 0)
    RC_ASSERT(asked[static_cast<std::size_t>(until)] != request.hold);
}

// Found by the property below: a window that would begin when the next list, which is closed, takes over.
TEST(GateSchedule, AWindowThatBeginsWithTheNextListIsNone) {
  const std::vector<GateControlEntry> first = {{GateOperation::set_gate_states, 0, 6_ns},
                                               {GateOperation::set_gate_states, 1, 1_ns},
                                               {GateOperation::set_gate_states, 0, 1_ns}};
  const std::vector<GateControlEntry> second = {{GateOperation::set_gate_states, 0, 1_ns}};
  const GateControlList old_list(first, 10_ns), new_list(second, 6_ns);
  GateSchedule gates(0);
  gates.request_change(at_ns(0), {&old_list, at_ns(-32), {}});
  gates.request_change(at_ns(11), {&new_list, at_ns(14), {}});
  EXPECT_EQ(gates.may_start(0, at_ns(11), {}).ask_again, never);
}

TEST(GateSchedule, AnswersAsTheStateMachinesDo) {
  const bool passed = rc::check("gates against the executor", [] {
    struct Request {
      Ns time;
      Executor::Config config;
    };
    const auto number = [](Ns low, Ns high) { return *rc::gen::inRange<Ns>(low, high + 1); };
    std::vector<Request> requests;
    std::vector<GateControlList> lists;
    const Ns count = number(1, 5);
    lists.reserve(static_cast<std::size_t>(count));
    Ns time = 0;
    for (Ns i = 0; i < count; ++i) {
      Request request{time, {}};
      std::vector<GateControlEntry> entries;
      const Ns length = number(1, 6);
      for (Ns k = 0; k < length; ++k) {
        const TickEntry entry{static_cast<GateOperation>(number(0, 2)), static_cast<GateStates>(number(0, 7)),
                              number(0, 12)};
        request.config.list.push_back(entry);
        entries.push_back({entry.operation, entry.gate_states, Duration::from_ps(entry.interval_ns * 1'000)});
      }
      request.config.cycle_time = number(1, 40);
      request.config.base_time = number(0, 2) == 0 ? time + number(-60, 0) : time + number(0, 150);
      request.config.extension = number(0, 1) == 0 ? 0 : number(0, 90);
      RC_LOG() << "request at " << time << ": base " << request.config.base_time << ", cycle "
               << request.config.cycle_time << ", extension " << request.config.extension << ", list";
      for (const TickEntry& entry : request.config.list)
        RC_LOG() << ' ' << "SHR"[static_cast<int>(entry.operation)] << int{entry.gate_states} << ':'
                 << entry.interval_ns;
      RC_LOG() << '\n';
      lists.emplace_back(entries, Duration::from_ps(request.config.cycle_time * 1'000));
      requests.push_back(std::move(request));
      time += number(0, 3) == 0 ? 0 : number(0, 70);
    }
    const auto admin_gate_states = static_cast<GateStates>(number(0, 7));
    const Ns stride = number(1, 40), duration = number(0, 30), hold_advance = number(0, 8),
             release_advance = number(0, 4);

    Plant plant{{}, admin_gate_states, false};
    GateSchedule often(admin_gate_states), seldom(admin_gate_states);
    std::size_t next = 0;
    for (Ns now = 0; now < 350; ++now) {
      std::vector<Executor::Config> requested;
      for (; next < requests.size() && requests[next].time == now; ++next) requested.push_back(requests[next].config);
      const std::vector<Executor::Change> changes = plant.tick(now, requested);
      for (std::size_t i = 0; i < requested.size(); ++i) {
        const GateSchedule::AdminConfig admin{&lists[next - requested.size() + i], at_ns(requested[i].base_time),
                                              Duration::from_ps(requested[i].extension * 1'000)};
        const ConfigChange change = often.request_change(at_ns(now), admin);
        RC_ASSERT(change.config_change_time == at_ns(changes[i].config_change_time));
        RC_ASSERT(change.error_counted == changes[i].error_counted);
        seldom.request_change(at_ns(now), admin);
      }
      RC_ASSERT(often.gate_states(at_ns(now)) == plant.states());
      RC_ASSERT(often.gate_states(at_ns(now) + 999_ps) == plant.states());
      RC_ASSERT(often.config_pending(at_ns(now)) == plant.executor.config_pending());
      if (requested.empty() && now % stride != 0) continue;
      const Future future = plant.future(now, 280);
      compare_with_future(often, future, duration, hold_advance, release_advance);
      compare_with_future(seldom, future, duration, hold_advance, release_advance);
    }
  });
  EXPECT_TRUE(passed);
}

}  // namespace
}  // namespace takt::models::gate_control_list_test
