// SPDX-License-Identifier: Apache-2.0
// What is required of traffic without windows is part of the search, and ways that a scenario leaves open are searched
// for.
#include <gtest/gtest.h>

#include <algorithm>

#include "evaluation/evaluate.hpp"
#include "json/document.hpp"
#include "json/fields.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "synthesis/report.hpp"
#include "synthesis/scenario_schedule.hpp"

namespace takt::synthesis {
namespace {

using sim::Duration;
using Verdict = schedule::Decision::Verdict;
using State = StreamRequirement::State;

constexpr Duration us = Duration::from_ps(1'000'000);

/// Three scheduled streams and a camera in class 4 from sw1 to sw2, 100 Mbit/s: a frame of the camera takes 28.64 us on
/// a link (300 octets and 58 more), a scheduled one 36.64 us, and 123.36 us before each of these the other classes are
/// closed. `ring`: sw1, sw4, sw3, sw2 is another way.
std::string beside_camera(bool ring, const std::string& limit, const std::string& of_camera = "",
                          const std::string& of_others = "") {
  std::string streams;
  for (const std::string name : {"a", "b", "c"}) {
    const int host = name[0] - 'a' + 1;
    streams += R"({"name": ")" + name + R"(", "from": "h)" + std::to_string(host) + R"(", "to": "h)" +
               std::to_string(host + 4) + R"(", "payload": "400B", "every": "1ms", "offset": "auto", "pcp": 6)" +
               of_others + "},\n";
  }
  return R"({"name": "beside-camera", "duration": "20ms",
 "network": {"generate": [{"topology": ")" +
         std::string(ring ? "ring\", \"switches\": 4" : "line\", \"switches\": 2") +
         R"(, "hosts_per_switch": 4, "rate": "100Mbps", "forwarding_delay": "1us"}]},
 "gates": {"plan": "auto", "classes": [6], "guard": "longest-frame"},
 "streams": [)" +
         streams + R"({"name": "camera", "from": "h4", "to": "h8", "payload": "300B", "every": "1ms", "pcp": 4)" +
         of_camera + R"(}],
 "require": [{"stream": "camera", "latency": ")" +
         limit + R"("}]})";
}

std::optional<ScenarioSchedule> answer_of(const std::string& text, bool may_route, std::uint64_t seed = 1,
                                          bool may_route_open = true) {
  json::Diagnostics diagnostics;
  scenario::Scenario wanted;
  const auto document = json::parse(text, "test.json", diagnostics);
  EXPECT_TRUE(document && json::decode(*document, wanted, diagnostics)) << diagnostics.to_text();
  ScenarioOptions options;
  options.may_route = may_route;
  options.may_route_open = may_route_open;
  options.search.attempts = 20;
  options.search.seed = seed;
  auto answer = schedule_scenario(wanted, options, diagnostics);
  EXPECT_EQ(diagnostics.errors(), 0u) << diagnostics.to_text();
  EXPECT_TRUE(!answer || answer->wrong.empty()) << answer->wrong.front();
  return answer;
}

/// The greatest latency of the camera in runs in which it begins every so many us of its period.
Duration slowest_run(const ScenarioSchedule& answer, std::int64_t step_us) {
  Duration most;
  for (std::int64_t at = 0; at < 1'000; at += step_us) {
    scenario::Scenario varied = answer.resolved->scenario;
    std::ranges::find(varied.streams, "camera", &scenario::Stream::name)->offset = json::OrAuto<Duration>(us * at);
    varied.require.clear();
    json::Diagnostics diagnostics;
    const auto resolved = scenario::resolve(varied, diagnostics);
    EXPECT_TRUE(resolved) << diagnostics.to_text();
    scenario::Run run(*resolved);
    run.advance();
    for (const results::StreamResult& stream : evaluation::evaluate(run, false).streams)
      if (stream.name == "camera") most = std::max(most, stream.latency->max);
  }
  return most;
}

// As soon as possible the three scheduled frames stand in a row on sw1 to sw2, and the camera may have to wait for all
// of them: some run takes more than 300 us. Spread over the period it waits for one.
TEST(Placements, FirstScheduleBreaksARequirementAndAnotherKeepsIt) {
  const auto lenient = answer_of(beside_camera(false, "400us"), false);
  ASSERT_TRUE(lenient);
  ASSERT_EQ(lenient->verdict, Verdict::scheduled);
  EXPECT_EQ(lenient->placements, 1u);
  EXPECT_GT(slowest_run(*lenient, 5), us * 300);
  const auto answer = answer_of(beside_camera(false, "300us"), false);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  EXPECT_EQ(answer->how, "given paths");
  EXPECT_GT(answer->placements, 1u);
  ASSERT_EQ(answer->requirements.size(), 1u);
  EXPECT_EQ(answer->requirements[0].state, State::kept);
  EXPECT_EQ(answer->requirements[0].stream, "camera");
  ASSERT_TRUE(answer->requirements[0].bound);
  EXPECT_LE(*answer->requirements[0].bound, us * 300);
  const Duration slowest = slowest_run(*answer, 5);
  EXPECT_LE(slowest, *answer->requirements[0].bound);
  EXPECT_GT(slowest, us * 200);  // and the bound is not far above
  // The scheduled ones are as fast as ever.
  for (const JudgedStream& each : answer->streams) EXPECT_EQ(each.simulated, each.planned);
}

TEST(Placements, SamePlacementForTheSameSeed) {
  const std::string text = beside_camera(false, "300us");
  const auto a = answer_of(text, false), b = answer_of(text, false);
  ASSERT_TRUE(a && b && a->resolved && b->resolved);
  EXPECT_EQ(json::encode(a->resolved->scenario), json::encode(b->resolved->scenario));
  EXPECT_EQ(a->placement, b->placement);
}

// A frame of the camera alone takes 3 times 28.64 us and 2 us, and before it may be one window of 36.64 us with its
// guard: no placement keeps 200 us. Still nothing is proved.
TEST(Placements, WhatNoPlacementKeepsIsUndecided) {
  const auto answer = answer_of(beside_camera(false, "200us"), false);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::undecided);
  EXPECT_FALSE(answer->resolved);
  EXPECT_FALSE(answer->certificate);
  ASSERT_EQ(answer->requirements.size(), 1u);
  EXPECT_EQ(answer->requirements[0].state, State::broken);
  EXPECT_EQ(answer->requirements[0].limit, us * 200);
  EXPECT_GT(*answer->requirements[0].bound, us * 200);
  // Not the first one, but the one that comes closest.
  const auto first = answer_of(beside_camera(false, "400us"), false);
  EXPECT_LT(*answer->requirements[0].bound, *first->requirements[0].bound);
  EXPECT_NE(answer->how.find("stream camera latency at most 200us: the bound is "), std::string::npos) << answer->how;
  EXPECT_NE(answer->how.find("in the closest of " + std::to_string(answer->placements) + " schedules (" +
                             answer->placement + ")"),
            std::string::npos)
      << answer->how;
}

// In a ring the scheduled frames may go round, and then the camera has sw1 to sw2 for itself.
TEST(Placements, OtherWaysKeepWhatOtherTimesDoNot) {
  const std::string text = beside_camera(true, "260us");
  const auto given = answer_of(text, false);
  ASSERT_TRUE(given);
  EXPECT_EQ(given->verdict, Verdict::undecided);
  const auto answer = answer_of(text, true);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  EXPECT_EQ(answer->how, "searched paths");
  EXPECT_LE(slowest_run(*answer, 20), *answer->requirements[0].bound);
}

// "route": "auto" of the camera, whose class has no windows.
TEST(Placements, AnOpenRouteOfAnotherClassIsTriedToo) {
  const auto answer = answer_of(beside_camera(true, "260us", R"(, "route": "auto")"), false);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  const auto camera = std::ranges::find(answer->resolved->scenario.streams, "camera", &scenario::Stream::name);
  ASSERT_TRUE(camera->path);
  EXPECT_EQ(*camera->path, (std::vector<std::string>{"h4", "sw1", "sw4", "sw3", "sw2", "h8"}));
  EXPECT_FALSE(camera->route);
  EXPECT_LE(slowest_run(*answer, 20), *answer->requirements[0].bound);
}

// The scheduled frame's own way takes 3 times 36.64 us and 2 us whatever its time: that is proved, and nothing else is
// tried.
TEST(Placements, ALatencyWithWindowsIsRefutedAsBefore) {
  std::string text = beside_camera(false, "400us");
  text.replace(text.find("{\"stream\": \"camera\", \"latency\": \"400us\"}"), 40,
               R"({"stream": "a", "latency": "100us"}       )");
  const auto answer = answer_of(text, false);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::infeasible) << answer->how;
  ASSERT_TRUE(answer->certificate);
  EXPECT_EQ(answer->certificate->kind, schedule::Certificate::Kind::latency);
}

// Frames at random times have no bound: the schedule stands, and it is said.
TEST(Placements, WhatHasNoBoundIsSaid) {
  std::string text = beside_camera(false, "400us");
  const std::string every = R"("payload": "300B", "every": "1ms")";
  text.replace(text.find(every), every.size(), R"("payload": "300B", "exponential": "1ms")");
  const auto answer = answer_of(text, false);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->verdict, Verdict::scheduled) << answer->how;
  ASSERT_EQ(answer->requirements.size(), 1u);
  EXPECT_EQ(answer->requirements[0].state, State::unbounded);
  EXPECT_FALSE(answer->requirements[0].reason.empty());
  EXPECT_NE(text_of("x", *answer).find("unbounded: stream camera latency at most 400us ("), std::string::npos)
      << text_of("x", *answer);
}

/// A ring of four switches; x and h1 are at sw1, y and h2 at sw2. Frames of 1400 octets (11.728 us with preamble and
/// gap) each 20 us: two do not fit on sw1 to sw2.
std::string two_ways(const std::string& of_a, const std::string& of_b) {
  return R"({"name": "two-ways", "duration": "2ms", "network": {"generate": [{"topology": "ring", "switches": 4, "forwarding_delay": "1us"}],
 "nodes": {"x": {"kind": "host"}, "y": {"kind": "host"}}, "links": [{"ends": ["x", "sw1"]}, {"ends": ["y", "sw2"]}]}, "gates": {"plan": "auto", "classes": [6]},
 "streams": [{"name": "a", "from": "h1", "to": "h2", "payload": "1400B", "every": "20us", "pcp": 6, )" +
         of_a + R"(},
  {"name": "b", "from": "x", "to": "y", "payload": "1400B", "every": "20us", "pcp": 6, )" +
         of_b + "}]}";
}

const std::string open = R"("offset": "auto", "route": "auto")", closed = R"("offset": "auto")";

std::vector<std::string> path_of(const ScenarioSchedule& answer, const std::string& name) {
  const auto stream = std::ranges::find(answer.resolved->scenario.streams, name, &scenario::Stream::name);
  EXPECT_FALSE(stream->route);
  return stream->path.value_or(std::vector<std::string>());
}

// With given paths exactly those are searched for that say so.
TEST(OpenRoutes, AreSearchedForWhereOthersAreGiven) {
  const std::vector<std::string> round_a{"h1", "sw1", "sw4", "sw3", "sw2", "h2"},
      round_b{"x", "sw1", "sw4", "sw3", "sw2", "y"};
  const auto a = answer_of(two_ways(open, closed), false), b = answer_of(two_ways(closed, open), false);
  ASSERT_TRUE(a && a->verdict == Verdict::scheduled && b && b->verdict == Verdict::scheduled);
  EXPECT_EQ(path_of(*a, "a"), round_a);
  EXPECT_TRUE(path_of(*a, "b").empty());
  EXPECT_EQ(path_of(*b, "b"), round_b);
  // What comes out is a scenario that is taken as it is.
  json::Diagnostics diagnostics;
  EXPECT_TRUE(scenario::load_text(json::encode(a->resolved->scenario), "again.json", {}, diagnostics))
      << diagnostics.to_text();
  EXPECT_EQ(diagnostics.to_text().find("route"), std::string::npos) << diagnostics.to_text();
}

TEST(OpenRoutes, TakeTheShortestPathWhereThatDoes) {
  std::string text = two_ways(open, closed);
  for (std::size_t at = 0; (at = text.find("20us", at)) != std::string::npos; ++at) text.replace(at, 4, "50us");
  const auto answer = answer_of(text, true);
  ASSERT_TRUE(answer && answer->verdict == Verdict::scheduled);
  EXPECT_EQ(answer->how, "given paths");
  EXPECT_EQ(path_of(*answer, "a"), (std::vector<std::string>{"h1", "sw1", "sw2", "h2"}));
}

TEST(OpenRoutes, AreShortestIfNothingIsSearchedFor) {
  const auto answer = answer_of(two_ways(open, open), false, 1, false);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::infeasible);
}

TEST(OpenRoutes, NeedAnOffsetThatIsOpenToo) {
  const auto answer = answer_of(two_ways(R"("offset": "0us", "route": "auto")", closed), false);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->verdict, Verdict::undecided);
  EXPECT_NE(answer->how.find(R"("a" says "route": "auto", and ways are searched for streams with "offset": "auto")"),
            std::string::npos)
      << answer->how;
}

}  // namespace
}  // namespace takt::synthesis
