// SPDX-License-Identifier: Apache-2.0
// The judge refuses what is no schedule: one thing of each kind is changed in a sound one.
#include <gtest/gtest.h>

#include <functional>

#include "schedule/decide.hpp"
#include "schedule/gate_lists.hpp"
#include "schedule_check/instance_check.hpp"
#include "small_problem.hpp"

namespace takt::schedule::judge_test {
namespace {

struct Case {
  Problem problem;
  Solution solution;
};

/// Two streams from h0 over b1 to h2 and one from h1, with gates.
Case sound() {
  Case made;
  made.problem = line(3, 100'000, us);
  for (int i = 0; i < 2; ++i) {
    Stream& stream = add_stream(made.problem, "h0", "h2", 10, 200 * us);
    stream.latency = 100 * us;
    stream.deadline = 190 * us;
    stream.jitter = 0;
  }
  add_stream(made.problem, "h1", "h2", 10, 100 * us);
  Decision decision = decide(made.problem, {});
  made.solution = decision.found.solution;
  EXPECT_EQ(make_gate_lists(made.problem, made.solution, {}), std::nullopt);
  EXPECT_EQ(schedule_check::check(made.problem, made.solution), std::vector<std::string>{});
  return made;
}

void expect_refused(const char* kind, const std::function<void(Case&)>& spoil) {
  Case made = sound();
  spoil(made);
  const auto wrong = schedule_check::check(made.problem, made.solution, 1000);
  bool found = false;
  for (const std::string& each : wrong) found = found || each.starts_with(std::string(kind) + ":");
  EXPECT_TRUE(found) << kind << " is not noticed" << (wrong.empty() ? "" : ", but " + wrong.front());
}

TEST(Judge, RefusesEachKindOfMistake) {
  expect_refused("stream", [](Case& c) { c.solution.streams[1].reset(); });
  expect_refused("start", [](Case& c) { c.solution.streams[0]->starts.pop_back(); });
  expect_refused("route", [](Case& c) { std::swap(c.solution.streams[0]->route[0], c.solution.streams[0]->route[1]); });
  expect_refused("route", [](Case& c) {
    for (auto* list : {&c.solution.streams[0]->route}) list->pop_back();
    c.solution.streams[0]->starts.pop_back();
    c.solution.streams[0]->classes.pop_back();
  });
  expect_refused("route", [](Case& c) { c.problem.streams[2].route = std::vector<LinkIndex>{0}; });
  expect_refused("class", [](Case& c) { c.solution.streams[0]->classes[1] = 9; });
  expect_refused("release", [](Case& c) { c.problem.streams[0].release = c.solution.streams[0]->starts[0][0] + 1; });
  expect_refused("precedence", [](Case& c) { c.solution.streams[0]->starts[2][0] -= 1; });
  expect_refused("no-wait", [](Case& c) {
    c.problem.model.no_wait = true;
    c.solution.streams[0]->starts.back()[0] += 1;
  });
  expect_refused("strict", [](Case& c) {
    c.problem.model.is_strict = true;
    c.problem.streams[2].period = 100 * us;
    for (auto& starts : c.solution.streams[2]->starts) starts = {starts[0], starts[0] + 100 * us + 1};
  });
  expect_refused("overlap", [](Case& c) { c.solution.streams[0]->starts = c.solution.streams[1]->starts; });
  expect_refused("overlap", [](Case& c) { c.problem.streams[2].octets = 13'000; });  // meets its own next repetition
  expect_refused("deadline", [](Case& c) { c.problem.streams[0].deadline = c.solution.streams[0]->starts.back()[0]; });
  expect_refused("latency", [](Case& c) { c.problem.streams[0].latency = 10 * us; });
  expect_refused("jitter", [](Case& c) {
    c.problem.streams[2].jitter = 0;
    for (auto& starts : c.solution.streams[2]->starts) starts = {starts[0], starts[0] + 100 * us + 1};
  });
  expect_refused("gate-list", [](Case& c) { c.solution.gates.erase(c.solution.gates.begin()); });
  expect_refused("gate-list", [](Case& c) { c.solution.gates.begin()->second.entries.front().interval += 1'000; });
  expect_refused("gate-entries", [](Case& c) { c.problem.links[c.solution.gates.begin()->first].entries = 1; });
  expect_refused("gate-closed", [](Case& c) {
    for (auto& entry : c.solution.gates.begin()->second.entries)
      entry.open = static_cast<std::uint8_t>(entry.open & 0x7f);
  });
  expect_refused("gate-other", [](Case& c) {
    for (auto& entry : c.solution.gates.begin()->second.entries) entry.open = 0xff;
  });
}

// Two frames of one class: the one that comes first must go first.
TEST(Judge, RefusesOvertakingInAQueue) {
  Problem problem = line(2, 0, 0);
  problem.nodes.push_back({"g", false});
  problem.links.push_back({"g>b0", node_of(problem, "g"), node_of(problem, "b0"), 8'000, 0, 0, std::nullopt, 1024});
  add_stream(problem, "h0", "h1", 10, 200 * us);
  add_stream(problem, "g", "h1", 10, 200 * us);
  Solution solution;
  const Ps frame = 9'904'000;
  solution.streams.emplace_back(
      Placement{{link_of(problem, "h0>b0"), link_of(problem, "b0>b1"), link_of(problem, "b1>h1")},
                {{0}, {60 * us}, {60 * us + frame}},
                {7, 7, 7}});
  solution.streams.emplace_back(
      Placement{{link_of(problem, "g>b0"), link_of(problem, "b0>b1"), link_of(problem, "b1>h1")},
                {{20 * us}, {40 * us}, {40 * us + frame}},
                {7, 7, 7}});
  const auto wrong = schedule_check::check(problem, solution);
  ASSERT_FALSE(wrong.empty());
  EXPECT_TRUE(wrong.front().starts_with("order:")) << wrong.front();
  solution.streams[1]->classes = {7, 6, 7};  // in a queue of its own it may
  EXPECT_EQ(schedule_check::check(problem, solution), std::vector<std::string>{});
}

}  // namespace
}  // namespace takt::schedule::judge_test
