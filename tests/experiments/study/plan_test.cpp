// SPDX-License-Identifier: Apache-2.0
// Mistakes of study files: each is told with its place, all at once.
#include "study/plan.hpp"

#include <gtest/gtest.h>

#include "scenario/division/division.hpp"
#include "scenario/resolve.hpp"
#include "study/point.hpp"
#include "support.hpp"

namespace takt::study {
namespace {

std::string problems(const std::string& members) {
  const Folder folder;
  std::string text;
  EXPECT_FALSE(plan_of(folder, members, &text)) << members;
  return text;
}

const std::string factor =
    R"("factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "200B"]}])";

TEST(Plan, MistakesAreTold) {
  const std::pair<const char*, const char*> cases[] = {
      {R"("factors": [])", "at /factors"},
      {R"("factors": [{"name": "a", "values": [1]}])", "levels that set nothing"},
      {R"("factors": [{"name": "a", "set": ["/seed"], "values": [1]}])", "the seed cannot be a factor"},
      {R"("factors": [{"name": "a b", "set": ["/x"], "values": [1]}])", "not a name for a factor"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1, 1]}])", "a level occurs twice"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1], "range": {"from": 1, "to": 2}}])", "range"},
      {R"("factors": [{"name": "a", "set": ["/x"], "range": {"from": "1us", "to": "2us"}}])", "\"step\" or \"steps\""},
      {R"("factors": [{"name": "a", "set": ["/x"], "range": {"from": "1us", "to": "2Mbps", "steps": 3}}])",
       "of the same kind"},
      {R"("factors": [{"name": "a", "set": ["/x"], "range": {"from": 5, "to": 2}}])", "more than \"from\""},
      {R"("factors": [{"name": "a", "set": [{"at": "/x", "each": "h"}], "values": [1]}])", "a text with {}"},
      {R"("factors": [{"name": "a", "set": [{"at": "/x", "each": "h{}"}], "values": ["x"]}])", "not a count"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1], "baseline": 2}])", "not a level of this factor"},
      {R"("factors": [{"name": "delay", "set": ["/x"], "values": [1]}])", "names of factors and measures that differ"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "constraints": ["b < 1"])", "unknown factor"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "constraints": ["a <"])", "not a condition"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "constraints": ["a > 1"])",
       "no combination of levels is left"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "design": "random")", "\"points\""},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "limits": [{"measure": "dely", "at_most": "1ms"}])",
       "did you mean \"delay\"?"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "limits": [{"measure": "delay", "at_most": "1B"}])",
       "not a limit of this figure"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "sizes": 3)", "unknown field \"sizes\""},
      {R"("factors": [{"name": "a", "set": ["/x"], "range": {"from": 1, "to": 100000}}, {"name": "b", "set": ["/y"], "range": {"from": 1, "to": 100000}}])",
       "too many combinations"},
  };
  for (const auto& [members, expected] : cases)
    EXPECT_NE(problems(members).find(expected), std::string::npos) << members << "\n" << problems(members);
}

TEST(Plan, EachMistakeHasItsPlace) {
  const std::string text = problems(
      R"("factors": [{"name": "a", "set": ["/x"], "values": [1, 1]}], "limits": [{"measure": "none", "at_most": 1}])");
  EXPECT_NE(text.find("study.json:5:"), std::string::npos) << text;
  EXPECT_NE(text.find("at /factors/0"), std::string::npos) << text;
  EXPECT_NE(text.find("at /limits/0/measure"), std::string::npos) << text;
}

TEST(Plan, VariantsThatAreNoScenarioTellWhy) {
  const Folder folder;
  const auto plan = plan_of(
      folder,
      R"("factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "9000B"]}, {"name": "typo", "set": ["/streams/0/palyoad"], "values": ["1B"]}])");
  ASSERT_TRUE(plan);
  EXPECT_NE(mistakes_of(*plan, 0).find("did you mean \"payload\"?"), std::string::npos);
  // Where the level that does it is written; `takt study` names it with the variant.
  EXPECT_NE(mistakes_of(*plan, 1).find("study.json:5:154: error at /streams/0/payload"), std::string::npos)
      << mistakes_of(*plan, 1);
}

// What a point may take and what the file says about itself are no part of what the points are.
TEST(Plan, ConfigurationDigest) {
  const Folder folder;
  const std::uint64_t digest = plan_of(folder, factor)->digest;
  EXPECT_EQ(plan_of(folder, factor + R"(, "description": "x", "effort": {"cpu": "1s"})")->digest, digest);
  EXPECT_NE(plan_of(folder, factor + R"(, "replications": 2)")->digest, digest);
  EXPECT_NE(plan_of(folder, factor + R"(, "limits": [{"measure": "delay", "at_most": "1ms"}])")->digest, digest);
}

// A mesh that is busy enough to be divided: nothing but the time tells the threads of a point.
TEST(Plan, APointIsTheSameOnSeveralThreads) {
  const Folder folder;
  const auto plan = plan_of(folder, factor);
  std::string text =
      R"({"name": "mesh", "duration": "2ms", "network": {"generate": [{"topology": "mesh", "rows": 6, "columns": 6, "hosts_per_switch": 4, "rate": "1Gbps", "forwarding_delay": "5us"}]}, "streams": [)";
  for (unsigned h = 0; h < 144; ++h)
    text += (h > 0 ? R"(,{"name": "s)" : R"({"name": "s)") + std::to_string(h) + R"(", "from": "h)" +
            std::to_string(h + 1) + R"(", "to": "h)" + std::to_string((h * 37 + 11) % 144 + 1) +
            R"(", "payload": "200B", "every": "60us", "offset": ")" + std::to_string(h * 791 % 60'000) + R"(ns"})";
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text + "]}", "mesh.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  ASSERT_TRUE(scenario::divide(*resolved, 2).is_divided()) << scenario::divide(*resolved, 2).why_fewer;
  const Outcome one = run_scenario(*plan, resolved->scenario, 1);
  const Outcome two = run_scenario(*plan, resolved->scenario, 2);
  EXPECT_EQ(one.status, Status::done);
  EXPECT_EQ(one.digest, two.digest);
  EXPECT_EQ(one.events, two.events);
  EXPECT_EQ(one.values, two.values);
}

TEST(Plan, APointIsTheRunOfItsScenario) {
  const Folder folder;
  const auto plan =
      plan_of(folder, factor + R"(, "replications": 2, "limits": [{"measure": "delay", "at_most": "4us"}])");
  const Outcome first = run_point(*plan, 0);
  EXPECT_EQ(first.status, Status::done);
  EXPECT_EQ(first.verdict, "nothing was required") << "limits are the study's, not the scenario's";
  EXPECT_EQ(run_point(*plan, 0).digest, first.digest);
  EXPECT_NE(run_point(*plan, 1).digest, first.digest) << "another seed";
  // Two links of 1 Gb/s: 100 B of data are 100 + 28 + 14 + 4 + 8 = 154 octets, 1.232 us each; and 1 us in the switch, 2
  // x 50 ns on 10 m by default or 0.
  ASSERT_TRUE(first.values[0]);
  EXPECT_GE(*first.values[0], 3.464);
  const auto back = unpacked(packed(first));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->digest, first.digest);
  EXPECT_EQ(back->values, first.values);
  EXPECT_FALSE(unpacked(packed(first).substr(1)));
  EXPECT_FALSE(unpacked(packed(first) + "x"));
}

// The base stands in the study: its mistakes have the study's lines, and pointers that lead from the study's root.
TEST(Plan, MistakesOfAnInlineBase) {
  const Folder folder;
  json::Diagnostics diagnostics;
  const std::string path = folder.write("study.json", R"({"name": "n",
  "scenario": {"name": "pair", "duration": "2ms",
    "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "s": {"kind": "switch"}},
                "links": [{"ends": ["a", "s"]}, {"ends": ["b", "t"]}]},
    "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "every": "50us", "pcp": 9}]},
  "factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "9000B"]}],
  "measures": [{"name": "delay", "of": "latency.x.max", "unit": "us"}]})");
  const auto plan = load_plan(path, diagnostics);
  ASSERT_TRUE(plan) << diagnostics.to_text();
  const std::string first = mistakes_of(*plan, 0);
  EXPECT_NE(first.find(path + ":4:64: error at /scenario/network/links/1/ends/1: unknown node"), std::string::npos)
      << first;
  EXPECT_NE(first.find(path + ":5:98: error at /scenario/streams/0/pcp: out of range"), std::string::npos) << first;
  EXPECT_EQ(first.find("/scenario/scenario"), std::string::npos) << first;
  // What a factor has put there is its own: the pointer is the one that the factor sets.
  const std::string second = mistakes_of(*plan, 1);
  EXPECT_NE(second.find(path + ":6:82: error at /streams/0/payload"), std::string::npos) << second;
}

// Gates are a factor like any other; where they do not fit, the reason is told, or kept.
TEST(Plan, AutomaticGatesAreAFactor) {
  const Folder folder;
  const auto text = [](const char* impossible) {
    return std::string(R"({"name": "n", "impossible": ")") + impossible +
           R"(", "scenario": {"name": "pair", "duration": "10ms",
    "network": {"generate": [{"topology": "line", "switches": 2, "hosts_per_switch": 2, "forwarding_delay": "1us"}]},
    "streams": [{"name": "x", "from": "h1", "to": "h3", "payload": "100B", "every": "100us", "offset": "0us", "pcp": 6},
                {"name": "y", "from": "h2", "to": "h3", "payload": "100B", "every": "100us", "offset": "50us", "pcp": 6},
                {"name": "load", "from": "h2", "to": "h4", "payload": "1400B", "exponential": "30us", "pcp": 0}]},
  "factors": [{"name": "gates", "patches": {"none": {"/gates": "none"}, "auto": {"/gates": {"plan": "auto", "classes": [6]}},
                 "by_hand": {"/network/generate/0/egress": [{"gates": {"entries": [{"open": [0, 1, 2, 3, 4, 5, 6, 7], "for": "100us"}]}}]}}},
              {"name": "offset", "set": ["/streams/1/offset"], "values": ["50us", "0.1us", "auto"]}],
  "measures": [{"name": "latency", "of": "latency.x.max", "unit": "us"}]})";
  };
  json::Diagnostics diagnostics;
  const auto plan = load_plan(folder.write("study.json", text("recorded")), diagnostics);
  ASSERT_TRUE(plan) << diagnostics.to_text();
  ASSERT_EQ(plan->points(), 9u);
  // 158 octets on three links of 1 Gb/s and 50 ns, two switches of 1 us.
  const double alone = 3 * (1.264 + 0.05) + 2;
  const Outcome fits = run_point(*plan, 3);
  EXPECT_EQ(fits.status, Status::done) << fits.error;
  EXPECT_DOUBLE_EQ(fits.values[0].value(), alone);
  EXPECT_GT(run_point(*plan, 0).values[0].value(), alone);
  EXPECT_GT(run_point(*plan, 6).values[0].value(), alone);
  const Outcome chosen = run_point(*plan, 5);
  EXPECT_EQ(chosen.status, Status::done) << chosen.error;
  EXPECT_DOUBLE_EQ(chosen.values[0].value(), alone);
  const Outcome meets = run_point(*plan, 4);
  EXPECT_EQ(meets.status, Status::impossible);
  EXPECT_NE(meets.error.find("windows that overlap: found at \"sw1 to sw2\" \"x\" from 2.314us"), std::string::npos)
      << meets.error;
  EXPECT_NE(meets.error.find("study.json:"), std::string::npos) << meets.error;
}

}  // namespace
}  // namespace takt::study
