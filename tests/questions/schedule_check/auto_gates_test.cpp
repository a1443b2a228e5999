// SPDX-License-Identifier: Apache-2.0
// "gates": "auto" in scenarios that run: scheduled frames wait for nobody, whatever else the network carries.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "live_scenario.hpp"
#include "schedule_check/check.hpp"
#include "sim/random.hpp"

namespace takt::schedule_check::auto_gates_test {
namespace {

using namespace sim::literals;  // NOLINT
using scenario::Resolved;
using sim::Duration;

/// Three switches in a line at 1 Gb/s with 1 us each, two hosts at each; h1 to h5 and h4 to h1 are scheduled.
std::string line(const std::string& gates, const std::string& load, const std::string& os = R"("none")",
                 int from_us = 0, const std::string& more = "") {
  return fmt::format(R"({{"name": "t", "duration": "{}",
    "network": {{"generate": [{{"topology": "line", "switches": 3, "hosts_per_switch": 2, "forwarding_delay": "1us", "os": {}}}]}},
    "streams": [{{"name": "a", "from": "h1", "to": "h5", "payload": "100B", "every": "500us", "offset": "{}us", "pcp": 6}},
                {{"name": "b", "from": "h4", "to": "h1", "payload": "100B", "every": "250us", "offset": "{}us", "pcp": 5}}{}],
    "gates": {}{}}})",
                     from_us == 0 ? "100ms" : "7s", os, from_us + 10, from_us + 100, load, gates, more);
}
const std::string three_loads =
    R"(, {"name": "x", "from": "h2", "to": "h6", "payload": "1400B", "exponential": "30us", "pcp": 0},
    {"name": "y", "from": "h3", "to": "h5", "payload": "1000B", "exponential": "20us", "pcp": 3}, {"name": "z", "from": "h6", "to": "h1", "payload": "1400B", "exponential": "30us", "pcp": 7})";
const std::string both_classes = R"({"plan": "auto", "classes": [5, 6]})";

// The frame: 100 + 28 (IP, UDP) + 18 (MAC, FCS) + 4 (tag) + 8 (preamble) = 158 octets, 1264 ns. From h1 to h5 over four
// links of 50 ns and three switches, from h4 to h1 over three links and two switches.
TEST(AutoGates, LatencyIsTheSumOfTheDelays) {
  const Duration a = 4 * (1'264_ns + 50_ns) + 3 * 1_us;
  const Duration b = 3 * (1'264_ns + 50_ns) + 2 * 1_us;
  const auto gated = load_live(line(both_classes, three_loads));
  const results::RunResult result = run_live(*gated);
  EXPECT_EQ(stream_of(result, "a").delivered, 200u);
  EXPECT_EQ(stream_of(result, "a").latency->min, a);
  EXPECT_EQ(stream_of(result, "a").latency->max, a);
  EXPECT_EQ(stream_of(result, "b").delivered, 400u);
  EXPECT_EQ(stream_of(result, "b").latency->min, b);
  EXPECT_EQ(stream_of(result, "b").latency->max, b);
  EXPECT_GT(stream_of(result, "x").delivered, 2'000u) << "the others get what is left";
  EXPECT_GT(stream_of(result, "z").delivered, 2'000u) << "a more urgent class among them";
  const results::RunResult open = run_live(*load_live(line("\"none\"", three_loads)));
  EXPECT_GT(stream_of(open, "a").latency->max, a + 5_us) << "without gates it waits";
}

TEST(AutoGates, OtherTrafficMovesNothing) {
  const results::RunResult loaded = run_live(*load_live(line(both_classes, three_loads)));
  const results::RunResult alone = run_live(*load_live(line(both_classes, "")));
  for (const char* name : {"a", "b"}) {
    EXPECT_EQ(stream_of(loaded, name).latency->min, stream_of(alone, name).latency->min);
    EXPECT_EQ(stream_of(loaded, name).latency->max, stream_of(alone, name).latency->max);
  }
}

// What the operating system takes ends at the talker's gate: the latency is the longest there is, always.
TEST(AutoGates, TheOperatingSystemDoesNotShow) {
  const std::string os = R"({"transmit": {"uniform": {"from": "1us", "to": "20us"}}})";
  const results::RunResult result = run_live(*load_live(line(both_classes, three_loads, os)));
  EXPECT_EQ(stream_of(result, "a").latency->min, 20_us + 4 * (1'264_ns + 50_ns) + 3 * 1_us);
  EXPECT_EQ(stream_of(result, "a").latency->max, stream_of(result, "a").latency->min);
  EXPECT_GT(stream_of(run_live(*load_live(line("\"none\"", "", os))), "a").latency->max -
                stream_of(run_live(*load_live(line("\"none\"", "", os))), "a").latency->min,
            10_us);
}

// Real clocks, once they are synchronised: nobody waits for longer than two margins.
TEST(AutoGates, ClocksWithinTheMargin) {
  const std::string clocks =
      R"(, "seed": 2, "clocks": {"all": {"offset": {"from": "-50ppm", "to": "50ppm"}, "granularity": "8ns"}, "gptp": {"nodes": {"sw1": {"priority1": 100}}, "servo": "drift-tracking"}})";
  const std::string slow_load =
      R"(, {"name": "x", "from": "h2", "to": "h6", "payload": "1400B", "exponential": "60us", "pcp": 0})";
  const results::RunResult gated = run_live(*load_live(
      line(R"({"plan": "auto", "classes": [5, 6], "margin": "500ns"})", slow_load, "\"none\"", 6'000'000, clocks)));
  ASSERT_GT(stream_of(gated, "a").delivered, 1'900u);
  EXPECT_LE(stream_of(gated, "a").latency->max - stream_of(gated, "a").latency->min, 2 * 500_ns);
  EXPECT_GE(stream_of(gated, "a").latency->min, 4 * (1'264_ns + 50_ns) + 3 * 1_us - 2_ns);
}

// The copy has the lists, loads, and runs to the same digest.
TEST(AutoGates, TheResolvedCopyListsThem) {
  const auto original = load_live(line(both_classes, three_loads));
  const std::string copy = json::encode(original->scenario);
  EXPECT_NE(copy.find("\"listed\""), std::string::npos);
  const auto again = load_live(copy);
  EXPECT_EQ(again->scenario, original->scenario);
  EXPECT_FALSE(again->gates) << "nothing is laid out a second time";
  EXPECT_EQ(run_live(*again).digest, run_live(*original).digest);
}

// The ports run what was checked.
TEST(AutoGates, PortsHaveTheLists) {
  const auto resolved = load_live(line(both_classes, three_loads));
  ASSERT_TRUE(resolved->gates);
  EXPECT_TRUE(check(resolved->gates->problem, resolved->gates->schedule).empty());
  std::size_t gated = 0;
  for (const models::LinkPlan& link : resolved->plan.links)
    for (const models::LinkPlan::End* end : {&link.a, &link.b}) {
      const auto& gates =
          resolved->plan.port_configs[end->port_config.value_or(resolved->plan.nodes[end->node.value].port_config)]
              .shaping.gates;
      if (!gates) continue;
      ++gated;
      bool found = false;
      for (std::size_t p = 0; p < resolved->gates->problem.ports.size(); ++p) {
        const scenario::GatedPort& port = resolved->gates->problem.ports[p];
        if (port.node.value != end->node.value || port.port != end->port) continue;
        found = true;
        const scenario::GateList& list = resolved->gates->schedule.lists[p];
        ASSERT_EQ(gates->admin_control_list.size(), list.entries.size());
        EXPECT_EQ(gates->admin_cycle_time, list.cycle);
        for (std::size_t e = 0; e < list.entries.size(); ++e) {
          EXPECT_EQ(gates->admin_control_list[e].gate_states, list.entries[e].open);
          EXPECT_EQ(gates->admin_control_list[e].interval, list.entries[e].interval);
        }
      }
      EXPECT_TRUE(found);
    }
  EXPECT_EQ(gated, resolved->gates->problem.ports.size());
  EXPECT_EQ(gated, 7u) << "h1, sw1, sw2, sw3 to h5; h4, sw2, sw1 to h1";
}

// Random graphs, random streams, as many as fit; every listener alone, so that each has one latency.
TEST(AutoGates, RandomNetworks) {
  std::size_t scheduled = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    sim::RandomStream chance(seed, "network", "test");
    const std::uint64_t switches = 2 + chance.below(7);
    std::string streams;
    const auto text = [&](const std::string& more, bool with_load) {
      const std::string gap = seed % 3 == 0 ? "250us" : "25us";  // a tenth of the rate, a tenth of the frames
      const std::string load =
          with_load ? R"({"name": "x", "from": "h1", "to": "h2", "payload": "1400B", "exponential": ")" + gap +
                          R"(", "pcp": 1},
        {"name": "y", "from": "h3", "to": "h1", "payload": "700B", "exponential": ")" +
                          gap + R"(", "pcp": 7})"
                    : R"({"name": "x", "from": "h1", "to": "h2", "payload": "1400B", "exponential": "1s", "pcp": 1})";
      return fmt::format(
          R"({{"name": "t", "duration": "40ms", "network": {{"generate": [{{"topology": "random", "switches": {}, "degree": {}, "seed": {},
          "hosts_per_switch": 2, "forwarding_delay": "1.3us", "rate": "{}", "length": "37m"}}]}}, "streams": [{}{}], "gates": {{"plan": "auto", "classes": [4], "margin": "{}"}}}})",
          switches, switches == 2 ? 1.0 : 2.0, seed, seed % 3 == 0 ? "100Mbps" : "1Gbps", load, more,
          seed % 2 == 0 ? "0s" : "700ns");
    };
    std::vector<std::string> names;
    for (int i = 0; i < 12; ++i) {
      const std::uint64_t from = 1 + chance.below(2 * switches);
      const std::uint64_t to = 1 + chance.below(2 * switches);
      if (from == to) continue;
      const std::string one = fmt::format(
          R"(, {{"name": "s{}", "from": "h{}", "to": "h{}", "payload": "{}B", "every": "{}us", "offset": "{}us", "pcp": 4}})",
          i, from, to, 20 + chance.below(400), chance.below(2) == 0 ? 500 : 1'000, chance.below(900));
      std::string problems;
      if (load_live(text(streams + one, true), &problems)) {
        streams += one;
        names.push_back("s" + std::to_string(i));
      } else {
        EXPECT_NE(problems.find("windows that overlap"), std::string::npos) << problems;
      }
    }
    const auto resolved = load_live(text(streams, true));
    ASSERT_TRUE(resolved);
    EXPECT_TRUE(check(resolved->gates->problem, resolved->gates->schedule).empty());
    const results::RunResult loaded = run_live(*resolved);
    const results::RunResult alone = run_live(*load_live(text(streams, false)));
    for (const std::string& name : names) {
      ++scheduled;
      EXPECT_EQ(stream_of(loaded, name).latency->min, stream_of(loaded, name).latency->max)
          << name << ", seed " << seed;
      EXPECT_EQ(stream_of(loaded, name).latency->max, stream_of(alone, name).latency->max) << name << ", seed " << seed;
      EXPECT_EQ(stream_of(loaded, name).dropped_in_all(), 0u);
    }
  }
  EXPECT_GT(scheduled, 60u);
}

}  // namespace
}  // namespace takt::schedule_check::auto_gates_test
