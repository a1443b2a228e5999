// SPDX-License-Identifier: Apache-2.0
// Requirements on any figure of the result, and the table of what result.json can hold.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "evaluation/evaluate.hpp"
#include "results/result_json.hpp"
#include "scenario/figures/known_figures.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::scenario::test {
namespace {

using results::RequirementResult;
using results::RunResult;
using results::Verdict;

// a --- sw --- b as in tests/simulation/evaluation/requirements_test.cpp: 11 frames from 0 to 10 ms, 10 of them delivered
// after 2.564 us each.
std::string frames(const std::string& requirement) {
  return over_one_switch(
      R"(, "streams": [{"name": "camera", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}], "require": [)" +
      requirement + "]");
}

RunResult run(const std::string& text, std::uint64_t events = ~0ULL) {
  const auto resolved = sound(text);
  LiveRun live(*resolved);
  const bool is_complete = live.advance(events);
  return evaluation::evaluate(live, !is_complete);
}
RequirementResult judged(const std::string& requirement) { return run(frames(requirement)).requirements.at(0); }
std::string refused(const std::string& requirement) { return load(frames(requirement)).diagnostics.to_text(); }

TEST(Figures, ATimeIsJudgedToThePicosecond) {
  const RequirementResult exact = judged(R"({"figure": "latency.camera.max", "at_most": "2564ns"})");
  EXPECT_EQ(exact.verdict, Verdict::pass);
  EXPECT_EQ(exact.text, "figure latency.camera.max at most 2564ns");
  EXPECT_EQ(exact.remark, "found 2.564us, asked at most 2564ns");
  EXPECT_EQ(exact.measured->ps(), 2'564'000);
  EXPECT_EQ(exact.limit->ps(), 2'564'000);
  EXPECT_EQ(judged(R"({"figure": "/streams/camera/latency_ps/max", "at_most": "2563999ps"})").verdict, Verdict::fail);
  EXPECT_EQ(judged(R"({"figure": "/streams/camera/latency_ps/max", "at_least": "2564001ps"})").verdict, Verdict::fail);
  EXPECT_EQ(judged(R"({"figure": "/streams/camera/latency_ps/max", "unit": "ns", "at_most": 2563.9})").verdict,
            Verdict::fail);
  EXPECT_EQ(judged(R"({"figure": "/streams/camera/latency_ps/max", "unit": "ns", "at_most": 2564})").remark,
            "found 2564 ns, asked at most 2564 ns");
}

TEST(Figures, CountsSharesAndSums) {
  EXPECT_EQ(judged(R"({"figure": "delivered", "at_least": 10})").verdict, Verdict::pass);
  const RequirementResult few = judged(R"({"figure": "delivered", "at_least": 11, "unit": "frames"})");
  EXPECT_EQ(few.verdict, Verdict::fail);
  EXPECT_EQ(few.remark, "found 10 frames, asked at least 11 frames");
  // 10 or 11 times (8 + 146 + 12) x 8 ns in 10 ms: 0.13 %.
  EXPECT_EQ(judged(R"({"figure": "/ports/*/utilisation", "unit": "%", "at_most": 0.15})").verdict, Verdict::pass);
  EXPECT_EQ(judged(R"({"figure": "/ports/*/utilisation", "unit": "%", "at_most": 0.12})").verdict, Verdict::fail);
  EXPECT_EQ(judged(R"({"figure": "/streams/*/sent", "take": "sum", "at_most": 11})").verdict, Verdict::pass);
  EXPECT_EQ(judged(R"({"figure": "/ports/*/frames", "only": {"node": "sw"}, "at_most": 9})").verdict, Verdict::fail);
  EXPECT_EQ(judged(R"({"figure": "/ports/*/frames", "only": {"node": "b"}, "at_most": 9})").remark,
            "the run has no such figure, asked at most 9");
  EXPECT_EQ(judged(R"({"figure": "topology.diameter", "at_most": 0})").verdict, Verdict::pass) << "one switch";
}

TEST(Figures, WhatDidNotHappen) {
  EXPECT_EQ(judged(R"({"figure": "/dropped/link_down", "at_most": 0})").verdict, Verdict::pass)
      << "result.json names only reasons that occurred";
  EXPECT_EQ(judged(R"({"figure": "/streams/camera/dropped/queue_frames", "at_least": 1})").verdict, Verdict::fail);
  EXPECT_EQ(judged(R"({"figure": "reaction.start.max", "at_most": "1s"})").verdict, Verdict::fail)
      << "a figure that is missing keeps no limit";
  EXPECT_EQ(judged(R"({"figure": "reaction.start.count", "at_most": 0})").verdict, Verdict::pass);
}

TEST(Figures, AnInterruptedRunLeavesThemOpen) {
  const RunResult cut = run(frames(R"({"figure": "delivered", "at_least": 10})"), 12);
  EXPECT_EQ(cut.requirements.at(0).verdict, Verdict::undecided);
  EXPECT_EQ(cut.verdict, Verdict::undecided);
}

TEST(Figures, AreInTheResult) {
  const json::Node node = results::run_node(run(frames(
      R"({"figure": "latency.camera.max", "at_most": "1us"}, {"figure": "reaction.halt.max", "at_least": 3, "unit": "ms"})")));
  const json::Node& first = node.find("requirements")->items.at(0);
  EXPECT_EQ(
      json::compact(first),
      R"({"text": "figure latency.camera.max at most 1us", "verdict": "fail", "measured_ps": 2564000, "limit_ps": 1000000, "remark": "found 2.564us, asked at most 1us", )"
      R"("figure": "latency.camera.max", "found": 2.564, "at_most": 1, "unit": "us"})");
  EXPECT_EQ(json::compact(*node.find("requirements")->items.at(1).find("found")), "null");
  EXPECT_EQ(node.find("verdict")->text, "fail");
}

TEST(Figures, MistakesAreToldBeforeTheRun) {
  const auto says = [](const std::string& requirement, const std::string& words) {
    const std::string told = refused(requirement);
    EXPECT_NE(told.find(words), std::string::npos) << requirement << "\n" << told;
  };
  says(
      R"({"figure": "/streams/camera/latncy_ps/max", "at_most": "1us"})",
      R"(unknown figure: found "latncy_ps" in /streams/camera, expected one of sent, delivered, lost, dropped, copies, in_flight, oldest_in_flight_ps, listeners, latency_ps (did you mean "latency_ps"?))");
  says(R"({"figure": "/streams/camera/latency_ps", "at_most": "1us"})",
       R"(not a single figure: found "/streams/camera/latency_ps", expected one step more: min, mean, p50)");
  says(R"({"figure": "/events/now", "at_most": 1})", "/events, which has no members");
  says(R"({"figure": "/streams/t/sent", "at_most": 1})", R"(unknown stream: found "t", expected the name of a stream)");
  says(R"({"figure": "latency.camra.max", "at_most": "1us"})",
       R"(found "camra", expected the name of a stream (did you mean "camera"?))");
  says(R"({"figure": "/dropped/lnk_down", "at_most": 1})", R"(did you mean "link_down"?)");
  says(R"({"figure": "droped", "at_most": 1})", R"(did you mean "dropped"?)");
  says(R"({"figure": "/ports/*/peer", "at_most": 1})", "a figure that is no number");
  says(R"({"figure": "verdict", "at_least": 1})", "a requirement on what the requirements come to");
  says(R"({"figure": "/requirements/0/measured_ps", "at_most": "1us"})",
       "a requirement on what the requirements come to");
  says(R"({"figure": "/ports/*/frames", "only": {"nod": "sw"}, "at_most": 9})",
       R"(no member beside the figure: found "nod", expected one of)");
  says(R"({"figure": "latency.max", "at_most": 5})",
       R"(a time without a unit: found the number 5, expected a duration such as "7ms", or "unit" beside it)");
  says(R"({"figure": "dropped", "at_most": "5us"})", "not a limit of this figure");
  says(R"({"figure": "dropped", "unit": "us", "at_most": 5})", "a unit of time for what is no time");
  says(R"({"figure": "dropped"})", R"(found "figure" without a limit, expected "at_most", "at_least" or "equal")");
  says(R"({"figure": "dropped", "at_most": 1, "at_least": 0})", "at_least");
  says(R"({"figure": "dropped", "at_most": 1, "latency": "1us"})",
       R"(does not belong to this requirement: found "latency")");
  says(R"({"stream": "camera", "dropped": 1, "at_most": 1})",
       R"(found "at_most", expected a requirement with "figure")");
  says(R"({"figure": "dropped", "take": "mean", "at_most": 1})", "it in the short form");
}

TEST(Figures, TheResolvedCopyAsksTheSame) {
  const auto resolved = sound(frames(
      R"({"figure": "/ports/*/frames", "only": {"node": "sw"}, "take": "sum", "unit": "frames", "at_most": 12.5})"));
  const std::string copy = json::encode(resolved->scenario);
  EXPECT_EQ(sound(copy)->scenario.require, resolved->scenario.require);
}

/// The pattern of the object or array that the figure is in.
std::string record_of(const KnownFigure& figure) { return figure.pattern.substr(0, figure.pattern.rfind('/')); }

/// Every value of a result that is no object and no array is a known figure of its kind.
void hold_against(const json::Node& node, std::vector<std::string>& steps, std::set<std::string>& seen) {
  if (node.kind == json::Kind::object || node.kind == json::Kind::array) {
    std::size_t index = 0;
    for (const json::Member& member : node.members) {
      steps.push_back(member.key);
      hold_against(member.value, steps, seen);
      steps.pop_back();
    }
    for (const json::Node& item : node.items) {
      steps.push_back(std::to_string(index++));
      hold_against(item, steps, seen);
      steps.pop_back();
    }
    return;
  }
  std::string path;
  for (const std::string& step : steps) path += "/" + step;
  const Lookup found = look_up(steps);
  if (found.figures.empty()) {
    // A table that is empty in this run.
    EXPECT_TRUE(node.kind == json::Kind::null && found.wrong_step == steps.size()) << path;
    return;
  }
  seen.insert(record_of(*found.figures.front()));
  if (node.kind == json::Kind::null || found.figures.front()->kind == FigureKind::verdict) return;
  EXPECT_EQ(found.figures.front()->kind == FigureKind::text, node.kind == json::Kind::string) << path;
}

TEST(KnownFigures, AreWhatResultsOfShippedScenariosHold) {
  std::set<std::string> seen;
  for (const std::string& name : shipped_names()) {
    // A grandmaster leads as soon as another node is locked to it, after a second or two.
    const bool is_of_clocks = name.starts_with("clocks/two-nodes");
    const bool is_long = shipped(name)->scenario.duration > sim::Duration::from_ps(300'000'000'000);
    const auto resolved = shipped(name, is_of_clocks ? "5s" : is_long ? "300ms" : "");
    LiveRun live(*resolved);
    live.advance();
    std::vector<std::string> steps;
    hold_against(results::run_node(evaluation::evaluate(live, false)), steps, seen);
  }
  // What the graph is like is no part of result.json; the others wait for scenarios in which something of the kind
  // happens.
  const std::set<std::string> elsewhere = {"/topology", "/applications/<application>/participants/[]/incompatible"};
  for (const KnownFigure& figure : known_figures())
    EXPECT_TRUE(seen.contains(record_of(figure)) || elsewhere.contains(record_of(figure)))
        << figure.pattern << " occurs nowhere";
}

}  // namespace
}  // namespace takt::scenario::test
