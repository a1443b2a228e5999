// SPDX-License-Identifier: Apache-2.0
// Cyclic queuing and forwarding by the argument of IEEE 802.1Q Annex T: h switches are left h + 1 cycles after the
// first of them got the frame, at most. Numbers by hand; the simulator beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "json/quantity.hpp"
#include "scenario/resolve.hpp"
#include "sim/random.hpp"
#include "tests/questions/analysis/falsification.hpp"
#include "tests/support/case_count.hpp"

namespace takt::analysis::test::cqf_bound_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

std::unique_ptr<scenario::Resolved> load(const std::string& text, const std::vector<std::string>& sets = {}) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "cqf.json", sets, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return resolved;
}

std::unique_ptr<scenario::Resolved> load_file(const std::string& name, const std::vector<std::string>& sets = {}) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/" + name, sets, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return resolved;
}

std::string text_of(const std::optional<Duration>& value) { return value ? json::to_text(*value) : "unbounded"; }

/// A line of switches at 100 Mb/s, each with 1 us through it, from `t` to `r`; `cqf` goes into the description of each
/// switch's cycles, in quotes and with a comma.
std::string line(int switches, const std::string& streams, const std::string& cqf = {},
                 const std::string& cycle = "250us", const std::string& more = {}) {
  std::string nodes = R"("t": {"kind": "host"}, "r": {"kind": "host"}, "u": {"kind": "host"})";
  std::string links =
      R"({"ends": ["t", "s1"], "rate": "100Mbps", "delay": "100ns"}, {"ends": ["u", "s1"], "rate": "100Mbps", "delay": "100ns"})";
  for (int s = 1; s <= switches; ++s) {
    const std::string name = "s" + std::to_string(s);
    nodes += ", \"" + name + R"(": {"kind": "switch", "forwarding_delay": "1us", "ingress": {"cqf": {)" + cqf +
             R"("cycle": ")" + cycle + R"(", "classes": [5, 6], "pcp": [6]}}})";
    links += ", {\"ends\": [\"" + name + "\", \"" + (s == switches ? "r" : "s" + std::to_string(s + 1)) +
             R"("], "rate": "100Mbps", "delay": "100ns"})";
  }
  return R"({"name": "line", "duration": "20ms", "network": {"nodes": {)" + nodes + R"(}, "links": [)" + links +
         R"(]}, "streams": [)" + streams + "]" + more + "}";
}
const std::string one = R"({"name": "a", "from": "t", "to": "r", "payload": "1400B", "every": "250us", "pcp": 6})";

// 1400 + 28 + 18 + 4 = 1450 octets: 116.64 us to the last bit. s0 gets the frame just as a cycle begins, so it goes out
// when the next one but one begins, first of all.
TEST(CqfBound, TheFinding) {
  const Bounds bounds = bound(*load_file("tests/findings/cqf-two-switches.json"));
  ASSERT_TRUE(bounds.streams[0].latency) << bounds.streams[0].reason;
  EXPECT_EQ(text_of(bounds.streams[0].latency), "734.24us");
  EXPECT_LE(*bounds.streams[0].latency, 750_us + 116'640_ns);
  EXPECT_TRUE(bounds.streams[0].loses_nothing);
}

// (h + 1) T and a frame, over one to four switches, and not less than (h - 1) T; reached to a part of a cycle by what
// was drawn by hand: the frame comes as a cycle begins.
TEST(CqfBound, GrowsByACycleASwitch) {
  for (int h = 1; h <= 4; ++h) {
    const auto free = load(line(h, one));
    const Bounds bounds = bound(*free);
    ASSERT_TRUE(bounds.streams[0].latency) << h << " " << bounds.streams[0].reason;
    EXPECT_LE(*bounds.streams[0].latency, 250_us * (h + 1) + 116'640_ns + 200_ns) << h;
    EXPECT_GE(bounds.streams[0].least, 250_us * (h - 1)) << h;
    Duration longest, shortest = Duration::max();
    for (int offset = 0; offset < 250; offset += 5) {
      const auto at = load(line(h, one), {"/streams/0/offset=" + std::to_string(offset * 1000 + 3'260) + "ns"});
      const Verdict verdict = simulate(*at, bounds);
      EXPECT_EQ(verdict.violations, std::vector<std::string>()) << h << " " << offset;
      scenario::Run run(*at);
      run.advance();
      longest = std::max(longest, run.network().traffic().streams()[0].latency.maximum());
      shortest = std::min(shortest, run.network().traffic().streams()[0].latency.minimum());
    }
    EXPECT_GT(longest + 6_us, *bounds.streams[0].latency) << h;
    EXPECT_LT(shortest, bounds.streams[0].least + 6_us) << h;
  }
}

// Frames a cycle apart are one in each cycle: the interval is closed on one side. A picosecond nearer, and two may
// come: 236 us hold one of 117.6 us, but not two and 1 us through the switch.
TEST(CqfBound, ACycleIsClosedOnOneSide) {
  const auto every = [](const std::string& period) {
    return R"({"name": "a", "from": "t", "to": "r", "payload": "1400B", "every": ")" + period + R"(", "pcp": 6})";
  };
  EXPECT_TRUE(bound(*load(line(3, every("236us"), {}, "236us"))).streams[0].latency);
  const StreamBound refused = bound(*load(line(3, every("235999999ps"), {}, "236us"))).streams[0];
  EXPECT_FALSE(refused.latency);
  EXPECT_EQ(refused.reason,
            "at s1:2 to s2, class 6: what comes in a cycle of cyclic queuing and forwarding does not fit into one: "
            "frames of 235.2us, sent 236.2us after it begins, of 235.899us");
}

// What does not fit is said in figures: three frames of 117.6 us.
TEST(CqfBound, SaysWhatDoesNotFit) {
  const std::string burst =
      R"({"name": "a", "from": "t", "to": "r", "payload": "1400B", "burst": {"frames": 3, "every": "2ms"}, "pcp": 6})";
  const StreamBound refused = bound(*load(line(2, burst))).streams[0];
  EXPECT_FALSE(refused.latency);
  EXPECT_EQ(refused.reason,
            "at s1:2 to s2, class 6: what comes in a cycle of cyclic queuing and forwarding does not fit into one: "
            "frames of 352.8us, sent 353.8us after it begins, of 249.899us");
}

// The finding window-missed: a window as long as its frame, of a cycle of 97.72 us, and nothing else. 1.04 us and 100
// ns to the switch, a cycle and 1.04 us there, and 100 ns.
TEST(CqfBound, AndOtherWindows) {
  const StreamBound stream = bound(*load_file("tests/findings/window-missed.json")).streams[0];
  EXPECT_EQ(text_of(stream.latency), "100us") << stream.reason;
}

// What is shipped is proved: bounds within its requirements, which rest on nothing that is open.
TEST(CqfBound, OfTheShippedScenario) {
  const auto resolved = load_file("scenarios/tsn/cqf.json");
  const Bounds bounds = bound(*resolved);
  ASSERT_EQ(bounds.requirements.size(), 2u);
  ASSERT_TRUE(bounds.requirements[0].duration) << bounds.requirements[0].reason;
  EXPECT_LE(*bounds.requirements[0].duration, 1030_us);
  EXPECT_EQ(bounds.requirements[1].count, std::uint64_t{0}) << bounds.requirements[1].reason;
  for (const RequirementBound& requirement : bounds.requirements)
    EXPECT_EQ(bounds.ledger.objection(requirement.assumptions, resolved->scenario.warm_up), "");
}

/// A line of one to three switches with cycles, base times, dead times, buffers and rates as drawn, a host for each
/// stream, and more streams of other classes. With `fits` what comes in a cycle fits into one at each port by the
/// simplest count: a frame or a burst of each stream, a frame of another class, and all times through the switch.
struct Drawn {
  std::string text;
  int switches = 1;
  Duration cycle;
  std::vector<std::string> carried;  ///< streams over all switches by CQF
};
Drawn drawn(std::uint64_t number, bool fits) {
  sim::RandomStream chance(number, "cqf", "drawn");
  const auto one_in = [&](std::uint64_t n) { return chance.below(n) == 0; };
  const auto ps = [](std::uint64_t value) { return "\"" + std::to_string(value) + "ps\""; };
  Drawn made;
  made.switches = 1 + static_cast<int>(chance.below(3));
  const std::uint64_t cycle_us = 250 + 50 * chance.below(6);
  made.cycle = Duration::from_ps(static_cast<std::int64_t>(cycle_us) * 1'000'000);
  const bool three = one_in(3);
  const std::string same_base = std::to_string(chance.below(100)) + "us";
  std::string nodes = R"("r": {"kind": "host"})", links, streams;
  for (int s = 0; s < made.switches; ++s) {
    const std::string name = "s" + std::to_string(s);
    const bool is_odd = !fits && one_in(4);
    const std::uint64_t cycle = is_odd ? cycle_us * (1 + chance.below(2)) + 50 * chance.below(2) : cycle_us;
    std::string cqf = R"("cycle": ")" + std::to_string(cycle) + R"(us", "pcp": [6], "classes": )" +
                      (three       ? "[4, 5, 6]"
                       : one_in(3) ? "[4, 6]"
                                   : "[5, 6]") +
                      R"(, "base_time": ")" +
                      (!fits && one_in(4) ? std::to_string(chance.below(200)) + "us" : same_base) + "\"";
    if (three && one_in(2)) cqf += R"(, "offset": ")" + std::to_string(10 + chance.below(20)) + "us\"";
    if (!three && one_in(2))
      cqf += R"(, "dead_time": ")" + std::to_string(fits ? 5 + chance.below(10) : chance.below(20)) + "us\"";
    nodes += ", \"" + name + R"(": {"kind": "switch", "traffic_classes": "identity", "forwarding_delay": )" +
             ps(chance.below(9'000'000)) + R"(, "ingress": {"cqf": {)" + cqf + "}}" +
             (!fits && one_in(5) ? R"(, "egress": [{"shapers": [{"class": 7, "idle_slope": "10Mbps"}]}])" : "") + "}";
    links += (s == 0 ? "" : ", ") + std::string(R"({"ends": [")") + name + R"(", ")" +
             (s + 1 == made.switches ? "r" : "s" + std::to_string(s + 1)) + R"("], "rate": "100Mbps", "delay": )" +
             ps(chance.below(4'000'000)) + "}";
  }
  const std::size_t count = 1 + chance.below(4);
  std::uint64_t octets =
      180 +
      (cycle_us - 250) *
          10;  // left of a cycle beside 1542 of another class, 30 us through the switch, its dead time and the cable
  octets += 900;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number_text = std::to_string(i);
    const bool carried = i == 0 || one_in(2);
    const std::uint64_t at = i == 0 ? 0 : chance.below(static_cast<std::uint64_t>(made.switches));
    const std::uint64_t payload =
        fits && carried ? std::min<std::uint64_t>(1400, octets / count - 70) : 46 + chance.below(1300);
    const std::uint64_t period = fits || one_in(2) ? cycle_us * (1 + chance.below(2)) : 200 + chance.below(900);
    nodes += ", \"t" + number_text + R"(": {"kind": "host"})";
    links += R"(, {"ends": ["t)" + number_text + R"(", "s)" + std::to_string(at) + R"("], "rate": ")" +
             (one_in(3) ? "1Gbps" : "100Mbps") + R"(", "delay": )" + ps(chance.below(2'000'000)) + "}";
    streams += (i == 0 ? "" : ", ") + std::string(R"({"name": "f)") + number_text + R"(", "from": "t)" + number_text +
               R"(", "to": "r", "payload": ")" + std::to_string(payload) + R"(B", "every": ")" +
               std::to_string(period) + R"(us", "pcp": )" +
               (carried             ? "6"
                : fits || one_in(2) ? "0"
                                    : "7") +
               (!fits && one_in(3) ? R"(, "jitter": )" + ps(chance.below(90'000'000)) : std::string()) + "}";
    if (carried && at == 0) made.carried.push_back("f" + number_text);
  }
  made.text = R"({"name": "drawn", "duration": "14ms", "allow_overload": true, "network": {"nodes": {)" + nodes +
              R"(}, "links": [)" + links + R"(]}, "streams": [)" + streams + "]}";
  return made;
}

/// Runs at phases as drawn, against bounds that hold at all of them.
void run_at_phases(std::uint64_t number, const Drawn& made, const Bounds& bounds, std::vector<double>& shares) {
  sim::RandomStream chance(number, "cqf", "phases");
  std::vector<double> best(bounds.streams.size(), 0);
  for (int step = 0; step < 6; ++step) {
    std::vector<std::string> sets;
    for (std::size_t s = 0; s < bounds.streams.size(); ++s) {
      const std::uint64_t about_a_cycle =
          static_cast<std::uint64_t>(made.cycle.ps()) * (8 + chance.below(2)) - 130'000'000 + chance.below(135'000'000);
      sets.push_back("/streams/" + std::to_string(s) + "/offset=" +
                     std::to_string(step == 0       ? 3'000'000'000
                                    : step % 2 == 0 ? 3'000'000'000 + chance.below(700'000'000)
                                                    : about_a_cycle) +
                     "ps");
    }
    const auto at = load(made.text, sets);
    const Verdict verdict = simulate(*at, bounds);
    EXPECT_EQ(verdict.violations, std::vector<std::string>()) << number << "\n"
                                                              << made.text << "\n"
                                                              << ::testing::PrintToString(sets);
    EXPECT_EQ(simulate(*at, bound(*at)).violations, std::vector<std::string>()) << number << " with phases\n"
                                                                                << made.text;
    for (std::size_t i = 0; i < verdict.shares.size(); ++i) best[i] = std::max(best[i], verdict.shares[i]);
  }
  for (const double share : best)
    if (share > 0) shares.push_back(share);
}

std::uint64_t networks() { return support::case_count("TAKT_CQF_NETWORKS", 40); }

// Where it fits by the simplest count there is a bound, (h + 1) T and the way to and from the switches with two
// buffers, and no run exceeds it.
TEST(CqfBound, WhatFitsIsBounded) {
  std::vector<double> shares;
  std::size_t carried = 0;
  for (std::uint64_t number = 0; number < networks(); ++number) {
    const Drawn made = drawn(number, true);
    const auto resolved = load(made.text);
    const Bounds bounds = bound(*resolved);
    const bool three = made.text.find("[4, 5, 6]") != std::string::npos;
    for (const StreamBound& stream : bounds.streams) {
      if (std::ranges::find(made.carried, stream.name) == made.carried.end()) continue;
      ++carried;
      EXPECT_TRUE(stream.latency) << number << " " << stream.name << ": " << stream.reason << "\n" << made.text;
      if (!stream.latency) continue;
      const int cycles = three ? 2 * made.switches + 1 : made.switches + 1;
      EXPECT_LE(*stream.latency, made.cycle * cycles + 123_us + 8_us) << number << " " << stream.name << "\n"
                                                                      << made.text;
    }
    run_at_phases(number, made, bounds, shares);
  }
  EXPECT_GT(carried, networks());
  std::sort(shares.begin(), shares.end());
  ASSERT_FALSE(shares.empty());
  EXPECT_GT(shares[shares.size() / 2], 0.6);
}

// And where cycles, base times and dead times differ, streams are jittery and classes in between are busy, what is
// bounded is bounded rightly.
TEST(CqfBound, NoBoundIsExceeded) {
  std::vector<double> shares;
  std::size_t bounded = 0, unbounded = 0;
  for (std::uint64_t number = 0; number < networks(); ++number) {
    const Drawn made = drawn(number, false);
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_text(made.text, "cqf.json", {}, diagnostics);
    if (!resolved) continue;  // an odd cycle holds no frame, for one
    const Bounds bounds = bound(*resolved);
    for (const StreamBound& stream : bounds.streams) ++(stream.latency ? bounded : unbounded);
    run_at_phases(number, made, bounds, shares);
  }
  EXPECT_GT(bounded, unbounded / 2);
  EXPECT_GT(unbounded, 0u);
  std::printf("%zu streams bounded, %zu not\n", bounded, unbounded);
}

}  // namespace
}  // namespace takt::analysis::test::cqf_bound_test
