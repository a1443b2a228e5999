// SPDX-License-Identifier: Apache-2.0
// "gates": "auto" for redundant streams: each copy finds its windows on its own way, and behind a merge whichever copy
// comes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "live_scenario.hpp"
#include "schedule_check/check.hpp"
#include "sim/random.hpp"

namespace takt::schedule_check::redundant_gates_test {
namespace {

using namespace sim::literals;  // NOLINT
using scenario::Resolved;
using sim::Duration;

Duration bound_of(const Resolved& resolved, const std::string& name) {
  for (const analysis::StreamBound& each : analysis::bound(resolved).streams)
    if (each.name == name) return each.latency.value_or(Duration::max());
  throw std::runtime_error("no stream " + name);
}

/// Each switch of a ring has a host and forwards in 1 us; links of 50 m at 1 Gb/s take 250 ns. Beside what is scheduled
/// there is load in classes below and above.
std::string ring(int switches, const std::string& streams, const std::string& more = "",
                 const std::string& margin = "0s") {
  return fmt::format(
      R"({{"name": "t", "duration": "40ms", "network": {{"generate": [{{"topology": "ring", "switches": {}, "forwarding_delay": "1us", "length": "50m"}}]}},
    "gates": {{"plan": "auto", "classes": [6], "margin": "{}"}},
    "streams": [{}, {{"name": "x", "from": "h2", "to": "h3", "payload": "1400B", "exponential": "30us", "pcp": 0}},
                {{"name": "y", "from": "h4", "to": "h3", "payload": "1400B", "exponential": "40us", "pcp": 7}}]{}}})",
      switches, margin, streams, more);
}
const std::string control =
    R"({"name": "control", "from": "h1", "to": "h3", "payload": "100B", "every": "250us", "offset": "auto", "pcp": 6, "redundancy": 2})";
const std::string other =
    R"(, {"name": "other", "from": "h2", "to": "h3", "payload": "300B", "every": "500us", "offset": "auto", "pcp": 6})";

/// 158 octets on the wire from the host and to it, 6 more for the R-TAG from the switch that splits to the one that
/// merges.
Duration way(int links_between) {
  return 2 * (1'264_ns + 250_ns) + links_between * (1'312_ns + 250_ns) + (links_between + 1) * 1_us;
}

TEST(RedundantGates, EitherWayHasItsWindows) {
  const auto resolved = load_live(ring(8, control + other));
  EXPECT_TRUE(check(resolved->gates->problem, resolved->gates->schedule).empty());
  const results::RunResult whole = run_live(*resolved);
  EXPECT_EQ(stream_of(whole, "control").latency->min, way(2));
  EXPECT_EQ(stream_of(whole, "control").latency->max, way(2));
  EXPECT_EQ(bound_of(*resolved, "control"), way(6)) << "a copy may be lost, and then the other one counts";
  EXPECT_EQ(bound_of(*resolved, "other"), stream_of(whole, "other").latency->max);
  const auto broken = load_live(
      ring(8, control + other, R"(, "faults": [{"kind": "link-down", "link": ["sw1", "sw2"], "at": "20.05ms"}])"));
  const results::RunResult half = run_live(*broken);
  EXPECT_EQ(stream_of(half, "control").delivered, 160u);
  EXPECT_EQ(stream_of(half, "control").lost, 0u);
  EXPECT_EQ(stream_of(half, "control").latency->max, way(6)) << "no window later";
  EXPECT_EQ(bound_of(*broken, "control"), way(6));
}

TEST(RedundantGates, WaysOfOneLengthShareAWindow) {
  const auto resolved = load_live(ring(4, control));
  EXPECT_TRUE(check(resolved->gates->problem, resolved->gates->schedule).empty());
  EXPECT_EQ(bound_of(*resolved, "control"), way(2));
  for (const char* link : {R"(["sw1", "sw2"])", R"(["sw3", "sw4"])"}) {
    const auto broken = load_live(
        ring(4, control, fmt::format(R"(, "faults": [{{"kind": "link-down", "link": {}, "at": "20.05ms"}}])", link)));
    EXPECT_EQ(stream_of(run_live(*broken), "control").latency->max, way(2)) << link;
  }
}

// Two hosts with two cables each, by switches that the copies need not share: nobody merges but the listener.
TEST(RedundantGates, CopiesThatTheTalkerSends) {
  const std::string text =
      R"({"name": "t", "duration": "40ms", "network": {"nodes": {"t": {"kind": "host"}, "l": {"kind": "host"}, "x": {"kind": "host"},
      "a": {"kind": "switch", "forwarding_delay": "1us"}, "b": {"kind": "switch", "forwarding_delay": "1us"}, "c": {"kind": "switch", "forwarding_delay": "1us"}},
      "links": [{"ends": ["t", "a"], "rate": "1Gbps"}, {"ends": ["t", "b"], "rate": "1Gbps"}, {"ends": ["b", "c"], "rate": "1Gbps"}, {"ends": ["a", "l"], "rate": "1Gbps"},
                {"ends": ["c", "l"], "rate": "1Gbps"}, {"ends": ["x", "a"], "rate": "1Gbps"}]},
    "gates": {"plan": "auto", "classes": [6]},
    "streams": [{"name": "control", "from": "t", "to": "l", "payload": "100B", "every": "250us", "offset": "auto", "pcp": 6, "redundancy": 2},
                {"name": "x", "from": "x", "to": "l", "payload": "1400B", "exponential": "30us", "pcp": 0}]})";
  const auto resolved = load_live(text);
  EXPECT_TRUE(check(resolved->gates->problem, resolved->gates->schedule).empty());
  const results::RunResult result = run_live(*resolved);
  const results::StreamResult& found = stream_of(result, "control");
  EXPECT_EQ(found.latency->min, found.latency->max);
  EXPECT_LT(found.latency->max, bound_of(*resolved, "control")) << "the longer way is one hop longer";
}

// The master says its state and its data, each twice, over one cable: four frames in a row, which part behind the first
// switch.
TEST(RedundantGates, ProgramsWhoseMessagesGoTwice) {
  const auto text = [](const char* slaves) {
    return fmt::format(
        R"({{"name": "t", "duration": "40ms", "network": {{"generate": [{{"topology": "ring", "switches": 6, "forwarding_delay": "1us", "length": "50m"}}]}},
    "gates": {{"plan": "auto"}}, "programs": [{{"name": "p", "master": "h1", "slaves": {}, "cycle": "500us", "offset": "auto", "redundancy": 2,
      "process_data": [{{"name": "forth", "from": "h1", "fields": {{"values": {{"type": "Double", "count": 20}}}}}}]}}],
    "streams": [{{"name": "x", "from": "h4", "to": "h6", "payload": "1400B", "exponential": "30us", "pcp": 0}}]}})",
        slaves);
  };
  const auto resolved = load_live(text(R"(["h2", "h6"])"));
  EXPECT_TRUE(check(resolved->gates->problem, resolved->gates->schedule).empty());
  const results::RunResult result = run_live(*resolved);
  for (const char* name : {"p/state/h1", "p/state/h2", "p/state/h6", "p/forth"}) {
    EXPECT_LE(stream_of(result, name).latency->max, bound_of(*resolved, name)) << name;
    EXPECT_LT(bound_of(*resolved, name), 30_us) << name << ": no copy waits for the next turn";
  }
  // The state that has gone the long way round and the data that have come the short way meet at one port, whatever the
  // offsets.
  std::string problems;
  EXPECT_FALSE(load_live(text(R"(["h3", "h5"])"), &problems));
  EXPECT_NE(problems.find("windows that overlap"), std::string::npos) << problems;
}

TEST(RedundantGates, WhatIsWrongWithAWindowIsFound) {
  const auto resolved = load_live(ring(8, control + other));
  const scenario::GateProblem& problem = resolved->gates->problem;
  std::size_t merged = 0;
  for (std::size_t h = 0; h < problem.streams[0].hops.size(); ++h) {
    if (!problem.streams[0].hops[h].is_merged) continue;
    ++merged;
    scenario::GateSolution moved = resolved->gates->schedule;
    scenario::StreamWindow& window = moved.windows[0][h];
    window = {window.start + 1_us, window.open + 1_us, window.close + 1_us};
    EXPECT_FALSE(check(problem, moved).empty()) << h;
    scenario::GateSolution closed = resolved->gates->schedule;
    for (scenario::GateList::Entry& entry : closed.lists[problem.streams[0].hops[h].port].entries)
      if (entry.open == 1u << 6) entry.open = 0;
    EXPECT_FALSE(check(problem, closed).empty()) << h;
  }
  EXPECT_EQ(merged, 2u) << "from the last switch to the host, as the first copy and as the second";
}

TEST(RedundantGates, ALadderIsRefused) {
  std::string problems;
  EXPECT_FALSE(load_live(
      ring(
          6,
          R"({"name": "control", "from": "h1", "to": "h3", "payload": "100B", "every": "250us", "offset": "auto", "pcp": 6,
    "redundancy": {"ladder": true, "paths": [["h1", "sw1", "sw2", "sw3", "h3"], ["h1", "sw1", "sw6", "sw5", "sw4", "sw3", "h3"]]}})"),
      &problems));
  EXPECT_NE(problems.find("ladder"), std::string::npos) << problems;
}

// Random rings, streams and margins; each link between switches is cut once. What is bounded is never exceeded, and no
// frame waits for another turn.
TEST(RedundantGates, RandomRings) {
  std::size_t scheduled = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    sim::RandomStream chance(seed, "ring", "test");
    const int switches = 4 + static_cast<int>(chance.below(5));
    const std::string margin = seed % 3 == 0 ? "300ns" : "0s";
    std::string streams;
    std::vector<std::string> names;
    for (int i = 0; i < 5; ++i) {
      const std::uint64_t from = 1 + chance.below(static_cast<std::uint64_t>(switches));
      const std::uint64_t to = 1 + chance.below(static_cast<std::uint64_t>(switches));
      if (from == to) continue;
      const std::string one = fmt::format(
          R"({}{{"name": "s{}", "from": "h{}", "to": "h{}", "payload": "{}B", "every": "{}us", "offset": "auto", "pcp": 6{}}})",
          streams.empty() ? "" : ", ", i, from, to, 40 + chance.below(600), chance.below(2) == 0 ? 250 : 500,
          chance.below(3) == 0 ? "" : R"(, "redundancy": 2)");
      std::string problems;
      if (!load_live(ring(switches, streams + one, "", margin), &problems)) {
        EXPECT_NE(problems.find("no offset found"), std::string::npos) << problems;
        continue;
      }
      streams += one;
      names.push_back("s" + std::to_string(i));
    }
    ASSERT_FALSE(names.empty());
    for (int cut = 0; cut <= switches; ++cut) {  // 0: none
      const std::string fault =
          cut == 0 ? ""
                   : fmt::format(R"(, "faults": [{{"kind": "link-down", "link": ["sw{}", "sw{}"], "at": "0s"}}])", cut,
                                 cut % switches + 1);
      const auto resolved = load_live(ring(switches, streams, fault, margin));
      ASSERT_TRUE(resolved);
      EXPECT_TRUE(check(resolved->gates->problem, resolved->gates->schedule).empty());
      const results::RunResult result = run_live(*resolved);
      for (const std::string& name : names) {
        const results::StreamResult& found = stream_of(result, name);
        if (!found.latency) continue;  // a stream without redundancy, cut
        ++scheduled;
        EXPECT_EQ(found.latency->min, found.latency->max) << name << ", seed " << seed << ", cut " << cut;
        EXPECT_LE(found.latency->max, bound_of(*resolved, name)) << name << ", seed " << seed << ", cut " << cut;
        EXPECT_LT(bound_of(*resolved, name), 100_us) << name << ", seed " << seed << ", cut " << cut;
      }
    }
  }
  EXPECT_GT(scheduled, 150u);
}

}  // namespace
}  // namespace takt::schedule_check::redundant_gates_test
