// SPDX-License-Identifier: Apache-2.0
// A study says no better of a variant than takt verify: worst found, bound and verdict of each point, and phases that
// nobody gave.
#include "study/verified.hpp"

#include <gtest/gtest.h>

#include "study/content.hpp"
#include "study/find.hpp"
#include "study/phases.hpp"
#include "study/point.hpp"
#include "study/store.hpp"
#include "support.hpp"

namespace takt::study {
namespace {

/// x from a and y from c, both to b over a switch, each every millisecond; nobody says when. 20 ms.
std::string two_talkers(const std::string& members) {
  return R"({"name": "two", "scenario": {"name": "two", "duration": "20ms",
    "network": {"nodes": {"a": {"kind": "host"}, "c": {"kind": "host"}, "b": {"kind": "host"}, "s": {"kind": "switch", "forwarding_delay": "1us"}},
                "links": [{"ends": ["a", "s"], "length": "0m"}, {"ends": ["c", "s"], "length": "0m"}, {"ends": ["b", "s"], "length": "0m"}]},
    "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}, {"name": "y", "from": "c", "to": "b", "payload": "1000B", "every": "1ms"}],
    "require": [{"stream": "x", "latency": "95us"}]}, )" +
         members + "}";
}

std::unique_ptr<Plan> planned(const Folder& folder, const std::string& text, std::string* problems = nullptr) {
  json::Diagnostics diagnostics;
  auto plan = load_plan(folder.write("study.json", text), diagnostics);
  if (problems != nullptr)
    *problems = diagnostics.to_text();
  else
    EXPECT_TRUE(plan) << diagnostics.to_text();
  return plan;
}

const std::string rates =
    R"("factors": [{"name": "rate", "set": ["/network/links/2/rate"], "values": ["1Gbps", "100Mbps"]}])";
const std::string three_measures =
    R"("measures": [{"name": "delay", "of": "latency.x.max", "unit": "us"}, {"name": "worst", "of": "worst.latency.x.max", "unit": "us"},
                                                   {"name": "bound", "of": "bound.latency.x.max", "unit": "us"}, {"name": "verdict", "of": "verdict"}])";

TEST(Verified, WorstFoundAndBoundOfEachPoint) {
  const Folder folder;
  const auto plan = planned(folder, two_talkers(rates + ", " + three_measures));
  ASSERT_TRUE(plan);
  EXPECT_TRUE(plan->is_verified());
  const Outcome outcome = run_point(*plan, 0);
  ASSERT_EQ(outcome.status, Status::done) << outcome.error;
  // x has 100 + 28 + 18 = 146 octets; its last bit has come after 154, preamble counted: 1.232 us, twice, and 1 us in
  // the switch. Behind y, of 1046 octets, which has begun just before it at the port to b, it waits for 1066, preamble
  // and gap counted: 8.528 us.
  constexpr double alone = 2 * 1.232 + 1;
  constexpr double behind = alone + 8.528;
  EXPECT_NEAR(*outcome.values[0], alone, 1e-9) << "the phases of seed 1 are far apart";
  EXPECT_NEAR(*outcome.values[1], behind, 0.0011) << "y comes a nanosecond before it";
  EXPECT_LE(*outcome.values[1], *outcome.values[2]);
  EXPECT_NEAR(*outcome.values[2], behind, 1e-9) << "tight";
  EXPECT_EQ(outcome.values[3], 1.0);
  EXPECT_EQ(outcome.verdict, "pass");
  EXPECT_TRUE(outcome.passes);
}

// By runs alone the slow link passes: x takes 1.232 + 1 + 12.32 us, and meets y by chance only.
TEST(Verified, ARequirementThatASearchRefutes) {
  const Folder folder;
  const auto plan =
      planned(folder, two_talkers(rates + R"(, "measures": [{"name": "delay", "of": "latency.x.max", "unit": "us"}])"));
  const auto verified = planned(folder, two_talkers(rates + ", " + three_measures));
  ASSERT_TRUE(plan && verified);
  EXPECT_TRUE(run_point(*plan, 1).passes);
  const Outcome outcome = run_point(*verified, 1);
  EXPECT_EQ(outcome.verdict, "refuted");
  EXPECT_FALSE(outcome.passes);
  EXPECT_EQ(outcome.values[3], 0.0);
  EXPECT_NEAR(*outcome.values[1], 14.552 + 85.28, 0.0011) << "behind the 1066 octets of y at 100 Mb/s";
  EXPECT_EQ(*outcome.values[0], *run_point(*plan, 1).values[0]) << "the run is the same";
}

TEST(Verified, TheSameOnAnyNumberOfThreads) {
  const Folder folder;
  const auto plan = planned(folder, two_talkers(rates + ", " + three_measures));
  ASSERT_TRUE(plan);
  Outcome one = run_point(*plan, 1), two = run_point(*plan, 1, 2);
  one.cpu_us = two.cpu_us = 0;
  EXPECT_EQ(packed(one), packed(two));
}

// An unbounded stream has a worst found and no bound; a limit of the bound is not kept then.
TEST(Verified, WhatNothingBounds) {
  const Folder folder;
  std::string text =
      two_talkers(rates + ", " + three_measures + R"(, "limits": [{"measure": "bound", "at_most": "1s"}])");
  text.replace(text.find(R"("payload": "1000B", "every": "1ms")"), 34, R"("payload": "1000B", "exponential": "1ms")");
  const auto plan = planned(folder, text);
  ASSERT_TRUE(plan);
  const Outcome outcome = run_point(*plan, 0);
  ASSERT_EQ(outcome.status, Status::done) << outcome.error;
  EXPECT_TRUE(outcome.values[1]);
  EXPECT_FALSE(outcome.values[2]);
  EXPECT_FALSE(outcome.values[3]) << "undecided";
  EXPECT_EQ(outcome.verdict, "undecided");
  EXPECT_FALSE(outcome.passes);
}

// A halt that is never complete has no greatest duration, and no worst one either.
TEST(Verified, WhatSomeRunDoesNotHave) {
  const Folder folder;
  const auto plan = planned(folder, R"({"name": "cut", "scenario": {"name": "cut", "duration": "60ms",
    "network": {"nodes": {"m": {"kind": "host"}, "s1": {"kind": "host"}, "sw": {"kind": "switch"}}, "links": [{"ends": ["m", "sw"]}, {"ends": ["s1", "sw"]}]},
    "programs": [{"name": "p", "master": "m", "slaves": ["s1"], "cycle": "1ms"}],
    "script": [{"at": "10ms", "program": "p", "call": "Start"}, {"at": "59.9ms", "program": "p", "call": "Halt", "on": "s1"}]},
    "factors": [{"name": "seed_of_nothing", "set": ["/description"], "values": ["a"]}],
    "measures": [{"name": "worst_start", "of": "worst.reaction.start.max", "unit": "ms"}, {"name": "worst_halt", "of": "worst.reaction.halt.max", "unit": "ms"}]})");
  ASSERT_TRUE(plan);
  plan->study.verify.budget = 0.1;
  const Outcome outcome = run_point(*plan, 0);
  ASSERT_EQ(outcome.status, Status::done) << outcome.error;
  EXPECT_TRUE(outcome.values[0]);
  EXPECT_FALSE(outcome.values[1]) << "the run ends before it is complete";
}

TEST(Verified, FiguresWithoutAWorstCase) {
  const Folder folder;
  for (const char* const of :
       {"worst.lost", "bound.latency.x.p99", "worst.reaction.halt.mean", "bound./streams/x/delivered"}) {
    std::string problems;
    EXPECT_FALSE(
        planned(folder, two_talkers(rates + R"(, "measures": [{"name": "w", "of": ")" + of + "\"}]"), &problems));
    EXPECT_NE(problems.find("a figure without a worst case"), std::string::npos) << problems;
  }
  std::string problems;
  EXPECT_FALSE(
      planned(folder, two_talkers(rates + R"(, "measures": [{"name": "w", "of": "worst.latency.z.max"}])"), &problems));
  EXPECT_NE(problems.find("unknown stream"), std::string::npos) << problems;
}

TEST(Verified, StoresKeepWhoseFiguresTheyAre) {
  const Folder folder;
  const auto plan = planned(folder, two_talkers(rates + ", " + three_measures));
  ASSERT_TRUE(plan);
  std::string problem;
  ASSERT_TRUE(Store::create(folder.file("s.sqlite"), *plan, problem)) << problem;
  const auto content = read_store(folder.file("s.sqlite"), problem);
  ASSERT_TRUE(content) << problem;
  std::vector<Basis> bases;
  for (const ContentMeasure& measure : content->measures) bases.push_back(measure.basis);
  EXPECT_EQ(bases, (std::vector<Basis>{Basis::run, Basis::worst, Basis::bound, Basis::verdict}));
}

// Half a period is half a period, whatever the period; what the scenario says stays; other seeds and names have others.
TEST(Phases, AreDrawnByTheSeed) {
  const auto drawn = [](const char* every, const char* seed) {
    json::Diagnostics diagnostics;
    const auto document = json::parse(
        std::string(R"({"name": "t", "duration": "1ms", "seed": )") + seed +
            R"(, "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
      "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "every": ")" +
            every + R"("}, {"name": "y", "from": "a", "to": "b", "payload": "100B", "every": ")" + every + R"("},
                  {"name": "said", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "offset": "0s"}, {"name": "chance", "from": "a", "to": "b", "payload": "100B", "exponential": "1ms"}],
      "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": ")" +
            every + R"(", "phases": {"b": "1us"}}]})",
        "t", diagnostics);
    scenario::Scenario scenario;
    json::decode(*document, scenario, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_text();
    return with_drawn_phases(scenario);
  };
  const auto phase_of = [](const scenario::Scenario& scenario, std::size_t stream) {
    return sim::Duration(*scenario.streams[stream].offset);
  };
  const scenario::Scenario one = drawn("1ms", "1"), longer = drawn("4ms", "1"), other = drawn("1ms", "2");
  EXPECT_GT(phase_of(one, 0), sim::Duration());
  EXPECT_LT(phase_of(one, 0), sim::Duration::from_ps(1'000'000'000));
  EXPECT_EQ(phase_of(longer, 0).ps() / 4, phase_of(one, 0).ps());
  EXPECT_NE(phase_of(one, 1), phase_of(one, 0));
  EXPECT_NE(phase_of(other, 0), phase_of(one, 0));
  EXPECT_EQ(phase_of(one, 2), sim::Duration());
  EXPECT_FALSE(one.streams[3].offset);
  ASSERT_EQ(one.programs[0].phases.size(), 2u);
  EXPECT_EQ(one.programs[0].phases[0].second, sim::Duration::from_ps(1'000'000));
}

// The finding: 750us by runs, of which takt verify refutes 500us and 750us. The limit of the answer is the bound.
TEST(Find, AnswersByTheBound) {
  json::Diagnostics diagnostics;
  const auto plan = load_plan(std::string(TAKT_SOURCE_DIR) + "/tests/findings/study-of-a-cycle.json", diagnostics);
  ASSERT_TRUE(plan) << diagnostics.to_text();
  plan->study.verify.budget = 1;
  std::string problem;
  const auto question = read_question(*plan, "max cycle such that halt <= 1ms", {}, problem);
  ASSERT_TRUE(question) << problem;
  const Finding finding = find(*plan, *question, {});
  ASSERT_EQ(finding.problem, "");
  const auto text = [&](std::uint32_t level) { return plan->factors[question->factor].levels[level].text; };
  ASSERT_TRUE(finding.proved);
  EXPECT_EQ(text(*finding.proved), "250us");
  EXPECT_EQ(text(*finding.open), "250us") << "500us is refuted: a halt of 1.2 ms is found";
  const std::string page = text_of(*plan, *question, finding);
  EXPECT_NE(page.find("max cycle such that halt <= 1ms: 250us, by the bound\n"), std::string::npos) << page;
  EXPECT_NE(page.find("refuted    holds in 5 of 5 runs; halt"), std::string::npos) << page;
}

// Nothing bounds the load, whose gaps are exponential: the answer is by the worst found, and says so.
TEST(Find, AnswersByTheWorstFoundWhereNothingIsProved) {
  const Folder folder;
  std::string study = two_talkers(rates + R"(, "measures": [{"name": "delay", "of": "latency.x.max", "unit": "us"}])");
  study.replace(study.find(R"("payload": "1000B", "every": "1ms")"), 34, R"("payload": "1000B", "exponential": "1ms")");
  const auto plan = planned(folder, study);
  std::string problem;
  const auto question = read_question(*plan, "max rate such that delay <= 1s", {}, problem);
  ASSERT_TRUE(question) << problem;
  const Finding finding = find(*plan, *question, {});
  EXPECT_FALSE(finding.proved);
  ASSERT_TRUE(finding.level());
  const std::string page = text_of(*plan, *question, finding);
  EXPECT_NE(page.find("1Gbps, by the worst found"), std::string::npos) << page;
  EXPECT_NE(page.find("no bound excludes one"), std::string::npos) << page;
}

TEST(Find, SaysWhatOnlyRunsShow) {
  const Folder folder;
  const auto plan = planned(
      folder,
      two_talkers(rates +
                  R"(, "replications": 3, "measures": [{"name": "delay", "of": "latency.x.max", "unit": "us"}])"));
  plan->study.verify.budget = 0.1;
  std::string problem;
  const auto question = read_question(*plan, "min rate such that delay <= 200us && lost == 0", {}, problem);
  ASSERT_TRUE(question) << problem;
  const std::string page = text_of(*plan, *question, find(*plan, *question, {}));
  EXPECT_NE(page.find("100Mbps, by the bound and, of lost, by 3 runs"), std::string::npos) << page;
  EXPECT_NE(page.find("With 95 % confidence"), std::string::npos) << page;
}

}  // namespace
}  // namespace takt::study
