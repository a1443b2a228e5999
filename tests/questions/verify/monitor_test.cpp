// SPDX-License-Identifier: Apache-2.0
// Runs that contradict an assumption or a bound, each made so that it does.
#include "verify/monitor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "evaluation/evaluate.hpp"
#include "scenario/run/run.hpp"
#include "tests/questions/verify/support.hpp"

namespace takt::verify::monitor_test {
namespace {

using analysis::Assumption;
using sim::Duration;
using namespace sim::literals;  // NOLINT

/// A run to its end.
struct Watched {
  std::unique_ptr<scenario::Resolved> resolved;
  std::unique_ptr<scenario::Run> run;
  results::RunResult result;
  analysis::Bounds bounds;

  explicit Watched(const std::string& text) : resolved(verify::resolved(text)) {
    run = std::make_unique<scenario::Run>(*resolved);
    run->advance();
    result = evaluation::evaluate(*run, false);
    bounds = analysis::bound(*resolved);
  }
  std::string violated(Assumption assumption) const {
    for (const Violation& each : violations_in(*run, result))
      if (each.assumption == assumption) return each.witness;
    return {};
  }
  std::string contradiction() const { return contradiction_in(*resolved, bounds, result); }
};

std::string cell(const std::string& program, const std::string& more) {
  return R"({"name": "cell", "duration": "100ms", "seed": 7, "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host"}}, "links": [{"ends": ["m", "s"]}]},
    "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "1ms", "initialisation": "0s")" +
         program + "}]" + more + "}";
}

// The word of 10 ms, which is on the cable when it is cut, and that of 11 ms; those of the slave have other phases.
TEST(Monitor, AWordThatIsLost) {
  const std::string cut = R"(, "faults": [{"kind": "link-down", "link": ["m", "s"], "at": "10.0001ms", "for": "1ms"}])";
  EXPECT_EQ(Watched(cell("", "")).violated(Assumption::no_loss), "");
  EXPECT_EQ(Watched(cell("", cut)).violated(Assumption::no_loss), "2 of p/state/m were lost in a run with seed 7");
  // Before the warm-up, too: invariants have none.
  EXPECT_EQ(Watched(cell("", cut + R"(, "warm_up": "50ms")")).violated(Assumption::no_loss),
            "2 of p/state/m were lost in a run with seed 7");
}

// Start, halt, reset and start again within a cycle of 10 ms.
TEST(Monitor, WhoChangesMoreOftenInACycle) {
  std::string calls;
  int at = 10'000;
  for (const char* const call : {"Start", "Halt", "Reset", "Start", "Halt"})
    calls += (calls.empty() ? "" : ", ") + std::string(R"({"at": ")") + std::to_string(at += 300) +
             R"(us", "program": "p", "call": ")" + call + "\"}";
  const std::string script = R"(, "script": [)" + calls + "]";
  const auto text = [&](const std::string& cycle, const std::string& publish) {
    std::string made = cell(R"(, "publish": ")" + publish + "\"", script);
    return made.replace(made.find("1ms\", \"init"), 3, cycle);
  };
  EXPECT_NE(Watched(text("10ms", "on-change"))
                .violated(Assumption::program_publishes)
                .find("changes more often in a cycle at "),
            std::string::npos);
  EXPECT_EQ(Watched(text("100us", "on-change")).violated(Assumption::program_publishes), "");
  EXPECT_EQ(Watched(text("10ms", "cyclic")).violated(Assumption::program_publishes),
            "");  // who publishes each cycle does so once
}

const char* const two_hosts =
    R"({"name": "two", "duration": "10ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
  "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}]})";

TEST(Monitor, RunsThatABoundExcludes) {
  Watched seen(two_hosts);
  EXPECT_EQ(seen.contradiction(), "");
  const Duration latency = seen.result.streams[0].latency->max;  // of every frame
  analysis::StreamBound& bound = seen.bounds.streams[0];
  const analysis::StreamBound right = bound;
  bound.latency = latency - 1_ns;
  EXPECT_TRUE(seen.contradiction().starts_with("latency of s: a run took ")) << seen.contradiction();
  bound = right;
  bound.least = latency + 1_ns;
  EXPECT_TRUE(seen.contradiction().starts_with("fastest frame of s: a run took ")) << seen.contradiction();
  bound = right;
  seen.result.streams[0].lost = 2;
  EXPECT_EQ(seen.contradiction(), "s: a run lost 2 frames, though nothing can be lost");
  bound.reaches_all = false;
  EXPECT_EQ(seen.contradiction(), "");
  // What is not claimed is not contradicted.
  bound = right;
  seen.bounds.ledger.leave_open(Assumption::nothing_else, "a test");
  EXPECT_EQ(seen.contradiction(), "");
}

TEST(Monitor, AReactionThatABoundExcludes) {
  Watched seen(cell(
      "",
      R"(, "script": [{"at": "10ms", "program": "p", "call": "Start"}], "require": [{"reaction": "start", "within": "50ms"}])"));
  EXPECT_EQ(seen.contradiction(), "");
  ASSERT_TRUE(seen.result.requirements.at(0).measured);
  seen.bounds.requirements.at(0).duration = *seen.result.requirements[0].measured - 1_ns;
  EXPECT_TRUE(seen.contradiction().starts_with("reaction start within 50ms: a run took ")) << seen.contradiction();
}

TEST(Monitor, ClocksThatAreWorseThanRequired) {
  const auto clocks = [](const char* limit) {
    return std::string(
               R"({"name": "clocks", "duration": "3s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
      "clocks": {"all": {"offset": "10ppm"}, "nodes": {"b": {"offset": "-10ppm"}}, "gptp": {}}, "require": [{"sync": ")") +
           limit + R"(", "after": "2s"}]})";
  };
  EXPECT_EQ(Watched(clocks("1ms")).violated(Assumption::clock_difference), "");
  EXPECT_NE(Watched(clocks("1ps")).violated(Assumption::clock_difference).find(" in a run with seed "),
            std::string::npos);
}

// What bounds rest on is the difference of clocks on a way: 20 ppm apart, of which gPTP leaves some ns.
TEST(Monitor, ClocksOnAWayThatDifferByMoreThanBoundsReckonWith) {
  const auto clocks = [](const char* limit) {
    return std::string(
               R"({"name": "clocks", "duration": "3s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
      "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}],
      "clocks": {"all": {"offset": "10ppm"}, "nodes": {"b": {"offset": "-10ppm"}}, "gptp": {}}, "require": [{"clocks": "*", "within": ")") +
           limit + R"(", "after": "2s"}]})";
  };
  EXPECT_EQ(Watched(clocks("1ms")).violated(Assumption::clock_difference), "");
  const std::string why = Watched(clocks("1ps")).violated(Assumption::clock_difference);
  EXPECT_NE(why.find(" ahead of "), std::string::npos) << why;
  EXPECT_NE(why.find(" in a run with seed "), std::string::npos) << why;
}

}  // namespace
}  // namespace takt::verify::monitor_test
