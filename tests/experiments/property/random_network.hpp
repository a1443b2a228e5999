// SPDX-License-Identifier: Apache-2.0
// Random networks with random traffic, and what a run of them leaves behind.
#pragma once

#include <rapidcheck.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "sim/random.hpp"
#include "tests/models/network_fixture.hpp"

namespace takt::models::property {

using namespace test;

/// A plan, and per host the frames that an application sends on top of the plan's talkers.
struct Scenario {
  NetworkPlan plan;
  std::vector<NodeIndex> hosts;
  std::vector<std::vector<Sender::Item>> items;  ///< by host, ascending times
};

/// Draws from small sets, so that things often happen at the same instant.
class ScenarioMaker {
 public:
  explicit ScenarioMaker(std::uint64_t seed) : chance_(seed, "property", "scenario") {}

  Scenario make(std::size_t bridges, bool ring, std::size_t hosts, std::size_t streams, std::size_t frames) {
    make_configs();
    std::vector<NodeIndex> bridge_nodes;
    for (std::size_t i = 0; i < bridges; ++i) {
      bridge_nodes.push_back(builder_.bridge("sw" + std::to_string(i), 500_ns * draw(4), any_config()));
      if (i > 0) link(bridge_nodes[ring ? i - 1 : below(i)], bridge_nodes[i]);
    }
    if (ring && bridges > 2) link(bridge_nodes.back(), bridge_nodes.front());
    for (std::size_t i = 0; i < hosts; ++i) {
      scenario_.hosts.push_back(builder_.host("host" + std::to_string(i),
                                              static_cast<std::uint32_t>(below(builder_.plan.os_latencies.size()))));
      builder_.plan.nodes.back().port_config = any_config();
      link(scenario_.hosts.back(), bridge_nodes[below(bridges)]);
    }
    scenario_.items.resize(hosts);
    for (std::size_t i = 0; i < streams; ++i) add_stream(frames);
    for (std::vector<Sender::Item>& items : scenario_.items)
      std::stable_sort(items.begin(), items.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
    scenario_.plan = builder_.plan;
    return scenario_;
  }

 private:
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(chance_.below(n)); }
  std::int64_t draw(std::uint64_t n) { return static_cast<std::int64_t>(chance_.below(n)); }
  std::uint32_t any_config() { return static_cast<std::uint32_t>(below(builder_.plan.port_configs.size())); }

  /// Queues without bound, short ones, mixed ones; one class, all classes. No latency, a fixed one, a random one.
  void make_configs() {
    constexpr std::uint32_t frame_limits[] = {0, 1, 2, 5, UINT32_MAX, UINT32_MAX};
    constexpr std::uint32_t octet_limits[] = {100, 2'000, UINT32_MAX, UINT32_MAX};
    for (int i = 0; i < 3; ++i) {
      PortConfig config;
      if (i == 1) config.traffic_class_of_priority = {0, 0, 0, 0, 3, 3, 7, 7};
      for (QueueLimit& limit : config.queue_limits) limit = {frame_limits[below(6)], octet_limits[below(4)]};
      builder_.port_config(config);
    }
    OsLatency fixed;
    fixed.transmit = sim::Distribution::constant(2_us);
    fixed.receive = sim::Distribution::constant(3_us);
    builder_.os_latency(fixed);
    OsLatency random;
    random.transmit = sim::Distribution::uniform(0_us, 20_us);
    random.receive = sim::Distribution::exponential(5_us);
    random.wake_up = sim::Distribution::uniform(0_us, 2_us);
    builder_.os_latency(random);
  }

  void link(NodeIndex a, NodeIndex b) {
    constexpr std::uint64_t rates[] = {10'000'000,    100'000'000,    1'000'000'000,  1'000'000'000,
                                       2'500'000'000, 10'000'000'000, 100'000'000'000};
    builder_.link(a, b, DataRate{rates[below(std::size(rates))]}, 50_ns * draw(3));
  }

  void add_stream(std::size_t frames) {
    const std::size_t talker = below(scenario_.hosts.size());
    std::vector<NodeIndex> listeners;
    const std::size_t wanted = 1 + (below(2) == 0 ? 0 : below(4));
    for (std::size_t i = 0; i < scenario_.hosts.size() && listeners.size() < wanted; ++i) {
      const std::size_t candidate = (talker + 1 + below(scenario_.hosts.size() - 1)) % scenario_.hosts.size();
      if (std::find(listeners.begin(), listeners.end(), scenario_.hosts[candidate]) == listeners.end())
        listeners.push_back(scenario_.hosts[candidate]);
    }
    StreamOptions options;
    if (below(4) != 0) options.priority = static_cast<Priority>(below(8));
    options.vlan = static_cast<VlanId>(below(3));
    const StreamIndex stream = builder_.stream(scenario_.hosts[talker], listeners, options);
    const Octets payload{static_cast<std::uint32_t>(below(3) == 0 ? 8 : below(1'501))};
    switch (below(5)) {
      case 0:
        builder_.talk(stream, payload,
                      PeriodicSchedule{1_us * draw(10), 10_us * (1 + draw(20)), below(2) == 0 ? 0_us : 10_us});
        break;
      case 1:
        builder_.talk(stream, payload, ExponentialSchedule{0_us, 1_us * (5 + draw(200))});
        break;
      case 2:
        builder_.talk(
            stream, payload,
            BurstSchedule{1_us * draw(10), 500_us, static_cast<std::uint32_t>(1 + below(20)), 672_ns * draw(2)});
        break;
      default:
        for (std::size_t i = 0; i < frames; ++i)
          scenario_.items[talker].push_back(
              {local((below(2) == 0 ? 672_ns : 1_us) * draw(1'000)), stream, 8 + below(1'493)});
    }
  }

  sim::RandomStream chance_;
  PlanBuilder builder_;
  Scenario scenario_;
};

/// Drawn by RapidCheck, so that a counter-example shrinks to few nodes, streams and frames.
inline Scenario any_scenario() {
  // RapidCheck begins with small numbers; resize lets it draw from the whole range at once.
  const auto below = [](std::size_t least, std::size_t end) {
    return rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::size_t>(least, end));
  };
  const auto bridges = *below(1, 8).as("bridges");
  const auto ring = *rc::gen::arbitrary<bool>().as("ring");
  const auto hosts = *below(2, 13).as("hosts");
  const auto streams = *below(1, 25).as("streams");
  const auto frames = *below(1, 101).as("frames of an application's stream");
  const auto seed = *rc::gen::arbitrary<std::uint64_t>().as("seed of the details");
  return ScenarioMaker(seed).make(bridges, ring, hosts, streams, frames);
}

/// A scenario in motion: on each host a sender and a listener to all streams meant for it.
struct LiveScenario {
  explicit LiveScenario(const Scenario& scenario, std::uint64_t seed = 1, std::uint64_t tie_shuffle = 0)
      : run(scenario.plan, seed, tie_shuffle) {
    for (std::size_t i = 0; i < scenario.hosts.size(); ++i) {
      install<Sender>(*run.network, scenario.hosts[i], "sender", scenario.items[i]);
      std::vector<StreamIndex> wanted;
      for (std::uint32_t s = 0; s < scenario.plan.streams.size(); ++s) {
        const std::vector<NodeIndex>& all = scenario.plan.streams[s].listeners;
        if (std::find(all.begin(), all.end(), scenario.hosts[i]) != all.end()) wanted.push_back({s});
      }
      listeners.push_back(&listen(*run.network, scenario.hosts[i], wanted));
    }
  }
  NetworkRun run;
  std::vector<const Listener*> listeners;  // by host
};

/// Long enough for the applications' frames to be sent; talkers go on for ever.
inline constexpr Duration scenario_end = 3_ms;

}  // namespace takt::models::property
