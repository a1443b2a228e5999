// SPDX-License-Identifier: Apache-2.0
// Stream gates: the arithmetic of transmission gates with what a stream gate has instead of a mask.
#include "models/ingress/stream_gate_list.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/models/schedule_executor.hpp"

namespace takt::models::stream_gate_list_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
using test::Ns;

constexpr LocalTime at(Duration since_start) { return LocalTime() + since_start; }
constexpr LocalTime at_ns(Ns ns) { return LocalTime::from_ps(ns * 1'000); }

// Cyclic queuing (Annex T): in turn, intervals of 125 us send to priority 3 and to priority 4.
TEST(StreamGate, CyclicQueuingAlternatesThePriority) {
  const std::vector<StreamGateEntry> entries = {{true, Priority{3}, 125_us, {}}, {true, Priority{4}, 125_us, {}}};
  const StreamGateList list(entries, 250_us);
  StreamGateSchedule gate;
  EXPECT_EQ(gate.state(at(0_us)).ipv, std::nullopt);
  gate.request_change(at(0_us), {&list, at(0_us), 0_ns});
  EXPECT_EQ(gate.state(at(0_us)).ipv, Priority{3});
  EXPECT_EQ(gate.state(at(125_us) - 1_ps).ipv, Priority{3});
  EXPECT_EQ(gate.state(at(125_us)).ipv, Priority{4});
  EXPECT_EQ(gate.next_operation(at(125_us)), at(250_us));
  EXPECT_EQ(gate.state(at(1'000'130_us)), (StreamGateState{true, Priority{4}, std::nullopt, at(1'000'125_us)}));
}

TEST(StreamGate, BeforeTheFirstListItIsAsManagementSays) {
  const StreamGateList list(std::vector<StreamGateEntry>{{true, {}, 10_us, {}}}, 10_us);
  StreamGateSchedule gate(false, Priority{6});
  gate.request_change(at(0_us), {&list, at(30_us), 0_ns});
  EXPECT_FALSE(gate.state(at(29_us)).open);
  EXPECT_EQ(gate.state(at(29_us)).ipv, Priority{6});
  EXPECT_EQ(gate.next_operation(at(29_us)), at(30_us));
  EXPECT_TRUE(gate.state(at(30_us)).open);
}

// 1000 octets an interval: 600 + 400 pass, one more does not, and the next interval begins anew. A refused frame takes
// nothing.
TEST(StreamGate, OctetsAreCountedForEachRunOfAnEntry) {
  const StreamGateList list(std::vector<StreamGateEntry>{{true, {}, 10_us, 1'000u}, {true, {}, 10_us, {}}}, 20_us);
  StreamGateSchedule gate;
  gate.request_change(at(0_us), {&list, at(0_us), 0_ns});
  IntervalOctets octets;
  EXPECT_TRUE(octets.take(gate.state(at(1_us)), 600));
  EXPECT_FALSE(octets.take(gate.state(at(2_us)), 401));
  EXPECT_TRUE(octets.take(gate.state(at(3_us)), 400));
  EXPECT_FALSE(octets.take(gate.state(at(9_us)), 1));
  EXPECT_TRUE(octets.take(gate.state(at(10_us)), 100'000));
  EXPECT_TRUE(octets.take(gate.state(at(20_us)), 1'000));
  EXPECT_FALSE(octets.take(gate.state(at(29_us)), 1));
  EXPECT_TRUE(octets.take(gate.state(at(40_us)), 1));
}

// 10 of 100 us are in the list: its only entry stays for the cycle, one run a cycle.
TEST(StreamGate, AnEntryThatStaysIsTheSameRun) {
  const StreamGateList list(std::vector<StreamGateEntry>{{true, {}, 10_us, 50u}}, 100_us);
  StreamGateSchedule gate;
  gate.request_change(at(0_us), {&list, at(0_us), 0_ns});
  EXPECT_EQ(gate.state(at(99_us)).interval_start, at(0_us));
  EXPECT_EQ(gate.state(at(100_us)).interval_start, at(100_us));
}

struct TickEntry {
  int number = 0;
  Ns interval_ns = 0;
};
using Executor = test::ScheduleExecutor<TickEntry>;

TEST(StreamGate, ExecutesAsTheStateMachinesDo) {
  const bool passed = rc::check("a stream gate against the executor", [] {
    const auto number = [](Ns low, Ns high) { return *rc::gen::inRange<Ns>(low, high + 1); };
    std::vector<std::pair<Ns, Executor::Config>> requests;
    std::vector<StreamGateList> lists;
    Ns time = 0;
    for (Ns i = 0, count = number(1, 5); i < count; ++i) {
      Executor::Config config;
      std::vector<StreamGateEntry> entries;
      for (Ns k = 0, length = number(1, 6); k < length; ++k) {
        config.list.push_back({static_cast<int>(16 * i + k), number(0, 12)});
        entries.push_back({k % 2 == 0, Priority{static_cast<Priority>(k)},
                           Duration::from_ps(config.list.back().interval_ns * 1'000),
                           static_cast<std::uint32_t>(16 * i + k)});
      }
      config.cycle_time = number(1, 40);
      config.base_time = number(0, 2) == 0 ? time + number(-60, 0) : time + number(0, 150);
      config.extension = number(0, 1) == 0 ? 0 : number(0, 90);
      RC_LOG() << "request at " << time << ": base " << config.base_time << ", cycle " << config.cycle_time
               << ", extension " << config.extension << '\n';
      lists.emplace_back(entries, Duration::from_ps(config.cycle_time * 1'000));
      requests.emplace_back(time, std::move(config));
      time += number(0, 3) == 0 ? 0 : number(0, 70);
    }
    Executor executor;
    StreamGateSchedule gate;
    LocalTime next_operation = at_ns(0);
    std::size_t next = 0;
    for (Ns now = 0; now < 400; ++now) {
      std::vector<Executor::Config> requested;
      const std::size_t first = next;
      for (; next < requests.size() && requests[next].first == now; ++next) requested.push_back(requests[next].second);
      executor.tick(now, requested);
      for (std::size_t i = first; i < next; ++i)
        gate.request_change(at_ns(now), {&lists[i], at_ns(requests[i].second.base_time),
                                         Duration::from_ps(requests[i].second.extension * 1'000)});
      const bool operates = !executor.drain_executed().empty();
      const StreamGateState state = gate.state(at_ns(now));
      RC_LOG() << "at " << now << '\n';
      if (!executor.running()) {
        RC_ASSERT(!state.interval_octet_max.has_value());
      } else {
        RC_ASSERT(state.interval_octet_max == static_cast<std::uint32_t>(executor.entry().number));
        RC_ASSERT(state.interval_start == at_ns(executor.executed_at()));
        if (requested.empty()) RC_ASSERT(operates == (next_operation == at_ns(now)));
      }
      next_operation = gate.next_operation(at_ns(now));
    }
  });
  EXPECT_TRUE(passed);
}

}  // namespace
}  // namespace takt::models::stream_gate_list_test
