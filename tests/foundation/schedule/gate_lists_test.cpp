// SPDX-License-Identifier: Apache-2.0
// Gate control lists, entry by entry.
#include "schedule/gate_lists.hpp"

#include <gtest/gtest.h>

#include "schedule/decide.hpp"
#include "schedule_check/instance_check.hpp"
#include "small_problem.hpp"

namespace takt::schedule::gate_lists_test {
namespace {

/// h0 sends 10 us at each of these times a 100 us.
std::pair<Problem, Solution> sent_at(std::vector<Ps> times) {
  Problem problem = line(1);
  problem.nodes.push_back({"g", false});
  problem.links.push_back({"b0>g", node_of(problem, "b0"), node_of(problem, "g"), 8'000, 0, 0, std::nullopt, 1024});
  Solution solution;
  for (const Ps at : times) {
    Stream& stream = add_stream(problem, "h0", "g", 10, 100 * us);
    Placement placement;
    placement.route = {link_of(problem, "h0>b0"), link_of(problem, "b0>g")};
    placement.starts = {{at}, {at + 9'904'000 + us}};
    placement.classes = {stream.traffic_class, stream.traffic_class};
    solution.streams.emplace_back(placement);
  }
  return {problem, solution};
}

TEST(GateLists, TwoEntriesAWindow) {
  auto [problem, solution] = sent_at({20 * us});
  ASSERT_EQ(make_gate_lists(problem, solution, {}), std::nullopt);
  EXPECT_EQ(schedule_check::check(problem, solution), std::vector<std::string>{});
  const GateList& list = solution.gates.at(link_of(problem, "h0>b0"));
  EXPECT_EQ(list.cycle, 100 * us);
  // Closed for the others a gap (96 ns) before; the frame is 9.904 us.
  EXPECT_EQ(list.entries, (std::vector<GateEntry>{{19'904'000, 0x7f}, {10 * us, 0x80}, {70'096'000, 0x7f}}));
}

TEST(GateLists, BackToBackIsOneWindow) {
  auto [problem, solution] = sent_at({20 * us, 30 * us, 50 * us});
  ASSERT_EQ(make_gate_lists(problem, solution, {}), std::nullopt);
  EXPECT_EQ(solution.gates.at(link_of(problem, "h0>b0")).entries.size(), 5u);
}

TEST(GateLists, ShortestTimesBetweenAreGivenUp) {
  auto [problem, solution] = sent_at({10 * us, 23 * us, 50 * us});
  ASSERT_EQ(make_gate_lists(problem, solution, {}), std::nullopt);
  EXPECT_EQ(most_entries(solution), 7u);
  ASSERT_EQ(make_gate_lists(problem, solution, {5}), std::nullopt);
  EXPECT_EQ(schedule_check::check(problem, solution), std::vector<std::string>{});
  const GateList& list = solution.gates.at(link_of(problem, "h0>b0"));
  ASSERT_EQ(list.entries.size(), 5u);
  EXPECT_EQ(list.entries[1].interval, 23 * us);  // 9.904 to 32.904: the 3 us between the first two
  ASSERT_EQ(make_gate_lists(problem, solution, {1}), std::nullopt);
  EXPECT_EQ(most_entries(solution), 1u);
  EXPECT_EQ(schedule_check::check(problem, solution), std::vector<std::string>{});
}

TEST(GateLists, RoundTheEndOfTheCycle) {
  auto [problem, solution] = sent_at({95 * us});
  ASSERT_EQ(make_gate_lists(problem, solution, {}), std::nullopt);
  EXPECT_EQ(schedule_check::check(problem, solution), std::vector<std::string>{});
  EXPECT_EQ(solution.gates.at(link_of(problem, "h0>b0")).entries.size(), 3u);
}

TEST(GateLists, AWaitingFrameIsHeldByItsGate) {
  auto [problem, solution] = sent_at({20 * us});
  solution.streams[0]->starts[1][0] += 5 * us;
  ASSERT_EQ(make_gate_lists(problem, solution, {}), std::nullopt);
  EXPECT_EQ(schedule_check::check(problem, solution), std::vector<std::string>{});
  const GateList& list = solution.gates.at(link_of(problem, "b0>g"));
  ASSERT_EQ(list.entries.size(), 4u);
  EXPECT_EQ(list.entries[1], (GateEntry{96'000, 0}));
}

TEST(GateLists, ListsOfRandomSchedulesAreRight) {
  std::size_t lists = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Problem problem = random_problem(seed);
    SearchOptions options;
    options.attempts = 4;
    Decision decision = decide(problem, options);
    if (decision.verdict != Decision::Verdict::scheduled) continue;
    if (make_gate_lists(problem, decision.found.solution, {})) continue;
    ++lists;
    const auto wrong = schedule_check::check(problem, decision.found.solution);
    EXPECT_TRUE(wrong.empty()) << seed << ": " << wrong.front();
  }
  EXPECT_GT(lists, 20u);
}

}  // namespace
}  // namespace takt::schedule::gate_lists_test
