// SPDX-License-Identifier: Apache-2.0
// A plant that changes: who comes, goes or takes another way, and who has to move.
#include "schedule/change.hpp"

#include <gtest/gtest.h>

#include "schedule/decide.hpp"
#include "schedule_check/instance_check.hpp"
#include "small_problem.hpp"

namespace takt::schedule::change_test {
namespace {

Solution scheduled(const Problem& problem) {
  const Decision decision = decide(problem, {});
  EXPECT_EQ(decision.verdict, Decision::Verdict::scheduled);
  EXPECT_EQ(why_not_changeable(problem, decision.found.solution), "");
  return decision.found.solution;
}

Stream some_stream(Problem problem, const std::string& from, const std::string& to, Ps length_us, Ps period) {
  Stream stream = add_stream(problem, from, to, length_us, period);
  stream.name = "new";
  return stream;
}

// Frames of one size come to every link in the order in which they leave h0: ten of 10 us fill 100 us.
TEST(Change, AStreamMoreMovesNobody) {
  Problem problem = line(3);
  for (int i = 0; i < 5; ++i) add_stream(problem, "h0", "h2", 10, 100 * us);
  const Solution before = scheduled(problem);
  Plant plant(problem, before);
  for (int i = 0; i < 5; ++i) {
    Stream stream = some_stream(problem, "h0", "h1", 10, 100 * us);
    stream.name += std::to_string(i);
    const auto added = plant.add(std::move(stream));
    ASSERT_TRUE(added);
    EXPECT_TRUE(added->moved.empty());
  }
  const Solution after = plant.solution();
  EXPECT_EQ(schedule_check::check(plant.problem(), after), std::vector<std::string>{});
  for (StreamIndex s = 0; s < before.streams.size(); ++s)
    EXPECT_EQ(after.streams[s]->starts, before.streams[s]->starts);
  // What does not fit changes nothing.
  EXPECT_FALSE(plant.add(some_stream(problem, "h0", "h1", 10, 200 * us)));
  EXPECT_EQ(plant.problem().streams.size(), 10u);
  plant.remove(7);
  EXPECT_TRUE(plant.add(some_stream(problem, "h0", "h1", 10, 200 * us)));
}

// Of 34 us 0 to 10 and 15 to 25 are taken: 10 us more fit nowhere unless one of the two moves.
TEST(Change, OneMovesIfItMust) {
  Problem problem = line(2);
  for (int i = 0; i < 2; ++i) add_stream(problem, "h0", "h1", 10, 34 * us);
  Solution before = scheduled(problem);
  for (StreamIndex s = 0; s < 2; ++s) {
    const Ps shift = (s == 0 ? 0 : 15) * us - before.streams[s]->starts[0][0];
    for (auto& starts : before.streams[s]->starts) starts[0] += shift;
  }
  ASSERT_EQ(schedule_check::check(problem, before), std::vector<std::string>{});
  Plant plant(problem, before);
  const auto added = plant.add(some_stream(problem, "h0", "h1", 10, 34 * us));
  ASSERT_TRUE(added);
  EXPECT_EQ(added->moved.size(), 1u);
  EXPECT_EQ(schedule_check::check(plant.problem(), plant.solution()), std::vector<std::string>{});
}

TEST(Change, AfterAFailureStreamsGoRound) {
  Problem problem = line(3);
  for (const auto& [a, b] : {std::pair("b0", "b2"), std::pair("b2", "b0")}) {
    Link link = problem.links.back();
    link.from = node_of(problem, a);
    link.to = node_of(problem, b);
    link.name = std::string(a) + ">" + b;
    problem.links.push_back(link);
  }
  add_stream(problem, "h0", "h2", 10, 100 * us);
  add_stream(problem, "h0", "h1", 10, 100 * us);
  problem.streams[0].route =
      std::vector<LinkIndex>{link_of(problem, "h0>b0"), link_of(problem, "b0>b2"), link_of(problem, "b2>h2")};
  const Solution before = scheduled(problem);
  Plant plant(problem, before);
  const auto first = plant.fail(link_of(problem, "b0>b2"));
  EXPECT_EQ(first.moved, std::vector<StreamIndex>{0});
  EXPECT_TRUE(first.lost.empty());
  EXPECT_EQ(plant.solution().streams[0]->route.size(), 4u);
  EXPECT_EQ(plant.solution().streams[1]->starts, before.streams[1]->starts);
  EXPECT_EQ(schedule_check::check(plant.problem(), plant.solution()), std::vector<std::string>{});
  const auto second = plant.fail(link_of(problem, "b0>b1"));
  EXPECT_EQ(second.lost, (std::vector<StreamIndex>{0, 1}));
}

TEST(Change, WhatWaitsIsNotChanged) {
  Problem problem = line(2);
  add_stream(problem, "h0", "h1", 10, 100 * us);
  Solution before = scheduled(problem);
  before.streams[0]->starts.back()[0] += us;
  EXPECT_EQ(why_not_changeable(problem, before), "s0 waits in a bridge");
}

}  // namespace
}  // namespace takt::schedule::change_test
