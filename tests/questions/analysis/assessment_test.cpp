// SPDX-License-Identifier: Apache-2.0
// What bounds rest on, in small scenarios: each assumption with what discharges it, leaves it open or violates it, and
// the instant from which it holds.
#include "analysis/assessment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"

namespace takt::analysis::assessment_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT
using A = Assumption;

std::unique_ptr<scenario::Resolved> load(const std::string& text) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "assessed.json", {}, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return resolved;
}

/// a and c send to b over the switch sw; `host` goes into a, `port` into sw, `more` into the scenario.
std::unique_ptr<scenario::Resolved> star(const std::string& more, const std::string& port = {},
                                         const std::string& host = {}) {
  return load(R"({"name": "star", "duration": "50ms", "network": {"nodes": {"a": {"kind": "host")" + host +
              R"(}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch")" + port +
              R"(}}, "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}, {"ends": ["c", "sw"]}]},
    "streams": [{"name": "urgent", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms"}, {"name": "bulk", "from": "c", "to": "b", "payload": "1400B", "pcp": 0, "every": "1ms"}])" +
              more + "}");
}

std::vector<A> rests_on(const scenario::Resolved& resolved) { return bound(resolved).streams.at(0).assumptions.list(); }

const std::string window = R"("gates": {"entries": [{"open": [6], "for": "100us"}, {"open": [0, 1], "for": "900us"}])";
const std::string exchange = R"(, "script": [{"at": "10ms", "set_gates": {"node": "sw", "to": "b", )" + window;
const std::string stuck =
    R"(, "faults": [{"kind": "stuck-gate", "node": "sw", "to": "b", "class": 0, "state": "closed", "at": "5ms", "for": "5ms"}])";

// Everything a scenario can bring in, one at a time: what rests on it then, and on nothing else.
TEST(Assessment, WhatBoundsRestOn) {
  struct Case {
    std::string more;
    std::string port;
    std::string host;
    std::vector<A> wanted;
  };
  const Case cases[] = {
      {"", "", "", {A::nothing_else}},
      {"", "", R"(, "os": {"transmit": {"uniform": {"from": "1us", "to": "9us"}}})", {A::nothing_else, A::os_latency}},
      {"", "", R"(, "os": {"receive": {"uniform": {"from": "1us", "to": "9us"}}})", {A::nothing_else, A::os_latency}},
      {"", "", R"(, "os": {"wake_up": {"uniform": {"from": "1us", "to": "9us"}}})", {A::nothing_else, A::os_latency}},
      {"", "", R"(, "os": {"transmit": "9us", "receive": "1us"})", {A::nothing_else}},
      {R"(, "faults": [{"kind": "crash", "node": "c", "at": "5ms"}])",
       "",
       "",
       {A::nothing_else, A::listed_faults_only}},
      {R"(, "clocks": {"all": {"offset": "10ppm"}})", "", "", {A::nothing_else, A::clock_rate}},
      {R"(, "clocks": {"all": {"offset": "10ppm"}, "gptp": {}})",
       "",
       "",
       {A::nothing_else, A::clock_rate, A::clock_difference, A::gptp_traffic, A::drained}},
      {"", R"(, "egress": [{"to": "b", )" + window + "}}]", "", {A::nothing_else}},
      {"",
       R"(, "egress": [{"to": "b", )" + window + R"(, "base_time": "7ms"}}])",
       "",
       {A::nothing_else, A::gates_in_force, A::drained}},
      {exchange + "}}}]",
       R"(, "egress": [{"to": "b", )" + window + "}}]",
       "",
       {A::nothing_else, A::gates_do_not_change, A::drained}},
      {stuck,
       R"(, "egress": [{"to": "b", )" + window + "}}]",
       "",
       {A::nothing_else, A::listed_faults_only, A::no_disturbance, A::drained}},
      {R"(, "clocks": {"all": {"offset": "10ppm"}}, "faults": [{"kind": "clock", "node": "a", "at": "5ms", "step": "10us"}])",
       "",
       "",
       {A::nothing_else, A::listed_faults_only, A::clock_rate, A::no_disturbance, A::drained}},
  };
  for (const Case& each : cases)
    EXPECT_EQ(rests_on(*star(each.more, each.port, each.host)), each.wanted) << each.more << each.port << each.host;
}

TEST(Assessment, WhoPublishesOnChangeDoesSoSeldom) {
  const std::string program =
      R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms", "publish": ")";
  EXPECT_EQ(rests_on(*star(program + R"(cyclic"}])")), (std::vector{A::nothing_else}));
  EXPECT_EQ(rests_on(*star(program + R"(on-change"}])")), (std::vector{A::nothing_else, A::program_publishes}));
}

// Only the plant can keep these; all others a run may contradict.
TEST(Assessment, ConditionsAreThoseOfThePlant) {
  std::vector<A> conditions;
  for (unsigned i = 0; i < static_cast<unsigned>(A::count); ++i)
    if (is_condition(static_cast<A>(i))) conditions.push_back(static_cast<A>(i));
  EXPECT_EQ(conditions, (std::vector{A::nothing_else, A::listed_faults_only, A::os_latency, A::execution_times,
                                     A::clock_rate, A::gptp_traffic, A::initialisation}));
  const AssumptionLedger ledger;
  for (unsigned i = 0; i < static_cast<unsigned>(A::count); ++i)
    EXPECT_EQ(ledger[static_cast<A>(i)].standing,
              is_condition(static_cast<A>(i)) ? Standing::condition : Standing::open)
        << i;
}

TEST(Assessment, WhatIsViolatedStaysSo) {
  AssumptionLedger ledger;
  ledger.violate(A::no_loss, "a run");
  ledger.leave_open(A::no_loss, "nobody knows");
  ledger.discharge(A::no_loss, "a proof");
  ledger.violate(A::no_loss, "another run");
  EXPECT_EQ(ledger[A::no_loss].standing, Standing::violated);
  EXPECT_EQ(ledger[A::no_loss].why, "a run");
}

std::unique_ptr<scenario::Resolved> synchronised(const std::string& require) {
  return star(R"(, "clocks": {"all": {"offset": "10ppm"}, "gptp": {}}, "require": [)" + require + "]");
}

// Of several requirements the weakest is the premise: it follows from each other one, from whenever that holds. One on
// a single node says nothing of all.
TEST(Assessment, ThePremiseOnClocksIsTheWeakestRequirement) {
  struct Case {
    const char* require;
    Duration error;
    Duration after;
    std::optional<std::size_t> requirement;
  };
  const Case cases[] = {
      {"", 1_us, {}, {}},
      {R"({"sync": "2us", "after": "20ms"})", 2_us, 20_ms, 0},
      {R"({"sync": "2us", "after": "20ms"}, {"sync": "3us", "after": "10ms"})", 3_us, 10_ms, 1},
      {R"({"sync": "3us", "after": "20ms"}, {"sync": "2us", "after": "10ms"})", 3_us, 10_ms, 0},
      {R"({"sync": "2us", "after": "20ms"}, {"sync": "5us", "node": "a", "after": "10ms"})", 2_us, 20_ms, 0},
      {R"({"sync": "5us", "node": "a", "after": "10ms"})", 1_us, {}, {}},
  };
  for (const Case& each : cases) {
    const auto resolved = synchronised(each.require);
    const ClockPremise premise = clock_premise(*resolved, {});
    EXPECT_EQ(premise.error, each.error) << each.require;
    EXPECT_EQ(premise.after, each.after) << each.require;
    EXPECT_EQ(premise.requirement, each.requirement) << each.require;
    const AssumptionLedger ledger = bound(*resolved).ledger;
    EXPECT_EQ(ledger[A::clock_difference].standing, Standing::open) << each.require;  // it is simulated, not bounded
    EXPECT_EQ(ledger[A::clock_difference].holds_from, each.after) << each.require;
  }
}

// A difference of two clocks is twice the error of each from the middle between them.
TEST(Assessment, ThePremiseOnClocksMayBeADifference) {
  const std::pair<const char*, std::optional<Duration>> cases[] = {
      {R"({"clocks": "*", "within": "3us", "after": "10ms"})", 1'500_ns},
      {R"({"clocks": ["a", "b", "c", "sw"], "within": "3us", "after": "10ms"})", 1'500_ns},
      {R"({"clocks": ["a", "b"], "within": "3us", "after": "10ms"})",
       std::nullopt},  // of some nodes on ways nothing is said
      {R"({"clocks": "*", "within": "3us", "after": "10ms"}, {"sync": "2us", "after": "20ms"})", 2_us},
  };
  for (const auto& [require, error] : cases) {
    const ClockPremise premise = clock_premise(*synchronised(require), {});
    EXPECT_EQ(premise.requirement.has_value(), error.has_value()) << require;
    if (!error) continue;
    EXPECT_EQ(premise.error, *error) << require;
    EXPECT_EQ(premise.after, 10_ms) << require;
  }
  EXPECT_EQ(bound(*synchronised(cases[0].first)).ledger[A::clock_difference].text,
            "clocks of the nodes on a way within 3us of each other from 10ms on");
}

TEST(Assessment, ClocksOfTwoGrandmastersOnAWayAreNoPremise) {
  const auto ledger = [](const char* gptp) {
    return bound(*star(std::string(R"(, "clocks": {"all": {"offset": "10ppm"}, "gptp": )") + gptp +
                       R"(}, "require": [{"sync": "1us"}])"))
        .ledger;
  };
  EXPECT_EQ(ledger(R"({"link_delay_threshold": "1ns"})")[A::clock_difference].standing, Standing::violated);
  EXPECT_EQ(ledger(R"({})")[A::clock_difference].standing, Standing::open);
  EXPECT_EQ(ledger(R"({"without": ["sw"]})")[A::clock_difference].standing,
            Standing::violated);  // a node between that hands nothing on
}

TEST(Assessment, WhatHoldsFromWhenOn) {
  struct Case {
    std::string more;
    std::string port;
    A assumption;
    Standing standing;
    Duration from;
  };
  const std::string gated = R"(, "egress": [{"to": "b", )" + window + "}}]";
  const std::string stream_gate =
      R"(, "ingress": {"filters": [{"stream": "urgent", "gate": "g"}], "gates": [{"name": "g", "base_time": "6ms", "entries": [{"open": true, "for": "1ms"}]}]})";
  const std::string clocks =
      R"(, "clocks": {"all": {"offset": "10ppm"}}, "faults": [{"kind": "clock", "node": "a", "at": "5ms", )";
  const Case cases[] = {
      {"", stream_gate, A::gates_in_force, Standing::discharged, 6_ms},
      {exchange + "}}}]", gated, A::gates_do_not_change, Standing::discharged, 10_ms},
      {exchange + R"(, "base_time": "12ms"}}}])", gated, A::gates_do_not_change, Standing::discharged, 12_ms},
      {clocks + R"("step": "10us"}])", "", A::no_disturbance, Standing::discharged, 5_ms},
      {clocks + R"("offset": "20ppm"}])", "", A::no_disturbance, Standing::violated, 5_ms},
  };
  for (const Case& each : cases) {
    const AssumptionLedger ledger = bound(*star(each.more, each.port)).ledger;
    EXPECT_EQ(ledger[each.assumption].standing, each.standing) << each.more << each.port;
    EXPECT_EQ(ledger[each.assumption].holds_from, each.from) << each.more << each.port;
    // What was sent before is still under way, nobody knows how long.
    EXPECT_EQ(ledger[A::drained].standing, Standing::open) << each.more << each.port;
    EXPECT_EQ(ledger[A::drained].holds_from, each.from) << each.more << each.port;
  }
  const AssumptionLedger clocks_from_20ms = bound(*synchronised(R"({"sync": "2us", "after": "20ms"})")).ledger;
  EXPECT_EQ(clocks_from_20ms[A::drained].holds_from, 20_ms);
  EXPECT_EQ(bound(*star("")).ledger[A::drained].standing, Standing::discharged);
}

// A base time is an instant of the node's own clock: one that is slow shows it later, one that begins ahead has passed
// it already.
TEST(Assessment, GatesBeginWhenTheClockOfTheirNodeSaysSo) {
  const auto begins = [](const std::string& clock, const std::string& base_time) {
    const std::string gate =
        R"(, "ingress": {"filters": [{"stream": "urgent", "gate": "g"}], "gates": [{"name": "g", "base_time": ")" +
        base_time + R"(", "entries": [{"open": true, "for": "1ms"}]}]})";
    return bound(*star(R"(, "clocks": {"all": {)" + clock + "}}", gate)).ledger[A::gates_in_force].holds_from;
  };
  const sim::Duration slow = begins(R"("offset": "-1000ppm")", "6ms");  // 6 ms / 0.999
  EXPECT_GE(slow, 6'006'006_ns);
  EXPECT_LT(slow, 6'006'010_ns);
  const sim::Duration either = begins(R"("offset": {"from": "-1000ppm", "to": "1000ppm"})", "6ms");
  EXPECT_EQ(either, slow);
  EXPECT_EQ(begins(R"("offset": "0ppm", "initial": "2300us")", "0ms") / 1_us, 700);
  EXPECT_EQ(begins(R"("offset": "0ppm", "initial": "-3ms")", "6ms") / 1_us, 9'000);
  // One that has been running since before the start is in force then, unless a clock that is behind shows its base
  // time later.
  EXPECT_EQ(begins(R"("offset": "0ppm")", "-300us") / 1_us, 700);
  EXPECT_EQ(begins(R"("offset": "0ppm")", R"(-300us", "running": true, "extension": "0us)"), 0_us);
  EXPECT_EQ(begins(R"("offset": "-1000ppm", "initial": "2300us")", R"(-300us", "running": true, "extension": "0us)"),
            0_us);
  EXPECT_EQ(begins(R"("offset": "0ppm", "initial": "-3ms")", R"(-1ms", "running": true, "extension": "0us)") / 1_us,
            2'000);
  const std::string late = exchange + R"(, "base_time": "12ms"}}}], "clocks": {"all": {"offset": "-1000ppm"}})";
  EXPECT_GE(
      bound(*star(late, R"(, "egress": [{"to": "b", )" + window + "}}]")).ledger[A::gates_do_not_change].holds_from,
      12'012'012_ns);
  // What a clock of unknown rate shows when a list is read is not known: one whose base time is past may have to wait
  // for a whole cycle.
  const std::string past =
      exchange + R"(, "base_time": "1ms"}}}], "clocks": {"all": {"offset": {"from": "-1000ppm", "to": "1000ppm"}}})";
  EXPECT_GE(
      bound(*star(past, R"(, "egress": [{"to": "b", )" + window + "}}]")).ledger[A::gates_do_not_change].holds_from,
      10_ms + 1_ms);
}

// A clock that goes at another frequency is not as the bounds take it: they promise nothing.
TEST(Assessment, WhatTheScenarioContradictsIsWithdrawn) {
  const Bounds bounds = bound(*star(
      R"(, "clocks": {"all": {"offset": "10ppm"}}, "faults": [{"kind": "clock", "node": "a", "at": "5ms", "offset": "20ppm"}], "require": [{"stream": "urgent", "latency": "1ms", "dropped": 0}])"));
  EXPECT_FALSE(bounds.streams[0].latency);
  EXPECT_FALSE(bounds.streams[0].by_listener.at(0));
  EXPECT_FALSE(bounds.streams[0].loses_nothing);
  EXPECT_FALSE(bounds.requirements.at(0).duration);
  EXPECT_FALSE(bounds.requirements.at(1).count);
  EXPECT_NE(bounds.streams[0].reason.find("gets another frequency"), std::string::npos) << bounds.streams[0].reason;
}

// A talker at s1, of which the links to s2, s3 and s4 fail in turns, two at a time: frames go to the third one, and
// from there to the others. While entries change a frame may so go from s2 to s3, to s4, and to s2 again.
TEST(Assessment, FramesThatMayGoInCircles) {
  std::string faults;
  const auto cut = [&](const char* one, const char* other, const char* at) {
    for (const char* const to : {one, other})
      faults += (faults.empty() ? "" : ", ") + std::string(R"({"kind": "link-down", "link": ["s1", ")") + to +
                R"("], "at": ")" + at + R"(", "for": "5ms"})";
  };
  cut("s3", "s4", "10ms");
  cut("s2", "s4", "20ms");
  const auto bounds = [&] {
    return bound(*load(
        R"({"name": "mesh", "duration": "50ms", "network": {"nodes": {"h1": {"kind": "host"}, "h2": {"kind": "host"}, "h3": {"kind": "host"}, "h4": {"kind": "host"},
      "s1": {"kind": "switch"}, "s2": {"kind": "switch"}, "s3": {"kind": "switch"}, "s4": {"kind": "switch"}},
      "links": [{"ends": ["h1", "s1"]}, {"ends": ["h2", "s2"]}, {"ends": ["h3", "s3"]}, {"ends": ["h4", "s4"]}, {"ends": ["s1", "s2"]}, {"ends": ["s1", "s3"]}, {"ends": ["s1", "s4"]},
                {"ends": ["s2", "s3"]}, {"ends": ["s3", "s4"]}, {"ends": ["s4", "s2"]}]},
      "streams": [{"name": "s", "from": "h1", "to": ["h2", "h3", "h4"], "payload": "100B", "every": "1ms"}], "rerouting": "1ms", "faults": [)" +
        faults + "]}"));
  };
  const Bounds twice = bounds();
  EXPECT_EQ(twice.ledger[A::no_disturbance].standing, Standing::discharged);
  EXPECT_TRUE(twice.streams[0].latency) << twice.streams[0].reason;
  EXPECT_FALSE(twice.streams[0].assumptions.contains(A::no_disturbance));
  cut("s2", "s3", "30ms");
  const Bounds thrice = bounds();
  EXPECT_EQ(thrice.ledger[A::no_disturbance].standing, Standing::violated);
  EXPECT_TRUE(thrice.streams[0].assumptions.contains(A::no_disturbance));
  EXPECT_FALSE(thrice.streams[0].latency);
  EXPECT_NE(thrice.streams[0].reason.find("may go in circles"), std::string::npos) << thrice.streams[0].reason;
}

// By what frames may be lost, and by nothing else.
TEST(Assessment, WhatLosesFrames) {
  const auto urgent = [](const std::string& more, const std::string& port = {}, const std::string& host = {}) {
    const Bounds bounds = bound(*star(more, port, host));
    return std::pair(bounds.streams[0].loses_nothing, bounds.streams[0].loses_by_faults_only);
  };
  using Pair = std::pair<bool, bool>;
  const std::string fault = R"(, "faults": [{"at": "5ms", )";
  EXPECT_EQ(urgent(""), Pair(true, true));
  EXPECT_EQ(urgent(fault + R"("kind": "link-down", "link": ["sw", "b"]}])"), Pair(false, true));
  EXPECT_EQ(urgent(fault + R"("kind": "link-down", "link": ["c", "sw"]}])"), Pair(true, true));
  EXPECT_EQ(urgent(fault + R"("kind": "crash", "node": "sw"}])"), Pair(false, true));
  EXPECT_EQ(urgent(fault + R"("kind": "crash", "node": "c"}])"), Pair(true, true));
  EXPECT_EQ(urgent(fault + R"("kind": "frame-errors", "link": ["a", "sw"], "loss": 0.001}])"), Pair(false, true));
  EXPECT_EQ(urgent(fault + R"("kind": "frame-errors", "link": ["a", "sw"], "corruption": 0.001}])"), Pair(false, true));
  EXPECT_EQ(urgent(fault + R"("kind": "frame-errors", "link": ["c", "sw"], "loss": 0.001}])"), Pair(true, true));
  // 100 octets, and 28 of IP and UDP.
  EXPECT_EQ(urgent("", R"(, "egress": [{"to": "b", "max_sdu": [{"class": 6, "size": "128B"}]}])"), Pair(true, true));
  EXPECT_EQ(urgent("", R"(, "egress": [{"to": "b", "max_sdu": [{"class": 6, "size": "127B"}]}])"), Pair(false, false));
}

// At sw two frames of class 6 may meet: 150 octets each from DA to FCS, with preamble and gap 340 octets.
TEST(Assessment, WhatQueuesHaveRoomFor) {
  const auto has_room = [](const std::string& queues) {
    auto resolved = load(
        R"({"name": "meet", "duration": "50ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "sw": {"kind": "switch", "queues": )" +
        queues +
        R"(}}, "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}, {"ends": ["c", "sw"]}]},
      "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms"}, {"name": "y", "from": "c", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms"}]})");
    const Bounds bounds = bound(*resolved);
    EXPECT_EQ(bounds.streams[0].loses_nothing, bounds.streams[1].loses_nothing);
    EXPECT_EQ(bounds.streams[0].loses_nothing ||
                  bounds.streams[0].loss_reason.starts_with("a full queue may drop frames at sw:"),
              true)
        << bounds.streams[0].loss_reason;
    return bounds.streams[0].loses_nothing;
  };
  EXPECT_TRUE(has_room(R"({"frames": 2})"));
  EXPECT_FALSE(has_room(R"({"frames": 1})"));
  EXPECT_TRUE(has_room(R"({"octets": "350B"})"));
  EXPECT_FALSE(has_room(R"({"octets": "250B"})"));
}

StreamBound safety_of(const scenario::Resolved& resolved) {
  const Bounds bounds = bound(resolved);
  return *std::find_if(bounds.streams.begin(), bounds.streams.end(),
                       [](const StreamBound& each) { return each.name == "safety"; });
}

// Copies of a redundant stream are dropped whenever all goes well; frames that come after their launch times always
// are.
TEST(Assessment, WhatIsDroppedByIntention) {
  const auto launched = [](const std::string& os) {
    return bound(
               *load(
                   R"({"name": "launch", "duration": "50ms", "network": {"nodes": {"a": {"kind": "host", "os": {"transmit": )" +
                   os + R"(}}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
      "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "launch": "20us"}]})"))
        .streams[0]
        .loses_nothing;
  };
  EXPECT_TRUE(launched("\"20us\""));
  EXPECT_FALSE(launched("\"21us\""));
  json::Diagnostics diagnostics;
  const auto redundant =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/redundancy-dropped.json", {}, diagnostics);
  ASSERT_TRUE(redundant) << diagnostics.to_text();
  EXPECT_FALSE(safety_of(*redundant).loses_nothing);
  const auto healthy = scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/redundancy-dropped.json",
                                           {"faults=[]"}, diagnostics);
  ASSERT_TRUE(healthy) << diagnostics.to_text();
  EXPECT_FALSE(safety_of(*healthy).loses_nothing);
  EXPECT_EQ(safety_of(*healthy).loss_reason, "copies of a redundant stream are dropped");
}

// A frame that is handed over after its launch time is lost then, and was under way until then: older than a limit on
// the latency, it breaks it.
TEST(Assessment, WhoMissesTheLaunchTimeIsUnderWayUntilThen) {
  const auto latency = [](const std::string& most) {
    return bound(
               *load(
                   R"({"name": "launch", "duration": "50ms", "network": {"nodes": {"a": {"kind": "host", "os": {"transmit": {"uniform": {"from": "1us", "to": ")" +
                   most + R"("}}}}, "b": {"kind": "host"}},
      "links": [{"ends": ["a", "b"]}]}, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "10ms", "launch": "20us"}]})"))
        .streams[0]
        .latency;
  };
  EXPECT_LT(latency("20us"), 22_us);
  EXPECT_GE(latency("5ms"), 5_ms);
}

// (8 + 150) octets of 8 ns over each of two cables of 50 ns, and what the receiver's operating system takes.
TEST(Assessment, ReceiversTakeTime) {
  const auto resolved = load(
      R"({"name": "receive", "duration": "50ms", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host", "os": {"receive": {"uniform": {"from": "2us", "to": "5us"}}}}, "sw": {"kind": "switch"}},
    "links": [{"ends": ["a", "sw"]}, {"ends": ["sw", "b"]}]}, "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "pcp": 6, "every": "1ms"}],
    "require": [{"stream": "s", "jitter": "1us"}]})");
  const Bounds bounds = bound(*resolved);
  EXPECT_EQ(bounds.streams[0].least, 2 * (158 * 8_ns + 50_ns) + 2_us);
  EXPECT_EQ(bounds.streams[0].latency, 2 * (158 * 8_ns + 50_ns) + 5_us);
  EXPECT_EQ(bounds.requirements.at(0).duration, 3_us);
}

}  // namespace
}  // namespace takt::analysis::assessment_test
