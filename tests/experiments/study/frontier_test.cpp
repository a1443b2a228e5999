// SPDX-License-Identifier: Apache-2.0
// Studies of schedules: draws, what becomes of them, and the frontier.
#include "study/frontier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "scenario/resolve.hpp"
#include "study/report.hpp"
#include "study/runner.hpp"
#include "support.hpp"

namespace takt::study {
namespace {

/// Two hosts at a switch, 100 Mbit/s. Frames of 100 octets with 28 octets of headers, 18 of Ethernet and a tag of 4
/// take 12.64 us with preamble and gap (158 octets of 80 ns): into 50 us go three of them.
std::string draws_study(const std::string& members,
                        const std::string& streams = R"("every": ["50us"], "payload": ["100B"])") {
  return R"({"name": "draws", "scenario": {"name": "pair", "duration": "1ms",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "s": {"kind": "switch"}}, "links": [{"ends": ["a", "s"], "rate": "100Mbps"}, {"ends": ["b", "s"], "rate": "100Mbps"}]}},
    "schedule": {"streams": {)" +
         streams +
         R"(}, "attempts": 4}, "measures": [{"name": "scheduled", "of": "scheduled", "unit": "%"}, {"name": "left", "of": "left_over"}], )" +
         members + "}";
}

const std::string counts =
    R"("replications": 30, "factors": [{"name": "streams", "set": ["/schedule/streams/count"], "values": [8, 2, 4, 6]}])";

std::unique_ptr<Plan> loaded(const Folder& folder, const std::string& text, std::string* told = nullptr) {
  json::Diagnostics diagnostics;
  auto plan = load_plan(folder.write("draws.json", text), diagnostics);
  if (told != nullptr)
    *told = diagnostics.to_text();
  else
    EXPECT_TRUE(plan) << diagnostics.to_text();
  return plan;
}

schedule::Problem problem_of(const Plan& plan, const Variant& variant, std::uint64_t seed) {
  json::Diagnostics diagnostics;
  const auto scenario = scenario_of(plan, variant, seed, diagnostics);
  const auto resolved = scenario::resolve(*scenario, diagnostics);
  return drawn_problem(*resolved, *scheduling_of(plan, variant, diagnostics), seed);
}

std::unique_ptr<Content> content_of(const Folder& folder, const Plan& plan, unsigned jobs) {
  const std::string path = folder.file("store" + std::to_string(jobs) + ".sqlite");
  std::string problem;
  auto store = Store::create(path, plan, problem);
  EXPECT_TRUE(store) << problem;
  const std::vector<bool> finished(plan.points(), false);
  RunOptions options;
  options.jobs = jobs;
  EXPECT_EQ(validate(plan, options, finished), "");
  EXPECT_EQ(run_study(plan, *store, options, finished).problem, "");
  store.reset();
  auto content = read_store(path, problem);
  EXPECT_TRUE(content) << problem;
  return content;
}

TEST(Draws, FewerAreTheFirstOfMore) {
  const Folder folder;
  const auto plan = loaded(
      folder,
      draws_study(counts,
                  R"("every": ["50us", "100us", "200us"], "payload": ["100B", "900B"], "latency": ["80us", "90us"])"));
  const schedule::Problem few = problem_of(*plan, {1}, 7), many = problem_of(*plan, {0}, 7),
                          other = problem_of(*plan, {0}, 8);
  ASSERT_EQ(few.streams.size(), 2u);
  ASSERT_EQ(many.streams.size(), 8u);
  bool differs = false;
  for (std::size_t i = 0; i < many.streams.size(); ++i) {
    const schedule::Stream& stream = many.streams[i];
    EXPECT_NE(stream.talker, stream.listeners.front());
    EXPECT_TRUE(stream.period == 50'000'000 || stream.period == 100'000'000 || stream.period == 200'000'000);
    EXPECT_TRUE(stream.octets == 150 || stream.octets == 950);
    EXPECT_TRUE(stream.latency == 80'000'000 || stream.latency == 90'000'000);
    differs = differs || stream.period != other.streams[i].period || stream.octets != other.streams[i].octets;
    if (i >= few.streams.size()) continue;
    EXPECT_EQ(stream.talker, few.streams[i].talker);
    EXPECT_EQ(stream.period, few.streams[i].period);
    EXPECT_EQ(stream.octets, few.streams[i].octets);
  }
  EXPECT_TRUE(differs);
}

// All streams of one direction cross the same two links, so there is a schedule if and only if at most three go either
// way.
TEST(Draws, AreScheduledExactlyIfThereIsRoom) {
  const Folder folder;
  const auto plan = loaded(folder, draws_study(counts));
  const auto content = content_of(folder, *plan, 2);
  ASSERT_EQ(content->rows(), 120u);
  std::array<std::size_t, 2> seen{};
  for (std::size_t row = 0; row < content->rows(); ++row) {
    const schedule::Problem problem =
        problem_of(*plan, content->variants[content->variant[row]], plan->seed_of(content->point_of(row)));
    const auto there = static_cast<std::size_t>(
        std::ranges::count_if(problem.streams, [](const schedule::Stream& stream) { return stream.talker == 0; }));
    const bool fits = std::max(there, problem.streams.size() - there) <= 3;
    EXPECT_EQ(content->verdict[row], fits ? "scheduled" : "infeasible");
    EXPECT_EQ(content->passes[row], fits);
    EXPECT_EQ(content->measures[0].values[row], fits ? 100 : 0);
    ++seen[fits];
  }
  EXPECT_GT(seen[0], 10u);
  EXPECT_GT(seen[1], 10u);
}

TEST(Draws, SameForAnyNumberOfJobsAndThreads) {
  const Folder folder;
  const auto plan = loaded(folder, draws_study(counts));
  const auto one = content_of(folder, *plan, 1), three = content_of(folder, *plan, 3);
  EXPECT_EQ(one->verdict, three->verdict);
  for (const std::uint64_t point : {0u, 45u, 119u})
    EXPECT_EQ(run_point(*plan, point, 1).digest, run_point(*plan, point, 3).digest);
}

// Of 2 streams all are scheduled, of 8 none (some direction has four).
TEST(Frontier, IsUpToWhereEnoughDrawsAreScheduled) {
  const Folder folder;
  const auto plan = loaded(folder, draws_study(counts));
  const auto content = content_of(folder, *plan, 2);
  const auto frontier = frontier_of(*content);
  ASSERT_TRUE(frontier);
  EXPECT_EQ(frontier->levels, (std::vector<std::uint32_t>{1, 2, 3, 0}));
  EXPECT_EQ(frontier->topologies, std::vector<std::string>{""});
  EXPECT_EQ(frontier->methods, std::vector<std::string>{""});
  const std::vector<Draws>& draws = frontier->draws[0][0];
  EXPECT_EQ(draws[0].scheduled, 30u);
  EXPECT_EQ(draws[3].infeasible, 30u);
  for (const Draws& each : draws) EXPECT_EQ(each.all(), 30u);
  EXPECT_GT(draws[1].scheduled, draws[2].scheduled);
  EXPECT_EQ(frontier->reach(0, 0, 0.99), 0u);
  const double share_of_four = static_cast<double>(draws[1].scheduled) / 30;
  EXPECT_EQ(frontier->reach(0, 0, share_of_four), 1u);
  EXPECT_EQ(frontier->reach(0, 0, share_of_four + 0.01), 0u);
  Frontier none = *frontier;
  none.draws[0][0][0].scheduled = 0;
  EXPECT_EQ(none.reach(0, 0, 0.1), std::nullopt);
  const std::string page = html_report(*content);
  EXPECT_NE(page.find("Feasibility frontier"), std::string::npos);
  EXPECT_NE(page.find("feasibility frontier: streams of which 90 % and more are scheduled"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("0 / 100 / 0"), std::string::npos);
  EXPECT_NE(text_summary(*content).find(" infeasible, 0 undecided"), std::string::npos) << text_summary(*content);
}

TEST(Frontier, HasTopologiesAndMethods) {
  const Folder folder;
  const auto plan = loaded(folder, draws_study(R"("replications": 2, "factors": [
    {"name": "topology", "topologies": {"line": {"topology": "line", "switches": 2}, "ring": {"topology": "ring", "switches": 3}}},
    {"name": "method", "patches": {"shortest": {"/schedule/routes": "shortest"}, "waiting": {"/schedule/waiting": true, "/schedule/routes": "search"}}},
    {"name": "streams", "set": [{"at": "/schedule/streams/count"}], "values": [2, 4]}])"));
  const auto content = content_of(folder, *plan, 2);
  const auto frontier = frontier_of(*content);
  ASSERT_TRUE(frontier);
  EXPECT_EQ(frontier->across, "topology");
  EXPECT_EQ(frontier->topologies, (std::vector<std::string>{"line", "ring"}));
  EXPECT_EQ(frontier->methods, (std::vector<std::string>{"shortest", "waiting"}));
  for (const auto& methods : frontier->draws)
    for (const auto& levels : methods)
      for (const Draws& draws : levels) EXPECT_EQ(draws.all(), 2u);
}

TEST(Frontier, IsNotOfStudiesThatRun) {
  const Folder folder;
  const auto plan =
      plan_of(folder, R"("factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "200B"]}])");
  EXPECT_FALSE(frontier_of(*content_of(folder, *plan, 1)));
}

TEST(Draws, MistakesAreTold) {
  const Folder folder;
  std::string told;
  EXPECT_FALSE(loaded(
      folder,
      draws_study(R"("factors": [{"name": "n", "set": ["/schedule/streams/count"], "values": [1, 2]}], "limits": [])",
                  R"("every": [], "payload": ["9999999B"])"),
      &told));
  EXPECT_NE(told.find("/schedule/streams/every"), std::string::npos) << told;
  EXPECT_NE(told.find("/schedule/streams/payload/0"), std::string::npos) << told;
  std::string text = draws_study(counts);
  text.replace(text.find("\"of\": \"left_over\""), 17, "\"of\": \"left_ovr\" ");
  EXPECT_FALSE(loaded(folder, text, &told));
  EXPECT_NE(told.find("not a figure of a schedule: found \"left_ovr\", expected one of scheduled, infeasible, "
                      "undecided, left_over"),
            std::string::npos)
      << told;
  EXPECT_NE(told.find("did you mean \"left_over\"?"), std::string::npos) << told;
  // What is wrong with single variants, or with all.
  const auto mistakes = [&](const std::string& study) {
    const auto plan = loaded(folder, study);
    return plan ? validate(*plan, {}, std::vector<bool>(plan->points(), false)) : std::string();
  };
  EXPECT_NE(mistakes(draws_study(R"("factors": [{"name": "n", "set": ["/schedule/streams/count"], "values": [0, 2]}])"))
                .find("/schedule/streams/count: out of range: found the number 0"),
            std::string::npos);
  EXPECT_NE(mistakes(draws_study(R"("factors": [{"name": "n", "set": ["/schedule/streams/cuont"], "values": [1, 2]}])"))
                .find("cuont"),
            std::string::npos);
  text = draws_study(counts);
  text.replace(
      text.find("\"name\": \"pair\","), 15,
      R"("name": "pair", "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}],)");
  EXPECT_NE(mistakes(text).find("traffic in a study of schedules"), std::string::npos);
}

}  // namespace
}  // namespace takt::study
