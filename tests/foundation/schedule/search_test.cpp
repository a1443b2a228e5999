// SPDX-License-Identifier: Apache-2.0
// Schedules that must be found, and that are found by any number of jobs.
#include "schedule/search.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "schedule/decide.hpp"
#include "schedule_check/instance_check.hpp"
#include "small_problem.hpp"

namespace takt::schedule::search_test {
namespace {

using Verdict = Decision::Verdict;

Decision decided(const Problem& problem, std::uint32_t attempts = 8) {
  SearchOptions options;
  options.attempts = attempts;
  Decision decision = decide(problem, options);
  if (decision.verdict == Verdict::scheduled) {
    const auto wrong = schedule_check::check(problem, decision.found.solution);
    EXPECT_TRUE(wrong.empty()) << wrong.front();
  }
  return decision;
}

// Ten frames of 10 us fill 100 us: none is left over and nothing else fits.
TEST(Search, FillsALink) {
  Problem problem = line(2);
  for (int i = 0; i < 10; ++i) add_stream(problem, "h0", "h1", 10, 100 * us);
  EXPECT_EQ(decided(problem).verdict, Verdict::scheduled);
  add_stream(problem, "h0", "h1", 1, 100 * us);
  const Decision over = decided(problem);
  EXPECT_EQ(over.verdict, Verdict::infeasible);
  ASSERT_TRUE(over.certificate);
  EXPECT_EQ(over.certificate->kind, Certificate::Kind::load);
}

// Two long frames strictly every 100 and 150 us meet modulo 50 us. Placed first, a short one every 50 us in the middle
// of what is left would take the place of both.
TEST(Search, TakesOutWhoIsInTheWay) {
  Problem problem = line(2);
  problem.model.is_strict = true;
  add_stream(problem, "h0", "h1", 20, 100 * us);
  add_stream(problem, "h0", "h1", 20, 150 * us);
  add_stream(problem, "h0", "h1", 10, 50 * us);
  EXPECT_EQ(decided(problem).verdict, Verdict::scheduled);
}

// s0 fixes a phase between the links into and out of b1, and so does s1; strictly, at these loads, one of them has to
// wait in b1.
TEST(Search, LetsFramesWaitInBridges) {
  Problem problem = line(3, 0, 0);
  problem.model.is_strict = true;
  // On b1>b2: 60 of 100 us come from h0, 40 from h1. On b0>b1 the 60 us stand beside 40 us for h1.
  for (int i = 0; i < 2; ++i) add_stream(problem, "h0", "h2", 30, 100 * us);
  add_stream(problem, "h0", "h1", 40, 100 * us);
  add_stream(problem, "h1", "h2", 40, 100 * us);
  EXPECT_EQ(decided(problem, 64).verdict, Verdict::scheduled);
}

TEST(Search, ReachesAllListenersByATree) {
  Problem problem = line(3);
  Stream& stream = add_stream(problem, "h0", "h2", 5, 100 * us);
  stream.listeners.push_back(node_of(problem, "h1"));
  std::sort(stream.listeners.begin(), stream.listeners.end());
  const Decision decision = decided(problem);
  ASSERT_EQ(decision.verdict, Verdict::scheduled);
  EXPECT_EQ(decision.found.solution.streams[0]->route.size(), 5u);  // h0>b0, b0>b1, b1>h1, b1>b2, b2>h2
}

// Both ways round a ring: each carries 60 %, so one stream must take the longer one.
TEST(Search, FindsOtherWays) {
  Problem problem = line(3);
  for (const auto& [a, b] : {std::pair("b0", "b2"), std::pair("b2", "b0")}) {
    Link link = problem.links.back();
    link.from = node_of(problem, a);
    link.to = node_of(problem, b);
    link.name = std::string(a) + ">" + b;
    problem.links.push_back(link);
  }
  problem.nodes.push_back({"g0", false});
  problem.links.push_back({"g0>b0", node_of(problem, "g0"), node_of(problem, "b0"), 8'000, 0, 0, std::nullopt, 1024});
  problem.nodes.push_back({"g2", false});
  problem.links.push_back({"b2>g2", node_of(problem, "b2"), node_of(problem, "g2"), 8'000, 0, 0, std::nullopt, 1024});
  add_stream(problem, "h0", "h2", 60, 100 * us);
  add_stream(problem, "g0", "g2", 60, 100 * us);
  SearchOptions options;
  options.attempts = 8;
  options.routes = RouteChoice::shortest;
  EXPECT_NE(decide(problem, options).verdict, Verdict::scheduled);
  EXPECT_EQ(decided(problem).verdict, Verdict::scheduled);
}

TEST(Search, SaysWhoIsLeftOverAndWhoIsInTheWay) {
  Problem problem = line(2);
  problem.model.is_strict = true;
  // Pairwise they fit modulo 10 us (4 + 4), folded load knows it: 4/10 three times is too much.
  for (const Ps period : {20 * us, 30 * us, 50 * us}) add_stream(problem, "h0", "h1", 4, period);
  SearchOptions options;
  options.attempts = 3;
  const SearchResult result = search(problem, options);
  ASSERT_EQ(result.left_over.size(), 1u);
  EXPECT_EQ(result.left_over[0].in_the_way.size(), 1u);
}

TEST(Search, SameForAnyNumberOfJobs) {
  std::size_t complete = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Problem problem = random_problem(seed);
    SearchOptions options;
    options.attempts = 6;
    const SearchResult one = search(problem, options);
    options.jobs = 3;
    const SearchResult three = search(problem, options);
    EXPECT_EQ(one.is_complete(), three.is_complete());
    if (!one.is_complete()) continue;
    ++complete;
    EXPECT_EQ(one.attempt, three.attempt);
    for (StreamIndex s = 0; s < problem.streams.size(); ++s)
      EXPECT_EQ(one.solution.streams[s]->starts, three.solution.streams[s]->starts);
  }
  EXPECT_GE(complete, 6u);
}

// Whatever the features: what is found is a schedule, what is refuted is proved.
TEST(Search, IsJudgedRightOnRandomProblems) {
  std::size_t scheduled = 0, infeasible = 0;
  EXPECT_TRUE(rc::check("judged right", [&] {
    const Problem problem = random_problem(*rc::gen::arbitrary<std::uint64_t>());
    SearchOptions options;
    options.attempts = 4;
    const Decision decision = decide(problem, options);
    if (decision.verdict == Verdict::scheduled) {
      ++scheduled;
      const auto wrong = schedule_check::check(problem, decision.found.solution);
      if (!wrong.empty()) RC_FAIL(wrong.front());
    }
    if (decision.certificate) {
      ++infeasible;
      RC_ASSERT(schedule_check::why_not_proved(problem, *decision.certificate).empty());
    }
  }));
  EXPECT_GT(scheduled, 40u);
}

TEST(Objective, SlackIsTheGreatestMargin) {
  // One frame of 10 us a 100 us on one hop, held by its gates: nothing but the period limits the margin there; behind a
  // bridge the latency does.
  Problem problem = line(2, 0, 0);
  add_stream(problem, "h0", "h1", 10, 100 * us);
  problem.streams[0].latency = 3 * 9'904'000 + 1 * us;  // two bridges: half a us each
  SearchOptions options;
  const Decision decision = decide(problem, options, Objective::slack);
  EXPECT_EQ(decision.margin, us / 2);
}

}  // namespace
}  // namespace takt::schedule::search_test
