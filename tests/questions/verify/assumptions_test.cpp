// SPDX-License-Identifier: Apache-2.0
// No verdict is worth more than what it rests on: assumptions are discharged, left open or violated, and what rests on
// them follows.
#include <gtest/gtest.h>

#include "analysis/assumption_ledger.hpp"
#include "evaluation/evaluate.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "tests/questions/verify/support.hpp"
#include "verify/monitor.hpp"
#include "verify/report.hpp"
#include "verify/verification.hpp"

namespace takt::verify::assumptions_test {
namespace {

using analysis::Assumption;
using analysis::Standing;
using sim::Duration;
using namespace sim::literals;  // NOLINT

std::unique_ptr<scenario::Resolved> finding(const std::string& name, const std::vector<std::string>& sets = {}) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/" + name, sets, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}

/// a and c send to b over a switch; `more` goes into the scenario.
std::unique_ptr<scenario::Resolved> small_network(const std::string& more, const std::string& port = {},
                                                  const std::string& urgent = {}) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(R"({"name": "small", "duration": "50ms",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch")" +
                                          port + R"(}},
      "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}, {"ends": ["c", "sw"]}]},
    "streams": [{"name": "urgent", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms")" +
                                          urgent + R"(},
                {"name": "bulk", "from": "c", "to": "b", "payload": "1400B", "pcp": 0, "every": "1ms"}])" +
                                          more + "}",
                                      "test", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}

/// Two hosts with gPTP behind a switch; `require` beside a latency that counts from 5 s on.
std::unique_ptr<scenario::Resolved> with_gptp(const std::string& require, const std::string& more = {}) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(R"({"name": "t", "duration": "6s",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "sw": {"kind": "switch"}},
      "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}]},
    "clocks": {"all": {"offset": {"from": "-10ppm", "to": "10ppm"}}, "gptp": {}},
    "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "50ms"}],
    "require": [{"stream": "s", "latency": "1ms", "after": "5s"})" +
                                          require + "]" + more + "}",
                                      "test", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}

// What a data sheet promises is a condition, and the verdict says so.
TEST(Given, WhatRestsOnAPromisePassesOnItsCondition) {
  const auto asked = with_gptp(R"(, {"sync": "10us", "after": "5s"})");
  EXPECT_EQ(verify(*asked, small()).lines[0].verdict, Conclusion::undecided);
  const auto given = with_gptp(R"(, {"sync": "10us", "given": true, "after": "5s"})");
  const Verification found = verify(*given, small());
  ASSERT_FALSE(found.contradiction) << found.contradiction->text;
  EXPECT_EQ(found.lines[0].verdict, Conclusion::pass) << found.lines[0].reason;
  EXPECT_EQ(found.lines[1].verdict, Conclusion::given) << found.lines[1].reason;
  const std::string promise =
      "if clocks are within 10us of the grandmaster from 5s on and what was sent before 5s has left the network";
  EXPECT_EQ(found.verdict_text(), "pass, " + promise);
  const std::string page = text_report("t", found, {"", ""});
  EXPECT_NE(page.find("  pass, " + promise + "  stream s latency at most 1ms after 5s\n"), std::string::npos) << page;
  EXPECT_NE(page.find("which only the plant can keep:\n"), std::string::npos) << page;
  EXPECT_NE(page.find("  - clocks are within 10us of the grandmaster from 5s on\n"), std::string::npos) << page;
  EXPECT_NE(page.find("1 of 1 requirements proved, 1 given"), std::string::npos) << page;
  EXPECT_NE(json_report("t", found, {"", ""}).find("\"if\""), std::string::npos);
}

// No clock keeps within 1 ps: the runs show more.
TEST(Given, APromiseThatARunContradictsIsRefuted) {
  const Verification found = verify(*with_gptp(R"(, {"sync": "1ps", "given": true, "after": "5s"})"), small());
  ASSERT_FALSE(found.contradiction) << found.contradiction->text;
  EXPECT_EQ(found.lines[1].verdict, Conclusion::refuted);
  EXPECT_EQ(found.lines[0].verdict, Conclusion::undecided);
  EXPECT_EQ(found.ledger[Assumption::clock_difference].standing, Standing::violated);
  EXPECT_NE(found.lines[0].reason.find("which is refuted"), std::string::npos) << found.lines[0].reason;
}

// From the start on nothing was sent before.
TEST(Given, OfDifferencesAndFromTheStart) {
  const auto resolved = with_gptp(R"(, {"clocks": "*", "within": "1s", "given": true})");
  const Verification found = verify(*resolved, small());
  EXPECT_EQ(found.lines[0].provided, "clocks are within 1s of each other");
  EXPECT_EQ(found.ledger[Assumption::drained].standing, Standing::discharged);
}

// A gate that is stuck until later is no promise of the data sheet.
TEST(Given, WhatElseMustHoldStaysOpen) {
  const auto resolved = with_gptp(
      R"(, {"sync": "10us", "given": true, "after": "4s"})",
      R"(, "faults": [{"kind": "stuck-gate", "node": "sw", "class": 6, "state": "closed", "at": "100ms", "for": "4400ms"}])");
  const Verification found = verify(*resolved, small());
  EXPECT_EQ(found.lines[0].verdict, Conclusion::undecided);
  EXPECT_EQ(found.ledger[Assumption::drained].standing, Standing::open);
}

TEST(Given, MistakesAreDiagnostics) {
  const auto refused = [](const std::string& clocks, const std::string& require) {
    json::Diagnostics diagnostics;
    EXPECT_FALSE(scenario::load_text(
        R"({"name": "t", "duration": "1s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
      "clocks": {"all": {"offset": "10ppm"})" +
            clocks + R"(}, "require": [)" + require + "]}",
        "test", {}, diagnostics));
    return diagnostics.to_text();
  };
  EXPECT_NE(refused(R"(, "gptp": {})", R"({"sync": "1us", "node": "a", "given": true})").find("a promise of one clock"),
            std::string::npos);
  EXPECT_NE(refused("", R"({"clocks": "*", "within": "1us", "given": true})")
                .find("a promise of clocks that nothing holds together"),
            std::string::npos);
}

// The shortest way is 23.184 us; the other way round the ring, which frames take from 120 ms on, is two switches
// longer. A bound of the first alone would be 33 us.
TEST(Assumptions, BoundsCoverWaysThatReroutingLays) {
  const auto resolved = finding("rerouting-bound.json");
  Options options = small();
  options.search.events = 3'000'000;
  const Verification found = verify(*resolved, options);
  ASSERT_FALSE(found.contradiction) << found.contradiction->text;
  ASSERT_EQ(found.lines.size(), 1u);
  EXPECT_EQ(found.lines[0].verdict, Conclusion::refuted);
  ASSERT_TRUE(found.lines[0].bound);
  EXPECT_GT(*found.lines[0].adversarial, 30_us);
  EXPECT_GE(*found.lines[0].bound, *found.lines[0].adversarial);
  EXPECT_GT(*found.lines[0].tightness(), 0.85);
}

// A frame that is on the link when it goes down never arrives, which no latency allows, unless the losses are required
// apart. The search lays the failure where it hits one.
TEST(Assumptions, LatencyIsNotProvedWhereFramesMayBeLost) {
  const std::string cut =
      R"(, "faults": [{"kind": "link-down", "link": ["a", "sw"], "at": "10ms", "for": "100us"}], "require": [{"stream": "urgent", "latency": "1ms")";
  const Verification alone = verify(*small_network(cut + "}]", {}, R"(, "offset": "0us")"), small());
  EXPECT_EQ(alone.lines[0].verdict, Conclusion::refuted);
  EXPECT_NE(alone.lines[0].reason.find("frames may be lost"), std::string::npos) << alone.lines[0].reason;
  const Verification apart =
      verify(*small_network(cut + R"(}, {"stream": "urgent", "dropped": 5}])", {}, R"(, "offset": "500us")"), small());
  EXPECT_EQ(apart.lines[0].verdict, Conclusion::pass) << apart.lines[0].reason;
}

TEST(Assumptions, ClocksAreNotGoodFromTheStart) {
  const Verification found = verify(*finding("gptp-lock-in.json", {"/duration=6s"}), small());
  EXPECT_FALSE(found.contradiction);
  for (const Line& line : found.lines) {
    EXPECT_FALSE(line.bound) << line.requirement.text;
    EXPECT_NE(line.verdict, Conclusion::pass) << line.requirement.text;
  }
  EXPECT_EQ(found.ledger[Assumption::clock_difference].holds_from, 5_s);
}

// Of two runs one loses a frame, and fails; the other takes longer. What was simulated is the longer.
TEST(Assumptions, TheLongestRunIsTold) {
  const auto resolved = finding("longest-run-loses-nothing.json");
  scenario::Run run(*resolved);
  while (!run.advance(100'000)) {
  }
  const results::RunResult result = evaluation::evaluate(run, false);
  const Verification found = verify(*resolved, small());
  for (std::size_t i = 0; i < found.lines.size(); ++i)
    EXPECT_GE(found.lines[i].simulated, result.requirements[i].measured) << found.lines[i].requirement.text;
}

// A start that has not ended at the end of the run, and one frame that is handed over after its launch time: both broke
// what had been proved.
TEST(Assumptions, WhatIsUnderWayAtTheEndContradictsNothing) {
  for (const char* const name : {"start-at-the-end.json", "missed-launch.json"}) {
    const Verification found = verify(*finding(name), small());
    EXPECT_FALSE(found.contradiction) << found.contradiction->text;
  }
}

TEST(Assumptions, WhatRestsOnARefutedPremiseIsUndecided) {
  // Frames that miss their windows break limits of 30 us and 2 us in the run itself; these hold there.
  const std::vector<std::string> changes{"/duration=6s", "/require/0/latency=100us", "/require/0/jitter=100us"};
  const Verification found = verify(*finding("premise-refuted.json", changes), small());
  ASSERT_EQ(found.lines.size(), 3u);
  EXPECT_EQ(found.lines[2].verdict, Conclusion::refuted);
  EXPECT_EQ(found.ledger[Assumption::clock_difference].standing, Standing::violated);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found.lines[i].verdict, Conclusion::undecided);
    EXPECT_TRUE(found.lines[i].reason.starts_with(
        "rests on \"clocks of the nodes on a way within 980ns of each other from 5s on\", which is refuted: "))
        << found.lines[i].reason;
  }
  EXPECT_EQ(found.verdict(), Conclusion::refuted);
}

// Both halves of the network are within nanoseconds of a grandmaster, each of its own, and a frame that misses its
// window waits for the next one.
TEST(Assumptions, NothingIsProvedByClocksOfTwoGrandmasters) {
  const auto resolved = finding("long-cable-gates.json", {"clocks.gptp.link_delay_threshold=800ns", "duration=13s"});
  const analysis::Bounds bounds = analysis::bound(*resolved);
  EXPECT_EQ(bounds.ledger[Assumption::clock_difference].standing, Standing::violated);
  EXPECT_FALSE(bounds.streams[0].latency);
  EXPECT_NE(
      bounds.streams[0].reason.find(
          "no gPTP comes from a to b: the link from s1 to s2 shows a delay of 10us, beyond the threshold of 800ns"),
      std::string::npos)
      << bounds.streams[0].reason;
  const Verification found = verify(*resolved, small());
  EXPECT_FALSE(found.contradiction);
  EXPECT_EQ(found.verdict(), Conclusion::refuted);
  for (const Line& line : found.lines) EXPECT_FALSE(line.bound) << line.requirement.text;
  // Over fibre there is one grandmaster, and a bound.
  EXPECT_TRUE(analysis::bound(*finding("long-cable-gates.json")).streams[0].latency);
}

TEST(Assumptions, AreAssessedFromTheScenario) {
  struct Case {
    const char* port;
    const char* more;
    Assumption assumption;
    Standing standing;
    Duration from;
  };
  const std::string gates =
      R"(, "egress": [{"to": "b", "gates": {"entries": [{"open": [6], "for": "100us"}, {"open": [0, 1], "for": "900us"}])";
  const std::string plain = gates + "}}]";
  const std::string late = gates + R"(, "base_time": "7ms"}}])";
  const Case cases[] = {
      {plain.c_str(), "", Assumption::gates_in_force, Standing::discharged, {}},
      {late.c_str(), "", Assumption::gates_in_force, Standing::discharged, 7_ms},
      {plain.c_str(),
       R"(, "faults": [{"kind": "stuck-gate", "node": "sw", "to": "b", "class": 0, "state": "closed", "at": "5ms", "for": "5ms"}])",
       Assumption::no_disturbance, Standing::discharged, 10_ms},
      {plain.c_str(),
       R"(, "faults": [{"kind": "stuck-gate", "node": "sw", "to": "b", "class": 0, "state": "closed", "at": "5ms"}])",
       Assumption::no_disturbance, Standing::violated, 5_ms},
      {plain.c_str(),
       R"(, "faults": [{"kind": "stuck-gate", "node": "sw", "to": "b", "class": 0, "state": "closed", "at": "60ms"}])",
       Assumption::no_disturbance,
       Standing::discharged,
       {}},
  };
  for (const Case& each : cases) {
    const auto resolved = small_network(each.more, each.port);
    ASSERT_TRUE(resolved);
    const analysis::AssumptionLedger ledger = analysis::bound(*resolved).ledger;
    EXPECT_EQ(ledger[each.assumption].standing, each.standing) << each.port << each.more;
    EXPECT_EQ(ledger[each.assumption].holds_from, each.from) << each.port << each.more;
    EXPECT_EQ(ledger[Assumption::drained].standing, each.from > Duration() ? Standing::open : Standing::discharged)
        << each.port << each.more;
  }
}

// One class with assumptions of every standing: the objection names the worst, and a run undoes a proof.
TEST(Assumptions, ObjectionsNameTheWorst) {
  analysis::AssumptionLedger ledger;
  analysis::Assumptions all;
  all.add(Assumption::nothing_else);
  EXPECT_EQ(ledger.objection(all, {}), "");  // a condition is none
  all.add(Assumption::drained);
  EXPECT_NE(ledger.objection(all, {}).find("which is not proved"), std::string::npos);
  ledger.discharge(Assumption::drained, "the test");
  EXPECT_EQ(ledger.objection(all, {}), "");
  ledger.state(Assumption::drained, "drained", 5_ms);
  EXPECT_NE(ledger.objection(all, 4_ms).find("from 5ms on"), std::string::npos);
  EXPECT_EQ(ledger.objection(all, 5_ms), "");
  ledger.violate(Assumption::drained, "seen in a run");
  ledger.discharge(Assumption::drained, "the test");
  EXPECT_NE(ledger.objection(all, 5_ms).find("which is refuted: seen in a run"), std::string::npos);
}

// What verify does with a bound that is wrong, and only with one that is claimed.
TEST(Assumptions, ARunAboveABoundIsAContradiction) {
  const auto resolved = small_network(R"(, "require": [{"stream": "urgent", "latency": "1ms"}])");
  scenario::Run run(*resolved);
  run.advance();
  const results::RunResult result = evaluation::evaluate(run, false);
  analysis::Bounds bounds = analysis::bound(*resolved);
  EXPECT_EQ(contradiction_in(*resolved, bounds, result), "");
  const auto urgent = std::find_if(bounds.streams.begin(), bounds.streams.end(),
                                   [](const auto& stream) { return stream.name == "urgent"; });
  urgent->latency = result.streams[urgent->index.value].latency->max - 1_ns;
  EXPECT_TRUE(contradiction_in(*resolved, bounds, result).starts_with("latency of urgent: a run took "));
  bounds.ledger.leave_open(Assumption::nothing_else, "a test");
  EXPECT_EQ(contradiction_in(*resolved, bounds, result), "");

  Verification verification;
  verification.contradiction = Contradiction{"urgent: too slow", resolved->scenario};
  EXPECT_EQ(verification.verdict(), Conclusion::contradiction);
  const std::string page = text_report("small", verification, {}, {"run.json", "bound.json"});
  EXPECT_NE(page.find("CONTRADICTION: urgent: too slow"), std::string::npos);
  EXPECT_TRUE(page.ends_with("small: contradiction\n")) << page;
  EXPECT_NE(json_report("small", verification, {}, {"run.json", "bound.json"}).find("\"run\": \"run.json\""),
            std::string::npos);
}

}  // namespace
}  // namespace takt::verify::assumptions_test
