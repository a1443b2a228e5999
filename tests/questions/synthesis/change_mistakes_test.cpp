// SPDX-License-Identifier: Apache-2.0
// What a change of a scheduled scenario refuses, and what it cannot decide.
#include <gtest/gtest.h>

#include <algorithm>

#include "json/document.hpp"
#include "json/fields.hpp"
#include "random_plant.hpp"
#include "synthesis/change_report.hpp"
#include "synthesis/scenario_change.hpp"

namespace takt::synthesis::change_mistakes_test {
namespace {

using scenario::Scenario;
using scenario::Stream;
using sim::Duration;
using test::scenario_of;
using test::scheduled;

constexpr Duration us(std::int64_t n) { return Duration::from_ps(n * 1'000'000); }

/// A ring of four switches with a host each.
std::string ring(const std::string& streams, const std::string& more = "",
                 const std::string& gates = R"({"plan": "auto", "classes": [6]})") {
  return R"({"name": "ring", "duration": "10ms", "network": {"generate": [{"topology": "ring", "switches": 4, "forwarding_delay": "1us"}]}, "gates": )" +
         gates + R"(, "streams": [)" + streams + "]" + more + "}";
}
std::string stream(const std::string& name, const std::string& from, const std::string& to,
                   const std::string& more = R"(, "offset": "auto")", const std::string& every = "500us",
                   const std::string& payload = "100B") {
  return R"({"name": ")" + name + R"(", "from": ")" + from + R"(", "to": ")" + to + R"(", "payload": ")" + payload +
         R"(", "every": ")" + every + R"(", "pcp": 6)" + more + "}";
}
const std::string two = stream("a", "h1", "h2") + ", " + stream("b", "h3", "h2");

std::vector<Stream> coming(const std::string& streams) {
  json::Diagnostics diagnostics;
  ComingStreams read;
  const auto document = json::parse(R"({"streams": [)" + streams + "]}", "coming.json", diagnostics);
  EXPECT_TRUE(document && json::decode(*document, read, diagnostics)) << diagnostics.to_text();
  return read.streams;
}

AskedChanges asked(std::vector<Stream> add, std::vector<std::string> remove = {}, std::vector<std::string> fail = {}) {
  AskedChanges made;
  made.add = std::move(add);
  made.remove = std::move(remove);
  made.fail = std::move(fail);
  made.lead = us(1'000);
  return made;
}

/// What is told; empty: an answer.
std::string told(const Scenario& running, const AskedChanges& asked,
                 const std::optional<Scenario>& plant = std::nullopt) {
  json::Diagnostics diagnostics;
  const auto answer = change_scenario(running, plant, asked, diagnostics);
  EXPECT_EQ(answer.has_value(), !diagnostics.has_errors());
  return diagnostics.to_text();
}

TEST(ChangeMistakes, NamesThatAreNone) {
  const Scenario running = scheduled(scenario_of(ring(two)));
  EXPECT_EQ(told(running, asked({}, {"aa", "b", "b"}, {"sw1>sw3", "sw9"})),
            "--fail: error: nothing that can fail: found \"sw1>sw3\", expected a node, or the two ends of a link such "
            "as \"sw1>sw2\" (did you mean \"sw1>sw2\"?)\n"
            "--fail: error: nothing that can fail: found \"sw9\", expected a node, or the two ends of a link such as "
            "\"sw1>sw2\" (did you mean \"sw1\"?)\n"
            "--remove: error: no stream with windows: found \"aa\", expected a stream of a scheduled class (did you "
            "mean \"a\"?)\n"
            "--remove: error: a stream that goes twice: found \"b\" a second time, expected it once\n");
}

TEST(ChangeMistakes, StreamsThatCannotCome) {
  const Scenario running = scheduled(scenario_of(ring(two)));
  EXPECT_EQ(told(running, asked(coming(stream("a", "h1", "h2")))),
            "coming.json:1:23: error at /streams/0/name: duplicate name: found \"a\" a second time, expected a name of "
            "its own for each stream, program and application\n");
  EXPECT_EQ(told(running, asked(coming(stream("b", "h1", "h2")), {"b"})),
            "coming.json:1:23: error at /streams/0/name: a stream that goes and comes: found \"b\" in --remove and in "
            "--add, expected another name\n");
  EXPECT_EQ(told(running, asked(coming(stream("c", "h1", "h9")))),
            "coming.json:1:48: error at /streams/0/to: unknown node: found \"h9\", expected the name of a host or "
            "station (did you mean \"h1\"?)\n");
  EXPECT_EQ(
      told(running, asked(coming(stream("c", "h1", "h2", "")))),
      "coming.json:1:14: error at /streams/0: a stream that no gates can be laid for: found \"c\" with no \"offset\" "
      "that promises when it is sent, or \"auto\", expected what \"gates\": \"auto\" can plan, or another class\n");
  std::string low = stream("c", "h1", "h2");
  low.replace(low.find("\"pcp\": 6"), 8, "\"pcp\": 2");
  const Scenario plant = scenario_of(ring(two));
  EXPECT_EQ(told(running, asked(coming(low)), plant),
            "coming.json:1:14: error at /streams/0: a stream without windows: found \"c\" in no scheduled class, "
            "expected a \"pcp\" of a scheduled class; others may come without a change of gates\n");
}

TEST(ChangeMistakes, PlantsThatDoNotRunLikeThat) {
  const Scenario plant = scenario_of(ring(two));
  EXPECT_EQ(told(plant, asked({}, {"a"})),
            "plant.json:1:138: error at /gates: not a scheduled scenario: found no listed gates, expected what takt "
            "schedule SCENARIO --out FILE has written\n");
  const Scenario running = scheduled(plant);
  Scenario other = running;
  other.gates->lists.front().gates.entries.front().interval += us(1);
  EXPECT_NE(told(other, asked({}, {"a"})).find("lists that no automatic gates have: found another list at "),
            std::string::npos);
  EXPECT_NE(told(other, asked({}, {"a"}), plant).find("lists that are not those of the plant: found another list at "),
            std::string::npos);
  EXPECT_NE(told(running, asked({}, {"a"}), scenario_of(ring(stream("a", "h1", "h2"))))
                .find("not the plant that runs: found no stream \"b\""),
            std::string::npos);
  EXPECT_NE(told(running, asked({}, {"a"}), scenario_of(ring(two + ", " + stream("c", "h1", "h2"))))
                .find("a stream that does not run: found \"c\""),
            std::string::npos);
  EXPECT_NE(told(running, asked({}, {"a"}),
                 scenario_of(ring(stream("a", "h1", "h2", R"(, "offset": "1us")") + ", " + stream("b", "h3", "h2"))))
                .find("not the stream that runs: found \"a\" with other values"),
            std::string::npos);
}

TEST(ChangeMistakes, WhatChangesAlready) {
  Scenario running = scheduled(scenario_of(ring(two)));
  scenario::LinkDown fault;
  fault.link = {"sw3", "sw4"};
  running.faults = {fault};
  EXPECT_EQ(told(running, asked({}, {"a"})).find("error"), std::string::npos);  // it is down from the start on
  fault.at = us(100);
  running.faults = {fault};
  EXPECT_NE(told(running, asked({}, {"a"}))
                .find("a fault of its own: found a fault that begins or ends while the plant runs"),
            std::string::npos);
  running.faults.clear();
  scenario::ScriptEntry entry;
  entry.at = us(100);
  entry.set_gates = running.gates->lists.front();
  running.script = {entry};
  EXPECT_NE(told(running, asked({}, {"a"})).find("gates that change already: found \"set_gates\" in the script"),
            std::string::npos);
}

TEST(ChangeMistakes, TooEarly) {
  AskedChanges change = asked({}, {"a"});
  change.at = us(999);
  EXPECT_EQ(told(scheduled(scenario_of(ring(two))), change),
            "--at: error: a change that begins too early: found 999us, expected at least 2ms, when all streams have "
            "sent for two periods\n");
}

TEST(ChangeMistakes, ProgramsTakeNoOtherWay) {
  const Scenario running = scheduled(scenario_of(ring(
      two,
      R"(, "programs": [{"name": "p", "master": "h1", "slaves": ["h2"], "cycle": "500us", "offset": "auto"}], "script": [{"at": "1ms", "program": "p", "call": "Start"}])")));
  const std::string text = told(running, asked({}, {"p/state/h1"}, {"sw1>sw2"}));
  EXPECT_NE(text.find("a stream of a program: found \"p/state/h1\""), std::string::npos) << text;
  EXPECT_NE(
      told(running, asked({}, {}, {"sw1>sw2"})).find("a stream of a program over what fails: found \"p/state/h1\""),
      std::string::npos);
  // Elsewhere it is not touched.
  json::Diagnostics diagnostics;
  const auto answer = change_scenario(running, std::nullopt, asked({}, {}, {"sw2>sw3"}), diagnostics);
  ASSERT_TRUE(answer) << diagnostics.to_text();
  EXPECT_TRUE(answer->is_done && answer->wrong.empty()) << answer->how;
  ASSERT_EQ(answer->changes.size(), 1u);
  EXPECT_EQ(answer->changes[0].name, "b");
  EXPECT_EQ(answer->changes[0].after->path, (std::vector<std::string>{"h3", "sw3", "sw4", "sw1", "sw2", "h2"}));
}

// On its only way to h2 there is room for eight frames of 11.7 us and what lies between them in 100 us.
TEST(ChangeMistakes, WithoutPlace) {
  std::string all;
  for (int i = 0; i < 8; ++i)
    all +=
        (i == 0 ? "" : ", ") + stream("s" + std::to_string(i), "h1", "h2", R"(, "offset": "auto")", "100us", "1400B");
  const Scenario running = scheduled(scenario_of(ring(all)));
  json::Diagnostics diagnostics;
  const auto answer = change_scenario(
      running, std::nullopt, asked(coming(stream("more", "h1", "h2", R"(, "offset": "auto")", "100us", "1400B"))),
      diagnostics);
  ASSERT_TRUE(answer) << diagnostics.to_text();
  EXPECT_FALSE(answer->is_done);
  EXPECT_EQ(answer->without_place, std::vector<std::string>{"more"});
  EXPECT_TRUE(answer->changes.empty());
  // One goes, and there is room.
  EXPECT_TRUE(
      change_scenario(running, std::nullopt,
                      asked(coming(stream("more", "h1", "h2", R"(, "offset": "auto")", "100us", "1400B")), {"s3"}),
                      diagnostics)
          ->is_done);
}

TEST(ChangeMistakes, WhoStaysSaysThePlant) {
  // What the plant fixes does not move: its way has failed, and it has no other.
  const Scenario plant =
      scenario_of(ring(stream("a", "h1", "h2", R"(, "offset": "0us", "path": ["h1", "sw1", "sw2", "h2"])") + ", " +
                       stream("b", "h1", "h2")));
  const Scenario running = scheduled(plant);
  json::Diagnostics diagnostics;
  const auto answer = change_scenario(running, plant, asked({}, {}, {"sw1>sw2"}), diagnostics);
  ASSERT_TRUE(answer) << diagnostics.to_text();
  EXPECT_FALSE(answer->is_done);
  ASSERT_EQ(answer->changes.size(), 2u);
  EXPECT_EQ(answer->changes[0].fate, StreamFate::lost);
  EXPECT_EQ(answer->changes[1].fate, StreamFate::moves);
  EXPECT_TRUE(answer->wrong.empty()) << answer->wrong.front();
  EXPECT_EQ(summary_of("ring", *answer).verdict, "partly");
  // The plant afterwards has the one that moved as free as it was, and the link down.
  ASSERT_EQ(answer->plant.streams.size(), 1u);
  EXPECT_TRUE(answer->plant.streams[0].offset->is_auto);
  EXPECT_EQ(answer->plant.faults.size(), 1u);
}

// Guards, margins and classes are what lists were laid with, and are found again.
TEST(ChangeMistakes, GatesAreFoundInTheirLists) {
  for (const char* gates : {R"({"plan": "auto", "classes": [6], "guard": "longest-frame"})",
                            R"({"plan": "auto", "classes": [6], "margin": "350ns"})",
                            R"({"plan": "auto", "classes": [5, 6], "margin": "1us", "guard": "longest-frame"})"}) {
    std::string five = stream("c", "h4", "h1");
    five.replace(five.find("\"pcp\": 6"), 8, "\"pcp\": 5");
    const bool has_five = std::string(gates).find("5,") != std::string::npos;
    const Scenario running = scheduled(scenario_of(ring(two + (has_five ? ", " + five : ""), "", gates)));
    json::Diagnostics diagnostics;
    const auto found = gates_of_running(running, std::nullopt, {}, diagnostics);
    ASSERT_TRUE(found) << gates << diagnostics.to_text();
    const Scenario wish = scenario_of(ring(two, "", gates));
    EXPECT_EQ(found->gates.classes, wish.gates->classes) << gates;
    EXPECT_EQ(found->gates.guard, wish.gates->guard) << gates;
    EXPECT_EQ(found->gates.margin->value, wish.gates->margin.value_or(json::OrAuto<Duration>()).value) << gates;
  }
}

// With gPTP windows have a margin, nobody begins before clocks are synchronised, and a frame is at most the margin off.
// What fails is on the way of gPTP, too: h4 then has no time that can be relied on.
TEST(ChangeMistakes, ClocksThatDiffer) {
  const Scenario plant = scenario_of(
      R"({"name": "clocks", "duration": "9s", "network": {"generate": [{"topology": "ring", "switches": 4, "forwarding_delay": "1us"}]},
 "clocks": {"all": {"offset": {"from": "-50ppm", "to": "50ppm"}, "granularity": "8ns"}, "gptp": {"nodes": {"sw1": {"priority1": 100}}, "servo": {"first_step_threshold": "20us"}}},
 "gates": {"plan": "auto", "classes": [6], "margin": "auto"}, "require": [{"sync": "2us", "after": "8s"}], "streams": [)" +
      stream("a", "h4", "h1", R"(, "offset": "auto")", "1ms") + ", " +
      stream("c", "h3", "h1", R"(, "offset": "auto")", "2ms", "400B") + "]}");
  const Scenario running = scheduled(plant);
  json::Diagnostics diagnostics;
  for (const bool has_plant : {false, true}) {
    const auto cut = change_scenario(running, has_plant ? std::optional(plant) : std::nullopt,
                                     asked({}, {}, {"sw4>sw1"}), diagnostics);
    ASSERT_TRUE(cut) << diagnostics.to_text();
    EXPECT_EQ(cut->after, nullptr);
    EXPECT_TRUE(cut->how.starts_with("with these clocks windows do not keep while it changes: ")) << cut->how;
    EXPECT_TRUE(cut->wrong.empty()) << cut->wrong.front();
    const auto answer =
        change_scenario(running, has_plant ? std::optional(plant) : std::nullopt,
                        asked(coming(stream("b", "h2", "h1", R"(, "offset": "auto")", "2ms", "1000B"))), diagnostics);
    ASSERT_TRUE(answer) << diagnostics.to_text();
    EXPECT_TRUE(answer->is_done) << answer->how;
    EXPECT_TRUE(answer->wrong.empty()) << answer->wrong.front();
    EXPECT_GE(answer->at, us(8'000'000));
    EXPECT_GT(answer->simulated.margin, us(4));
    EXPECT_EQ(answer->changes.size(), 1u);
  }
}

}  // namespace
}  // namespace takt::synthesis::change_mistakes_test
