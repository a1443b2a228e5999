// SPDX-License-Identifier: Apache-2.0
// "offset": "auto" in scenarios that run: where it fits no frame waits, with gates and without.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "live_scenario.hpp"
#include "models/ethernet/sizes.hpp"
#include "schedule_check/check.hpp"
#include "sim/random.hpp"

namespace takt::schedule_check::auto_offsets_test {
namespace {

using namespace sim::literals;  // NOLINT
using scenario::Resolved;
using sim::Duration;

struct Loaded {
  std::unique_ptr<Resolved> resolved;
  std::string problems;
};
Loaded load(const std::string& text, const std::vector<std::string>& overrides = {}) {
  json::Diagnostics diagnostics;
  Loaded loaded;
  loaded.resolved = scenario::load_text(text, "s.json", overrides, diagnostics);
  loaded.problems = diagnostics.to_text();
  return loaded;
}
/// The way of each frame if nothing holds it up, the quickest and the slowest of all listeners: hops of one rate,
/// cables of 50 ns, switches that take `forwarding`. Not of redundant streams, whose copies are longer.
struct Alone {
  Duration least = Duration::max();
  Duration most;
};
Alone alone(const Resolved& r, std::size_t stream, Duration octet, Duration forwarding) {
  const models::StreamPlan& plan = r.plan.streams[stream];
  const Duration frame =
      octet * (8 + std::max<std::int64_t>(
                       64, (plan.headers + r.streams[stream].largest_payload).count + 18 + (plan.priority ? 4 : 0)));
  std::map<std::uint32_t, Duration> of_listeners;
  for (const scenario::Path& path : r.streams[stream].paths) {
    const auto hops = static_cast<std::int64_t>(path.size()) - 1;
    const Duration way = (frame + 50_ns) * hops + forwarding * (hops - 1);
    const auto [known, is_new] = of_listeners.emplace(path.back(), way);
    known->second = std::min(known->second, way);
  }
  Alone made;
  for (const auto& [listener, way] : of_listeners) {
    made.least = std::min(made.least, way);
    made.most = std::max(made.most, way);
  }
  return made;
}
void expect_nobody_waits(const Resolved& r, Duration octet, Duration forwarding) {
  const results::RunResult result = run_live(r);
  for (std::size_t s = 0; s < result.streams.size(); ++s) {
    SCOPED_TRACE(result.streams[s].name);
    ASSERT_TRUE(result.streams[s].latency);
    const Alone way = alone(r, s, octet, forwarding);
    EXPECT_EQ(result.streams[s].latency->min.ps(), way.least.ps());
    EXPECT_EQ(result.streams[s].latency->max.ps(), way.most.ps());
  }
}

// Thirty streams around a ring, with periods of 250 us, 500 us and 1 ms.
TEST(AutoOffsets, ThirtyStreams) {
  for (const bool is_gated : {true, false}) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(
        std::string(TAKT_SOURCE_DIR) + "/scenarios/tsn/thirty-streams.json",
        is_gated ? std::vector<std::string>{} : std::vector<std::string>{"gates=\"none\""}, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    EXPECT_EQ(diagnostics.warnings(), 0u) << diagnostics.to_text();
    EXPECT_EQ(resolved->gates.has_value(), is_gated);
    if (is_gated) {
      EXPECT_TRUE(check(resolved->gates->problem, resolved->gates->schedule).empty());
    }
    EXPECT_EQ(resolved->chosen_offsets.size(), 30u);
    expect_nobody_waits(*resolved, 8_ns, 1_us);
  }
}

std::string two(const std::string& offset, const std::string& more) {
  return fmt::format(
      R"({{"name": "t", "duration": "20ms", "network": {{"generate": [{{"topology": "line", "switches": 1, "hosts_per_switch": 4, "forwarding_delay": "1us"}}]}},
    "streams": [{{"name": "a", "from": "h1", "to": "h3", "payload": "100B", "every": "500us", "offset": "0us", "pcp": 6}},
                {{"name": "b", "from": "h2", "to": "h3", "payload": "100B", "every": "500us", "offset": {}, "pcp": 6}}]{}}})",
      offset, more);
}

// 100 + 28 + 18 + 4 octets and 8 of preamble are 1264 ns, with the gap 1360 ns: then b is clear of a on the way to h3.
TEST(AutoOffsets, WhatIsChosenIsWritten) {
  for (const std::string gates : {"", R"(, "gates": {"plan": "auto", "classes": [6]})"}) {
    const Loaded loaded = load(two("\"auto\"", gates));
    ASSERT_TRUE(loaded.resolved) << loaded.problems;
    EXPECT_EQ(loaded.problems, "");
    EXPECT_EQ(*loaded.resolved->scenario.streams[1].offset, 1'360_ns);
    const std::string copy = json::encode(loaded.resolved->scenario);
    EXPECT_EQ(copy.find("\"offset\": \"auto\""), std::string::npos);
    EXPECT_NE(copy.find("1.36us"), std::string::npos);
    const Loaded again = load(copy);
    ASSERT_TRUE(again.resolved) << again.problems;
    EXPECT_EQ(again.resolved->scenario, loaded.resolved->scenario);
    EXPECT_EQ(run_live(*again.resolved).digest, run_live(*loaded.resolved).digest);
    const Loaded by_number = load(two("\"1.36us\"", gates));
    EXPECT_EQ(run_live(*by_number.resolved).digest, run_live(*loaded.resolved).digest)
        << "it is as if the number had been there";
    expect_nobody_waits(*loaded.resolved, 8_ns, 1_us);
  }
}

TEST(AutoOffsets, AnOverrideMaySayIt) {
  const Loaded loaded = load(two("\"0us\"", ""), {"streams.1.offset=auto"});
  ASSERT_TRUE(loaded.resolved) << loaded.problems;
  EXPECT_EQ(*loaded.resolved->scenario.streams[1].offset, 1'360_ns);
}

// A stream outside of the scheduled class gets out of the way of the windows, too.
TEST(AutoOffsets, BesideWindows) {
  std::string text = two("\"auto\"", R"(, "gates": {"plan": "auto", "classes": [6]})");
  text.replace(text.rfind("\"pcp\": 6"), 8, "\"pcp\": 3");
  const Loaded loaded = load(text);
  ASSERT_TRUE(loaded.resolved) << loaded.problems;
  EXPECT_EQ(*loaded.resolved->scenario.streams[1].offset, 1'360_ns);
  expect_nobody_waits(*loaded.resolved, 8_ns, 1_us);
}

std::string program(const std::string& more, const std::string& keys) {
  return fmt::format(
      R"({{"name": "t", "duration": "50ms", "network": {{"generate": [{{"topology": "line", "switches": 1, "hosts_per_switch": 4, "forwarding_delay": "1us"}}]}},
    "programs": [{{"name": "p", "master": "h1", "slaves": ["h2", "h3", "h4"], "cycle": "500us", "subscription": "all-to-all"{}}}], "script": [{{"at": "5ms", "program": "p", "call": "Start"}}]{}}})",
      keys, more);
}

// Each participant has a phase of its own; one that has one already keeps it.
TEST(AutoOffsets, Programs) {
  for (const std::string gates : {"", R"(, "gates": "auto")"}) {
    for (const std::string phases : {"", R"(, "phases": {"h3": "0us"})"}) {
      const Loaded loaded = load(program(
          gates,
          R"(, "offset": "auto", "process_data": [{"name": "d", "from": "h2", "fields": {"x": {"type": "Double", "count": 20}}}])" +
              phases));
      ASSERT_TRUE(loaded.resolved) << loaded.problems;
      EXPECT_EQ(loaded.problems, "");
      std::set<Duration> different;
      for (const char* const name : {"h1", "h2", "h3", "h4"})
        different.insert(plant::phase_of(loaded.resolved->scenario.programs[0], name));
      EXPECT_EQ(different.size(), 4u);
      EXPECT_EQ(loaded.resolved->chosen_offsets.size(), phases.empty() ? 4u : 3u);
      if (!phases.empty()) {
        EXPECT_EQ(plant::phase_of(loaded.resolved->scenario.programs[0], "h3"), Duration());
      }
      const results::RunResult result = run_live(*loaded.resolved);
      for (std::size_t s = 0; s < result.streams.size(); ++s) {
        if (result.streams[s].name.find("/state/") == std::string::npos)
          continue;  // data waits for its own participant's state
        const Alone way = alone(*loaded.resolved, s, 8_ns, 1_us);
        EXPECT_EQ(result.streams[s].latency->min.ps(), way.least.ps()) << result.streams[s].name;
        EXPECT_EQ(result.streams[s].latency->max.ps(), way.most.ps()) << result.streams[s].name;
      }
      EXPECT_TRUE(load(json::encode(loaded.resolved->scenario)).resolved);
    }
  }
}

// With roles one phase for all that may publish. A frame of a takes 1264 ns, with its gap 1360; the shortest frame,
// which has the state, 576 ns. At the switch a is 688 ns behind a state that left with it, and keeps the port for 1360
// ns: the state must leave 2048 ns later.
TEST(AutoOffsets, ProgramsWithRoles) {
  const Loaded loaded = load(
      R"({"name": "t", "duration": "20ms", "network": {"nodes": {"sw": {"kind": "switch"}, "h1": {"kind": "host"}, "h2": {"kind": "host", "offers": ["weld"]}, "h3": {"kind": "host", "offers": ["weld"]}},
      "links": [{"ends": ["sw", "h1"]}, {"ends": ["sw", "h2"]}, {"ends": ["sw", "h3"]}]},
    "streams": [{"name": "a", "from": "h2", "to": "h1", "payload": "100B", "every": "500us", "offset": "0us", "pcp": 6}],
    "programs": [{"name": "p", "master": "h1", "roles": [{"name": "r", "skill": "weld"}], "cycle": "500us", "offset": "auto"}],
    "script": [{"at": "5ms", "program": "p", "call": "Start"}]})");
  ASSERT_TRUE(loaded.resolved) << loaded.problems;
  EXPECT_EQ(loaded.problems, "");
  EXPECT_EQ(*loaded.resolved->scenario.programs[0].offset, 2'048_ns);
}

// Multicast trees and redundant streams over all their paths, on rings of switches. Who is warned of may wait.
TEST(AutoOffsets, RandomTrafficOverRings) {
  std::size_t redundant = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::RandomStream chance(seed, "ring", "test");
    std::string streams;
    for (int i = 0; i < 8; ++i) {
      const std::uint64_t from = 1 + chance.below(6);
      const std::uint64_t to = 1 + (from + chance.below(5)) % 6;
      const std::uint64_t third = 1 + (from + chance.below(5)) % 6;
      const std::string listeners = chance.below(3) == 0 && third != to ? fmt::format(R"(["h{}", "h{}"])", to, third)
                                                                        : fmt::format(R"("h{}")", to);
      streams += fmt::format(
          R"({}{{"name": "s{}", "from": "h{}", "to": {}, "payload": "{}B", "every": "{}us", "offset": {}, "pcp": {}{}}})",
          i == 0 ? "" : ", ", i, from, listeners, 20 + chance.below(300), chance.below(2) == 0 ? 500 : 1'000,
          i == 3 ? "\"50us\"" : "\"auto\"", chance.below(8), chance.below(3) == 0 ? R"(, "redundancy": 2)" : "");
    }
    const Loaded loaded = load(fmt::format(
        R"({{"name": "t", "duration": "20ms", "network": {{"generate": [{{"topology": "ring", "switches": 6, "forwarding_delay": "1us"}}]}}, "streams": [{}]}})",
        streams));
    ASSERT_TRUE(loaded.resolved) << loaded.problems;
    EXPECT_EQ(loaded.problems.find("meet"), std::string::npos) << loaded.problems;
    redundant += loaded.resolved->redundancies.size();
    const results::RunResult result = run_live(*loaded.resolved);
    for (std::size_t s = 0; s < result.streams.size(); ++s) {
      const bool is_copied =
          std::ranges::any_of(loaded.resolved->redundancies,
                              [&](const scenario::ResolvedRedundancy& each) { return each.stream.value == s; });
      const Alone way = alone(*loaded.resolved, s, 8_ns, 1_us);
      SCOPED_TRACE(result.streams[s].name + ", seed " + std::to_string(seed));
      if (loaded.resolved->plan.streams[s].listeners.size() == 1) {
        EXPECT_EQ(result.streams[s].latency->max.ps(), result.streams[s].latency->min.ps());
      }
      if (is_copied) continue;
      EXPECT_EQ(result.streams[s].latency->min.ps(), way.least.ps());
      EXPECT_EQ(result.streams[s].latency->max.ps(), way.most.ps());
    }
  }
  EXPECT_GT(redundant, 20u);
}

/// Streams of many sizes and two periods along a line of four switches, one from each host; `only` leaves out the
/// others.
std::string along_a_line(const std::string& switches, std::optional<int> only = {}) {
  sim::RandomStream chance(7, "line", "test");
  std::string streams;
  for (int i = 0; i < 8; ++i) {
    const std::uint64_t from = 1 + chance.below(4);
    const std::string one = fmt::format(
        R"({{"name": "s{}", "from": "h{}", "to": "h{}", "payload": "{}B", "every": "{}us", "offset": {}, "pcp": 6}})",
        i, from, 1 + (from + chance.below(3)) % 4, 20 + chance.below(1'400), chance.below(2) == 0 ? 500 : 250,
        only ? "\"0us\"" : "\"auto\"");
    if (!only || *only == i) streams += (streams.empty() ? "" : ", ") + one;
  }
  return fmt::format(
      R"({{"name": "t", "duration": "20ms", "network": {{"generate": [{{"topology": "line", "switches": 4, "forwarding_delay": "1us"{}}}]}}, "streams": [{}]}})",
      switches, streams);
}

// Frames that are cut through are at the next port before their end; each has the latency that it has alone.
TEST(AutoOffsets, CutThrough) {
  const std::string switches = R"(, "egress": [{"cut_through": [6]}])";
  const Loaded together = load(along_a_line(switches));
  ASSERT_TRUE(together.resolved) << together.problems;
  const results::RunResult result = run_live(*together.resolved);
  bool is_cut_through = false;
  for (std::size_t s = 0; s < 8; ++s)
    is_cut_through = is_cut_through || result.streams[s].latency->max < alone(*together.resolved, s, 8_ns, 1_us).least;
  EXPECT_TRUE(is_cut_through);
  for (int i = 0; i < 8; ++i) {
    const Loaded single = load(along_a_line(switches, i));
    ASSERT_TRUE(single.resolved) << single.problems;
    const results::RunResult way = run_live(*single.resolved);
    EXPECT_EQ(result.streams[static_cast<std::size_t>(i)].latency->min.ps(), way.streams[0].latency->min.ps()) << i;
    EXPECT_EQ(result.streams[static_cast<std::size_t>(i)].latency->max.ps(), way.streams[0].latency->max.ps()) << i;
  }
}

// Stations in a line: what each sends itself enters its bridge at once, what goes through takes the forwarding delay.
TEST(AutoOffsets, Stations) {
  std::string streams;
  for (int i = 2; i <= 6; ++i)
    streams += fmt::format(
        R"({}{{"name": "up{}", "from": "st{}", "to": "st1", "payload": "100B", "every": "250us", "offset": "auto", "pcp": 6}}, {{"name": "down{}", "from": "st1", "to": "st{}", "payload": "{}B", "every": "500us", "offset": "auto", "pcp": 6}})",
        i == 2 ? "" : ", ", i, i, i, i, 100 * i);
  const Loaded loaded = load(fmt::format(
      R"({{"name": "t", "duration": "20ms", "network": {{"generate": [{{"topology": "line", "stations": 6, "forwarding_delay": "1us"}}]}}, "streams": [{}]}})",
      streams));
  ASSERT_TRUE(loaded.resolved) << loaded.problems;
  EXPECT_EQ(loaded.problems, "");
  const results::RunResult result = run_live(*loaded.resolved);
  for (const results::StreamResult& each : result.streams)
    EXPECT_EQ(each.latency->min.ps(), each.latency->max.ps()) << each.name;
}

TEST(AutoOffsets, OfAProgramWhosePhasesAreGiven) {
  const Loaded loaded =
      load(program("", R"(, "offset": "auto", "phases": {"h1": "0us", "h2": "10us", "h3": "20us", "h4": "30us"})"));
  ASSERT_TRUE(loaded.resolved) << loaded.problems;
  EXPECT_NE(loaded.problems.find("warning at /programs/0/offset: an offset that nobody gets: found \"auto\" beside "
                                 "\"phases\" of all participants, expected one of them"),
            std::string::npos)
      << loaded.problems;
}

// Switches that take from 1000 ns to 1160 ns: the latency varies by that for each on the way, and by nothing else.
TEST(AutoOffsets, ForwardingJitter) {
  const Loaded loaded = load(along_a_line(R"(, "forwarding_jitter": {"uniform": {"from": "0ns", "to": "160ns"}})"));
  ASSERT_TRUE(loaded.resolved) << loaded.problems;
  const results::RunResult result = run_live(*loaded.resolved);
  for (std::size_t s = 0; s < 8; ++s) {
    const Alone way = alone(*loaded.resolved, s, 8_ns, 1_us);
    const auto switches = static_cast<std::int64_t>(loaded.resolved->streams[s].paths[0].size()) - 2;
    EXPECT_GE(result.streams[s].latency->min, way.least) << s;
    EXPECT_LE(result.streams[s].latency->max, way.most + 160_ns * switches) << s;
  }
}

// Where it does not fit: with gates an error, without a warning, each once a stream.
TEST(AutoOffsets, FullLinks) {
  std::string streams;
  for (int i = 0; i < 8; ++i)
    streams += fmt::format(
        "{}\n{{\"name\": \"s{}\", \"from\": \"h{}\", \"to\": \"h9\", \"payload\": \"1454B\", \"every\": \"50us\", "
        "\"offset\": \"auto\", \"pcp\": 6}}",
        i == 0 ? "" : ",", i, i + 1);
  const std::string text =
      R"({"name": "t", "duration": "1ms", "allow_overload": true, "network": {"generate": [{"topology": "line", "switches": 1, "hosts_per_switch": 9}]}, "streams": [)" +
      streams + "]";
  // 1454 + 28 + 18 + 4 + 8 + 12 octets are 12192 ns: four in 50 us. The others meet one each at least.
  const Loaded gated = load(text + R"(, "gates": {"plan": "auto", "classes": [6]}})");
  EXPECT_FALSE(gated.resolved);
  EXPECT_EQ(std::ranges::count(gated.problems, '\n'), 5) << gated.problems;
  EXPECT_NE(
      gated.problems.find(
          "s.json:6:89: error at /streams/4/offset: no offset found that fits: found \"s4\" even with 0s meets \"s0\" "
          "at \"sw1 to h9\", expected fewer, shorter or rarer scheduled frames at these ports, or other paths\n"),
      std::string::npos)
      << gated.problems;
  const Loaded spread = load(text + "}");
  ASSERT_TRUE(spread.resolved) << spread.problems;
  EXPECT_NE(spread.problems.find("s.json:6:89: warning at /streams/4/offset: no offset found that keeps frames apart: "
                                 "found \"s4\" even with 0s meets \"s0\" at \"sw1 to h9\""),
            std::string::npos)
      << spread.problems;
}

// Periods of 50 us and 51 us come at all distances of whole microseconds, and the long frame takes more than that: it
// meets all five.
TEST(AutoOffsets, TheFirstThreeAndHowManyMore) {
  std::string streams;
  for (int i = 0; i < 6; ++i)
    streams += fmt::format(
        "{}\n{{\"name\": \"s{}\", \"from\": \"h{}\", \"to\": \"h7\", \"payload\": \"{}B\", \"every\": \"{}us\", "
        "\"offset\": \"auto\", \"pcp\": 6}}",
        i == 0 ? "" : ",", i, i + 1, i == 5 ? 1454 : 50, i == 5 ? 51 : 50);
  const Loaded loaded = load(
      R"({"name": "t", "duration": "1ms", "network": {"generate": [{"topology": "line", "switches": 1, "hosts_per_switch": 7}]}, "streams": [)" +
      streams + "]}");
  ASSERT_TRUE(loaded.resolved) << loaded.problems;
  EXPECT_EQ(loaded.problems,
            "s.json:7:89: warning at /streams/5/offset: no offset found that keeps frames apart: found \"s5\" even "
            "with 0s meets \"s0\" at \"sw1 to h7\", \"s1\" at \"sw1 to h7\", \"s2\" at \"sw1 to h7\" and 2 more, "
            "expected fewer, shorter or rarer frames at these ports, or other paths\n");
}

}  // namespace
}  // namespace takt::schedule_check::auto_offsets_test
