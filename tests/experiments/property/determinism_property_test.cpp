// SPDX-License-Identifier: Apache-2.0
// A run is a function of its scenario and its seed; nothing else has a say.
#include <gtest/gtest.h>

#include <thread>
#include <tuple>

#include "tests/experiments/property/random_network.hpp"

namespace takt::models::property {
namespace {

/// All that a run leaves behind.
struct Result {
  std::uint64_t digest = 0;
  std::uint64_t events = 0;
  using StreamResult =
      std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, decltype(Stream::dropped), std::vector<std::int64_t>>;
  std::vector<StreamResult> streams;
  std::vector<std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint32_t>> ports;
  std::vector<std::tuple<std::size_t, std::int64_t, std::uint32_t, std::uint64_t, std::size_t>> arrivals;
  bool operator==(const Result&) const = default;
};

std::vector<std::int64_t> statistics_of(const sim::Histogram& histogram) {
  if (histogram.empty()) return {};
  std::vector<std::int64_t> all = {histogram.minimum().ps(), histogram.maximum().ps(), histogram.mean().ps(),
                                   histogram.standard_deviation().ps()};
  histogram.for_each_bucket([&all](Duration lower, Duration, std::uint64_t n) {
    all.push_back(lower.ps());
    all.push_back(static_cast<std::int64_t>(n));
  });
  return all;
}

Result result_of(const Scenario& scenario, std::uint64_t seed, std::uint64_t tie_shuffle = 0,
                 sim::TraceSink* trace = nullptr) {
  LiveScenario live(scenario, seed, tie_shuffle);
  live.run.simulation.set_trace(trace);
  live.run.until(scenario_end);
  Result result;
  result.digest = live.run.digest();
  result.events = live.run.simulation.event_count();
  for (const Stream& stream : live.run.network->traffic().streams())
    result.streams.emplace_back(stream.sent, stream.copies, stream.delivered, stream.dropped,
                                statistics_of(stream.latency));
  for (std::uint32_t node = 0; node < scenario.plan.nodes.size(); ++node)
    for (const EgressPort& port : live.run.network->ports(NodeIndex{node}))
      result.ports.emplace_back(port.frames_sent(), port.wire_octets_sent(), port.frames_dropped(),
                                port.queues().peak_frames());
  for (std::size_t i = 0; i < live.listeners.size(); ++i)
    for (const Listener::Arrival& arrival : live.listeners[i]->arrivals)
      result.arrivals.emplace_back(i, arrival.time.ps(), arrival.stream.value, arrival.sequence, arrival.length);
  return result;
}

TEST(DeterminismProperty, TieShuffleChangesNothing) {
  EXPECT_TRUE(rc::check("results do not depend on the order of equal events", [] {
    const Scenario scenario = any_scenario();
    const Result plain = result_of(scenario, 1);
    for (int i = 0; i < 3; ++i) {
      const auto key = *rc::gen::arbitrary<std::uint64_t>().as("key of the shuffle");
      RC_ASSERT(result_of(scenario, 1, key | 1) == plain);
    }
  }));
}

TEST(DeterminismProperty, TheSameSeedIsTheSameRun) {
  EXPECT_TRUE(rc::check("a run can be repeated, with and without a recorder", [] {
    const Scenario scenario = any_scenario();
    const auto seed = *rc::gen::arbitrary<std::uint64_t>().as("seed of the simulation");
    TraceLog trace;
    const Result once = result_of(scenario, seed);
    RC_ASSERT(result_of(scenario, seed) == once);
    RC_ASSERT(result_of(scenario, seed, 0, &trace) == once);
  }));
}

// In steps of any length, and of any number of events, it is the same run.
TEST(DeterminismProperty, StepsChangeNothing) {
  EXPECT_TRUE(rc::check("a run may be interrupted between instants", [] {
    const Scenario scenario = any_scenario();
    const std::uint64_t expected = result_of(scenario, 1).digest;
    const auto most_events = *rc::gen::inRange<std::uint64_t>(1, 50).as("events of a step");
    const auto step = *rc::gen::inRange<std::int64_t>(1, 300).as("us of a step");
    LiveScenario live(scenario);
    live.run.network->start();
    for (Duration time; time < scenario_end;) {
      time = std::min(scenario_end, time + 1_us * step);
      while (!live.run.simulation.run(at(time), most_events)) continue;
      RC_ASSERT(live.run.simulation.now() == at(time));
    }
    RC_ASSERT(live.run.digest() == expected);
  }));
}

TEST(DeterminismProperty, SimulationsInThreadsAreIndependent) {
  EXPECT_TRUE(rc::check("two simulations side by side are as two alone", [] {
    const Scenario scenarios[2] = {any_scenario(), any_scenario()};
    const Result alone[2] = {result_of(scenarios[0], 1), result_of(scenarios[1], 2)};
    Result together[2];
    {
      std::thread other([&] { together[1] = result_of(scenarios[1], 2); });
      together[0] = result_of(scenarios[0], 1);
      other.join();
    }
    RC_ASSERT(together[0] == alone[0]);
    RC_ASSERT(together[1] == alone[1]);
  }));
}

}  // namespace
}  // namespace takt::models::property
