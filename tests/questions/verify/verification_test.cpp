// SPDX-License-Identifier: Apache-2.0
// simulated <= adversarial <= bound for every requirement of every shipped scenario, and verdicts that follow from it.
#include "verify/verification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/questions/verify/support.hpp"
#include "verify/report.hpp"

namespace takt::verify::verification_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

std::vector<std::string> shipped() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(TAKT_SOURCE_DIR) + "/scenarios")) {
    const std::string name = entry.path().string();
    if (entry.path().extension() == ".json" && !name.ends_with(".schema.json") &&
        name.find("/studies/") == std::string::npos)
      files.push_back(name);
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(Verification, OfEveryShippedScenario) {
  std::size_t bounds = 0;
  std::size_t files = 0;
  for (const std::string& file : shipped()) {
    json::Diagnostics diagnostics;
    // Clocks take seconds to settle, and large rings to run; what they do in the first second must not exceed a bound
    // either.
    const bool is_long = file.find("/clocks/") != std::string::npos || file.find("ring-1000") != std::string::npos;
    const auto resolved = scenario::load_file(
        file, is_long ? std::vector<std::string>{"/duration=300ms"} : std::vector<std::string>{}, diagnostics);
    if (!resolved && is_long) continue;  // its script goes on for longer
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    ++files;
    const Verification found = verify(*resolved, small());
    EXPECT_FALSE(found.contradiction) << file << ": " << found.contradiction->text;
    for (const Line& line : found.lines) {
      EXPECT_LE(line.simulated.value_or(Duration()), line.adversarial.value_or(Duration::max()))
          << file << ": " << line.requirement.text;
      if (!line.bound || !line.adversarial) continue;
      ++bounds;
      EXPECT_LE(*line.adversarial, *line.bound) << file << ": " << line.requirement.text;
    }
  }
  EXPECT_GE(files, 30u);
  EXPECT_GE(bounds, 40u);
}

// Streams with windows of their own: what is simulated, the worst that can be found and the bound are one.
TEST(Verification, AutomaticGatesAreProved) {
  json::Diagnostics diagnostics;
  const auto resolved =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/scenarios/tsn/automatic-gates.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  const Verification found = verify(*resolved, small());
  std::size_t streams = 0;
  for (const Line& line : found.lines) {
    if (!line.requirement.text.starts_with("stream") && !line.requirement.text.starts_with("reaction")) continue;
    EXPECT_EQ(line.verdict, Conclusion::pass) << line.requirement.text << ": " << line.reason;
    ASSERT_TRUE(line.bound) << line.requirement.text << ": " << line.reason;
    if (!line.requirement.text.starts_with("stream")) continue;
    ++streams;
    EXPECT_EQ(line.simulated, line.bound) << line.requirement.text;
  }
  EXPECT_EQ(streams, 2u);
}

// Operating systems, calls and phases meet at their worst: what the bounds give away is little.
TEST(Verification, TheWorstRunOfRobotArmComesNearItsBounds) {
  json::Diagnostics diagnostics;
  const auto resolved =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/scenarios/robot-arm.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  Options options;
  options.search.seeds = 1;
  for (const Line& line : verify(*resolved, options).lines) {
    EXPECT_EQ(line.verdict, Conclusion::pass) << line.requirement.text;
    if (!line.bound) continue;
    EXPECT_GE(*line.tightness(), line.requirement.kind == results::RequirementKind::reaction ? 0.9 : 0.85)
        << line.requirement.text;
  }
}

Verification verified(const std::string& requirements) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(R"({"name": "two", "duration": "20ms",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch"}},
      "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}, {"ends": ["c", "sw"]}]},
    "streams": [{"name": "urgent", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms"},
                {"name": "bulk", "from": "c", "to": "b", "payload": "1400B", "pcp": 0, "every": "1ms"}],
    "require": [)" + requirements + "]}",
                                            "test", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return verify(*resolved, small());
}

// Alone the frame takes 2 x 154 octets + 4 for the tag, and the cables and the switch; at worst 1470 octets of 8 ns
// more, less 1 ps that is left of them.
TEST(Verification, VerdictsFollowFromTheLimit) {
  const Verification found = verified(
      R"({"stream": "urgent", "latency": "20us"}, {"stream": "urgent", "latency": "14us"}, {"stream": "urgent", "dropped": 0},
    {"stream": "urgent", "delivered": 20}, {"stream": "urgent", "delivered": 21})");
  ASSERT_EQ(found.lines.size(), 5u);
  const Conclusion expected[] = {Conclusion::pass, Conclusion::refuted, Conclusion::pass, Conclusion::pass,
                                 Conclusion::refuted};
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(found.lines[i].verdict, expected[i]) << found.lines[i].requirement.text << ": " << found.lines[i].reason;
  EXPECT_EQ(found.lines[1].reason, "a run exceeds the limit");
  EXPECT_EQ(found.verdict(), Conclusion::refuted);
  EXPECT_GT(*found.lines[0].tightness(), 0.99);
  const std::string json = json_report("two", found, std::vector<std::string>(5));
  for (const char* const key :
       {"\"simulated_ps\"", "\"adversarial_ps\"", "\"bound_ps\"", "\"limit_ps\": 20000000", "\"verdict\": \"refuted\""})
    EXPECT_NE(json.find(key), std::string::npos) << key;
}

// "suspend within 2ms" fails where nobody suspends: refuted by that run, which contradicts no bound.
TEST(Verification, WantOfAReactionIsNoContradiction) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_file(
      std::string(TAKT_SOURCE_DIR) + "/tests/findings/contradiction-without-a-reaction.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  const Verification found = verify(*resolved, small());
  EXPECT_FALSE(found.contradiction) << found.contradiction->text;
  EXPECT_EQ(found.verdict(), Conclusion::refuted);
}

// A forwarding delay that is longer than an ATS scheduler holds a frame let a burst out unshaped, which the bound
// behind the scheduler does not know: the run exceeded it.
TEST(Verification, AtsShapesWhateverTheForwardingDelay) {
  using Overrides = std::vector<std::string>;
  const auto delayed = [](const char* delay) { return std::string("/network/nodes/s/forwarding_delay=") + delay; };
  const std::string faster = "/network/nodes/s/ingress/ats/0/rate=85Mbps";
  for (const Overrides& overrides : {Overrides{}, Overrides{faster, delayed("3us")},
                                     Overrides{faster, delayed("100us")}, Overrides{delayed("0us")}}) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(
        std::string(TAKT_SOURCE_DIR) + "/tests/findings/ats-forwarding-delay.json", overrides, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    const Verification found = verify(*resolved, small());
    EXPECT_FALSE(found.contradiction) << found.contradiction->text;
    EXPECT_EQ(found.verdict(), Conclusion::pass);
  }
}

// A link that is asked for 171 % of its rate: without a limit its queue grows and loses nothing; with one it does.
TEST(Verification, OnlyQueuesWithALimitAreFull) {
  const auto of = [](const std::vector<std::string>& sets) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(
        std::string(TAKT_SOURCE_DIR) + "/tests/findings/queues-without-limit.json", sets, diagnostics);
    EXPECT_TRUE(resolved) << diagnostics.to_text();
    return verify(*resolved, small());
  };
  EXPECT_EQ(of({}).lines[0].verdict, Conclusion::pass);
  const Verification limited = of({R"(/network/nodes/s/queues={"frames": 4})"});
  EXPECT_EQ(limited.lines[0].verdict, Conclusion::refuted);
  EXPECT_EQ(limited.lines[0].reason, "a full queue may drop frames at s:1");
}

TEST(Verification, UndecidedBetweenTheWorstRunAndTheBound) {
  const Verification loose = verified(R"({"stream": "urgent", "latency": "20us"})");
  // The long frame has begun 1 ps before: the bound takes it for whole.
  const Duration between = *loose.lines[0].adversarial;
  ASSERT_LT(between, *loose.lines[0].bound);
  const Verification found =
      verified(R"({"stream": "urgent", "latency": ")" + std::to_string(between.ps()) + R"(ps"})");
  EXPECT_EQ(found.lines[0].verdict, Conclusion::undecided);
  EXPECT_EQ(found.verdict(), Conclusion::undecided);
  EXPECT_NE(found.lines[0].reason, "");
}

// Who has a role is settled while the Program runs, in every order that the explorer finds.
TEST(Verification, InvariantsOfAProgramWithRolesAreExplored) {
  const auto judged = [](const std::string& script) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_text(R"({"name": "roles", "duration": "300ms", "network": {
      "nodes": {"sw": {"kind": "switch"}, "m": {"kind": "host"}, "a": {"kind": "host", "offers": ["weld"]}, "b": {"kind": "host", "offers": ["weld"]}},
      "links": [{"ends": ["m", "sw"]}, {"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}]},
      "programs": [{"name": "cell", "master": "m", "roles": [{"name": "welder", "skill": "weld"}], "candidates": ["a", "b"], "cycle": "1ms"}],
      "script": [)" + script + "]}",
                                              "roles", {}, diagnostics);
    EXPECT_TRUE(resolved) << diagnostics.to_text();
    if (!resolved) return Line{};
    const Verification found = verify(*resolved, small());
    const auto line = std::find_if(found.lines.begin(), found.lines.end(), [](const Line& each) {
      return each.requirement.kind == results::RequirementKind::invariants;
    });
    return line == found.lines.end() ? Line{} : *line;
  };
  const Line idle = judged("");
  EXPECT_EQ(idle.verdict, Conclusion::pass) << idle.reason;
  EXPECT_EQ(idle.remark, "explored: 10780 states, 1 call and 0 faults in all, joins and leaves among the calls");
  const Line left = judged(R"({"at": "200ms", "leave": "a"})");
  EXPECT_EQ(left.verdict, Conclusion::pass) << left.reason;
  EXPECT_EQ(left.remark, idle.remark) << "a leaver is a call";
  // Two calls are more than are looked at here.
  EXPECT_EQ(judged(R"({"at": "100ms", "program": "cell", "call": "Start"}, {"at": "200ms", "leave": "a"})").reason,
            "100000 states of the handshake were looked at, not all; takt explore takes the time");
}

// Both groups of a tree at once, the inner one with a role that two nodes may have.
TEST(Verification, InvariantsOfNestedProgramsAreExplored) {
  const auto judged = [](const std::string& inner) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_text(R"({"name": "nested", "duration": "300ms", "network": {
      "nodes": {"sw": {"kind": "switch"}, "m": {"kind": "host"}, "c": {"kind": "host"}, "a": {"kind": "host", "offers": ["weld"]}, "b": {"kind": "host", "offers": ["weld"]}},
      "links": [{"ends": ["m", "sw"]}, {"ends": ["c", "sw"]}, {"ends": ["a", "sw"]}, {"ends": ["b", "sw"]}]},
      "programs": [{"name": "line", "master": "m", "slaves": ["c"], "cycle": "1ms"}, {"name": "cell", "within": "line", "master": "c", "cycle": "1ms", )" +
                                                  inner + R"(}],
      "script": [{"at": "100ms", "program": "line", "call": "Start"}]})",
                                              "nested", {}, diagnostics);
    EXPECT_TRUE(resolved) << diagnostics.to_text();
    std::vector<Line> lines;
    if (!resolved) return lines;
    for (const Line& each : verify(*resolved, small()).lines)
      if (each.requirement.kind == results::RequirementKind::invariants) lines.push_back(each);
    return lines;
  };
  for (const std::string inner : {R"("slaves": ["a"])", R"("slaves": ["a", "b"])",
                                  R"("roles": [{"name": "welder", "skill": "weld"}], "candidates": ["a"])"}) {
    const std::vector<Line> lines = judged(inner);
    ASSERT_EQ(lines.size(), 2u);
    for (const Line& each : lines)
      EXPECT_EQ(each.verdict, Conclusion::pass) << inner << ": " << each.reason << each.remark;
  }
}

}  // namespace
}  // namespace takt::verify::verification_test
