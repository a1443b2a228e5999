// SPDX-License-Identifier: Apache-2.0
// Designs: how many variants, which ones, and the same on every machine.
#include "study/design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support.hpp"

namespace takt::study {
namespace {

const std::string three_factors = R"("factors": [
  {"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "200B", "300B"]},
  {"name": "rate", "set": ["/network/links/0/rate"], "values": ["100Mbps", "1Gbps"]},
  {"name": "prio", "set": ["/streams/0/pcp"], "range": {"from": 0, "to": 3}}])";

std::set<std::string> names_of(const Plan& plan) {
  std::set<std::string> names;
  for (const Variant& variant : plan.variants) names.insert(name_of(plan, variant));
  return names;
}

TEST(Design, GridHasEveryCombinationOnce) {
  const Folder folder;
  const auto plan = plan_of(folder, three_factors + R"(, "replications": 5)");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->variants.size(), 3u * 2 * 4);
  EXPECT_EQ(names_of(*plan).size(), 24u);
  EXPECT_EQ(plan->points(), 120u);
  EXPECT_EQ(name_of(*plan, plan->variants[1]), "size = 100B, rate = 100Mbps, prio = 1")
      << "the last factor changes fastest";
  EXPECT_EQ(plan->seed_of(7), 3u) << "point 7: variant 1, third replication";
}

// The baseline and each other level alone: 1 + 2 + 1 + 3.
TEST(Design, OneAtATimeChangesOneFactor) {
  const Folder folder;
  const auto plan = plan_of(folder, three_factors + R"(, "design": "one-at-a-time")");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->variants.size(), 7u);
  for (const Variant& variant : plan->variants) {
    std::size_t changed = 0;
    for (std::size_t f = 0; f < variant.size(); ++f) changed += variant[f] != plan->variants[0][f] ? 1 : 0;
    EXPECT_LE(changed, 1u);
  }
}

// For any number of points each of n equal parts of a factor's range has one point.
TEST(Design, LatinHypercubeCoversEachFactorEvenly) {
  const Folder folder;
  for (const unsigned n : {1u, 2u, 7u, 24u, 100u})
    for (const unsigned seed : {1u, 2u, 3u}) {
      const auto plan = plan_of(
          folder,
          R"("factors": [{"name": "every", "set": ["/streams/0/exponential"], "range": {"from": "10us", "to": "110us"}},
          {"name": "length", "set": ["/network/links/0/length"], "range": {"from": "1m", "to": "1000m", "scale": "log"}}],
          "design": {"kind": "latin-hypercube", "points": )" +
              std::to_string(n) + R"(, "seed": )" + std::to_string(seed) + "}");
      ASSERT_TRUE(plan);
      ASSERT_EQ(plan->variants.size(), n);
      for (std::size_t f = 0; f < 2; ++f) {
        std::set<int> strata;
        for (const Variant& variant : plan->variants) {
          const double number = *plan->level_of(variant, f).number;
          const double share = f == 0 ? (number - 10e-6) / 100e-6 : std::log(number) / std::log(1000);
          strata.insert(static_cast<int>(share * n));
        }
        // Four significant digits may round one across the edge of its part.
        EXPECT_GE(strata.size() + 1, n);
      }
    }
}

TEST(Design, RandomPointsDifferAndDependOnTheSeedAlone) {
  const Folder folder;
  const std::string random = three_factors + R"(, "design": {"kind": "random", "points": 20, "seed": 7})";
  const auto plan = plan_of(folder, random);
  ASSERT_TRUE(plan);
  EXPECT_EQ(names_of(*plan).size(), 20u);
  EXPECT_EQ(plan_of(folder, random)->variants, plan->variants);
  EXPECT_NE(plan_of(folder, three_factors + R"(, "design": {"kind": "random", "points": 20, "seed": 8})")->variants,
            plan->variants);
}

TEST(Design, ConstraintsHoldInEveryVariant) {
  const Folder folder;
  const auto plan =
      plan_of(folder, three_factors + R"(, "constraints": ["prio <= 1 || rate == 1Gbps", "size * prio < 500B"])");
  ASSERT_TRUE(plan);
  // rate 100Mbps: prio 0, 1 with 3 sizes; 1Gbps: prio 0, 1 (3 sizes each), prio 2: 100, 200; prio 3: 100.
  EXPECT_EQ(plan->variants.size(), 6u + 6 + 2 + 1);
}

TEST(Design, RangesAndTexts) {
  const Folder folder;
  const auto plan = plan_of(folder, R"("factors": [
      {"name": "every", "set": ["/streams/0/exponential"], "range": {"from": "10us", "to": "1ms", "steps": 5, "scale": "log"}},
      {"name": "n", "set": [{"at": "/x", "each": "h{}", "first": 2}, {"at": "/y", "as": "s{}-{}"}], "values": [0, 3]}])");
  ASSERT_TRUE(plan);
  std::vector<std::string> texts;
  for (const Level& level : plan->factors[0].levels) texts.push_back(level.text);
  EXPECT_EQ(texts, (std::vector<std::string>{"10us", "31.62us", "100us", "316.2us", "1ms"}));
  const Level& three = plan->factors[1].levels[1];
  EXPECT_EQ(json::compact(three.replacements[0].value), R"(["h2", "h3", "h4"])");
  EXPECT_EQ(three.replacements[1].value.text, "s3-3");
  EXPECT_EQ(json::compact(plan->factors[1].levels[0].replacements[0].value), "[]");
}

// A ring of four switches has four links between switches: none, 4 single, 6 double failures; a line of four has three:
// none, 3, 3.
TEST(Design, LinkFailuresFollowTheTopology) {
  const Folder folder;
  const std::string study = R"({"name": "f", "scenario": {"name": "n", "duration": "1ms",
      "network": {"generate": [{"topology": "ring", "switches": 4}]}, "streams": [{"name": "x", "from": "h1", "to": "h3", "payload": "100B", "every": "100us"}]},
    "factors": [{"name": "topology", "set": ["/network/generate/0/topology"], "values": ["ring", "line"]},
                {"name": "failure", "link_failures": {"at": "0.5ms", "at_once": 2}}],
    "measures": [{"name": "d", "of": "latency.max"}]})";
  json::Diagnostics diagnostics;
  const auto plan = load_plan(folder.write("study.json", study), diagnostics);
  ASSERT_TRUE(plan) << diagnostics.to_text();
  EXPECT_EQ(plan->variants.size(), (1u + 4 + 6) + (1 + 3 + 3));
  EXPECT_TRUE(names_of(*plan).contains("topology = ring, failure = sw1-sw4"));
  EXPECT_FALSE(names_of(*plan).contains("topology = line, failure = sw1-sw4"));
  const auto scenario = scenario_of(*plan, plan->variants[5], 1, diagnostics);
  ASSERT_TRUE(scenario) << diagnostics.to_text();
  EXPECT_EQ(scenario->faults.size(), 2u) << name_of(*plan, plan->variants[5]);
}

}  // namespace
}  // namespace takt::study
