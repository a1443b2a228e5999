// SPDX-License-Identifier: Apache-2.0
// Requirements on figures: proved by the bounds that there are, from above and from below, and what takt has no bound
// for has that as its reason.
#include <gtest/gtest.h>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"
#include "tests/questions/verify/support.hpp"
#include "verify/verification.hpp"

namespace takt::verify::figures_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT

Verification verified(const std::string& requirements, const std::string& more = {}) {
  const auto scenario = resolved(R"({"name": "two", "duration": "20ms",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch"}},
      "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}, {"ends": ["c", "sw"]}]},
    "streams": [{"name": "urgent", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms"},
                {"name": "bulk", "from": "c", "to": "b", "payload": "1400B", "pcp": 0, "every": "1ms"}],
    )" + more + R"("require": [)" +
                                 requirements + "]}");
  return verify(*scenario, small());
}

void expect_verdicts(const Verification& found, const std::vector<Conclusion>& expected) {
  ASSERT_EQ(found.lines.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(found.lines[i].verdict, expected[i]) << found.lines[i].requirement.text << ": " << found.lines[i].reason;
  EXPECT_FALSE(found.contradiction) << found.contradiction->text;
}

// The same bound as that of the stream's latency, in both spellings; 14 us are exceeded by a run.
TEST(Figures, LatenciesHaveTheBoundOfTheStream) {
  const Verification found = verified(
      R"({"stream": "urgent", "latency": "20us"}, {"figure": "latency.urgent.max", "at_most": "20us"}, {"figure": "/streams/urgent/latency_ps/p99", "at_most": "20us"},
    {"figure": "latency.urgent.max", "at_most": "14us"}, {"figure": "latency.max", "at_most": "1ms"}, {"figure": "latency.mean", "at_most": "1ms", "after": "5ms"})");
  expect_verdicts(found, {Conclusion::pass, Conclusion::pass, Conclusion::pass, Conclusion::refuted, Conclusion::pass,
                          Conclusion::pass});
  EXPECT_EQ(found.lines[1].bound, found.lines[0].bound);
  EXPECT_EQ(found.lines[1].adversarial, found.lines[0].adversarial);  // searched as well as the latency is
}

// Alone 2 x 154 octets of 8 ns, two cables and the switch; no frame is faster, and none slower than the bound.
TEST(Figures, AreBoundedFromBelow) {
  const Verification latency = verified(R"({"stream": "urgent", "latency": "20us"})");
  const std::string least = std::to_string(latency.lines[0].simulated->ps());
  const std::string more = std::to_string(latency.lines[0].simulated->ps() + 1);
  expect_verdicts(verified(R"({"figure": "latency.urgent.min", "at_least": ")" + least +
                           R"(ps"}, {"figure": "latency.urgent.min", "at_least": ")" + more + R"(ps"},
    {"figure": "latency.urgent.mean", "equal": "15us", "within": "15us"})"),
                  {Conclusion::pass, Conclusion::refuted, Conclusion::pass});
}

// 20 frames of each in 20 ms, of which the last comes early enough: 20, not 21; and none more than 21.
TEST(Figures, DeliveredAndLostFrames) {
  const Verification found = verified(
      R"({"figure": "delivered", "at_least": 40}, {"figure": "/streams/urgent/delivered", "at_least": 20}, {"figure": "/streams/urgent/delivered", "at_least": 21},
    {"figure": "/streams/urgent/delivered", "at_most": 21}, {"figure": "lost", "at_most": 0}, {"figure": "dropped", "at_most": 0}, {"figure": "/streams/bulk/dropped/queue_frames", "at_most": 0})");
  expect_verdicts(found, {Conclusion::pass, Conclusion::pass, Conclusion::refuted, Conclusion::pass, Conclusion::pass,
                          Conclusion::pass, Conclusion::pass});
  EXPECT_EQ(found.verdict(), Conclusion::refuted);
}

// One frame waits at the switch's port while the other is sent.
TEST(Figures, QueuesAndTheGraph) {
  expect_verdicts(
      verified(
          R"({"figure": "queue", "at_most": 2}, {"figure": "topology.switches", "equal": 1}, {"figure": "topology.links", "at_least": 1})"),
      {Conclusion::pass, Conclusion::pass, Conclusion::refuted});
}

// Urgent frames come every millisecond and are gone before the next one comes: one of 150 octets, which count 170 with
// preamble and gap. Of a class without streams takt says nothing.
TEST(Figures, QueuesOfClasses) {
  const Verification found = verified(
      R"({"figure": "/queues/*/frames", "at_most": 1}, {"figure": "/queues/*/octets", "only": {"node": "sw", "class": 6}, "at_most": 170},
    {"figure": "/queues/*/octets", "only": {"node": "sw", "class": 6}, "at_most": 149}, {"figure": "/queues/*/frames", "only": {"peer": "b", "class": 5}, "at_most": 1})");
  ASSERT_EQ(found.lines.size(), 4u);
  EXPECT_EQ(found.lines[0].verdict, Conclusion::pass) << found.lines[0].reason;
  EXPECT_EQ(found.lines[1].verdict, Conclusion::pass) << found.lines[1].reason;
  EXPECT_NE(found.lines[2].verdict, Conclusion::pass);
  EXPECT_EQ(found.lines[3].verdict, Conclusion::undecided);
  EXPECT_EQ(found.lines[3].reason, "takt has no bound for this figure of queues");
}

// What takt cannot bound says so, and leaves the others alone.
TEST(Figures, WithoutABoundHaveThatAsTheReason) {
  const Verification found = verified(
      R"({"figure": "events", "at_least": 1}, {"figure": "utilisation", "at_most": 1}, {"stream": "urgent", "latency": "20us"})");
  expect_verdicts(found, {Conclusion::undecided, Conclusion::undecided, Conclusion::pass});
  EXPECT_EQ(found.lines[0].reason, "takt has no bound for how many events a run has");
  EXPECT_EQ(found.lines[1].reason, "takt has no bound for this figure of ports");
}

// Where frames may be lost, the least number of those that come is 0, and the reason is that of the loss.
TEST(Figures, LossesTakeTheBoundsAway) {
  const Verification found = verified(
      R"({"figure": "/streams/urgent/delivered", "at_least": 10}, {"figure": "lost", "at_most": 3}, {"figure": "latency.urgent.max", "at_most": "20us"})",
      R"("faults": [{"kind": "link-down", "link": ["a", "sw"], "at": "5ms", "for": "2ms"}], )");
  expect_verdicts(found, {Conclusion::undecided, Conclusion::undecided, Conclusion::pass});
  EXPECT_NE(found.lines[1].reason.find("goes down"), std::string::npos) << found.lines[1].reason;
}

// A reaction by its figure has the bound of the reaction, and violations are none where the invariants are proved.
TEST(Figures, OfPrograms) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(R"({"name": "pair", "duration": "60ms",
    "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host"}}, "links": [{"ends": ["m", "s"]}]},
    "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "1ms"}],
    "script": [{"at": "2ms", "program": "p", "call": "Start"}, {"at": "40ms", "program": "p", "call": "Halt"}],
    "require": [{"reaction": "halt", "within": "5ms"}, {"figure": "reaction.halt.max", "at_most": "5ms"}, {"figure": "reaction.halt.max", "at_most": "500us"}, {"figure": "violations", "at_most": 0},
                {"figure": "reaction.halt.count", "at_least": 1}]})",
                                            "test", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  const Verification found = verify(*resolved, small());
  expect_verdicts(found, {Conclusion::pass, Conclusion::pass, Conclusion::refuted, Conclusion::pass,
                          Conclusion::undecided, Conclusion::pass});
  EXPECT_EQ(found.lines[1].bound, found.lines[0].bound);
  EXPECT_EQ(found.lines[1].adversarial, found.lines[0].adversarial);
  EXPECT_EQ(found.lines[4].reason, "takt has no bound for this figure of Programs");
}

// The worst run of a figure that is not tight is taken apart as that of the latency is.
TEST(Figures, SayWhatTheirBoundGivesAway) {
  json::Diagnostics diagnostics;
  const auto resolved =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/scenarios/validation/cut-through.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  scenario::Scenario asked = resolved->scenario;
  scenario::Requirement requirement;
  requirement.figure = "latency.frames.max";
  requirement.at_most.emplace();
  requirement.at_most->node = json::Node::of_string("1ms");
  asked.require = {requirement};
  const auto again = scenario::resolve(asked, diagnostics);
  ASSERT_TRUE(again) << diagnostics.to_text();
  const Verification found = verify(*again, small());
  ASSERT_FALSE(found.lines.empty());
  ASSERT_FALSE(found.lines[0].slack.empty());
  EXPECT_EQ(found.lines[0].slack[0].where, "switch1:1");
}

}  // namespace
}  // namespace takt::verify::figures_test
