// Mistakes of study files: each is told with its place, all at once.
#include "study/plan.hpp"

#include <gtest/gtest.h>

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

const std::string factor = R"("factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "200B"]}])";

TEST(Plan, MistakesAreTold) {
  const std::pair<const char*, const char*> cases[] = {
      {R"("factors": [])", "at /factors"},
      {R"("factors": [{"name": "a", "values": [1]}])", "levels that set nothing"},
      {R"("factors": [{"name": "a", "set": ["/seed"], "values": [1]}])", "the seed cannot be a factor"},
      {R"("factors": [{"name": "a b", "set": ["/x"], "values": [1]}])", "not a name for a factor"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1, 1]}])", "a level occurs twice"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1], "range": {"from": 1, "to": 2}}])", "range"},
      {R"("factors": [{"name": "a", "set": ["/x"], "range": {"from": "1us", "to": "2us"}}])", "\"step\" or \"steps\""},
      {R"("factors": [{"name": "a", "set": ["/x"], "range": {"from": "1us", "to": "2Mbps", "steps": 3}}])", "of the same kind"},
      {R"("factors": [{"name": "a", "set": ["/x"], "range": {"from": 5, "to": 2}}])", "more than \"from\""},
      {R"("factors": [{"name": "a", "set": [{"at": "/x", "each": "h"}], "values": [1]}])", "a text with {}"},
      {R"("factors": [{"name": "a", "set": [{"at": "/x", "each": "h{}"}], "values": ["x"]}])", "not a count"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1], "baseline": 2}])", "not a level of this factor"},
      {R"("factors": [{"name": "delay", "set": ["/x"], "values": [1]}])", "names of factors and measures that differ"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "constraints": ["b < 1"])", "unknown factor"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "constraints": ["a <"])", "not a condition"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "constraints": ["a > 1"])", "no combination of levels is left"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "design": "random")", "\"points\""},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "limits": [{"measure": "dely", "at_most": "1ms"}])", "did you mean \"delay\"?"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "limits": [{"measure": "delay", "at_most": "1B"}])", "not a limit of this measure"},
      {R"("factors": [{"name": "a", "set": ["/x"], "values": [1]}], "sizes": 3)", "unknown field \"sizes\""},
      {R"("factors": [{"name": "a", "set": ["/x"], "range": {"from": 1, "to": 100000}}, {"name": "b", "set": ["/y"], "range": {"from": 1, "to": 100000}}])", "too many combinations"},
  };
  for (const auto& [members, expected] : cases) EXPECT_NE(problems(members).find(expected), std::string::npos) << members << "\n" << problems(members);
}

TEST(Plan, EachMistakeHasItsPlace) {
  const std::string text = problems(R"("factors": [{"name": "a", "set": ["/x"], "values": [1, 1]}], "limits": [{"measure": "none", "at_most": 1}])");
  EXPECT_NE(text.find("study.json:5:"), std::string::npos) << text;
  EXPECT_NE(text.find("at /factors/0"), std::string::npos) << text;
  EXPECT_NE(text.find("at /limits/0/measure"), std::string::npos) << text;
}

TEST(Plan, VariantsThatAreNoScenarioTellWhy) {
  const Folder folder;
  const auto plan = plan_of(folder, R"("factors": [{"name": "size", "set": ["/streams/0/payload"], "values": ["100B", "9000B"]}, {"name": "typo", "set": ["/streams/0/palyoad"], "values": ["1B"]}])");
  ASSERT_TRUE(plan);
  EXPECT_NE(mistakes_of(*plan, 0).find("did you mean \"payload\"?"), std::string::npos);
  EXPECT_NE(mistakes_of(*plan, 1).find("factor size = 9000B"), std::string::npos) << "the level that does it is named";
}

// What a point may take and what the file says about itself are no part of what the points are.
TEST(Plan, ConfigurationDigest) {
  const Folder folder;
  const std::uint64_t digest = plan_of(folder, factor)->digest;
  EXPECT_EQ(plan_of(folder, factor + R"(, "description": "x", "effort": {"cpu": "1s"})")->digest, digest);
  EXPECT_NE(plan_of(folder, factor + R"(, "replications": 2)")->digest, digest);
  EXPECT_NE(plan_of(folder, factor + R"(, "limits": [{"measure": "delay", "at_most": "1ms"}])")->digest, digest);
}

TEST(Plan, APointIsTheRunOfItsScenario) {
  const Folder folder;
  const auto plan = plan_of(folder, factor + R"(, "replications": 2, "limits": [{"measure": "delay", "at_most": "4us"}])");
  const Outcome first = run_point(*plan, 0);
  EXPECT_EQ(first.status, Status::done);
  EXPECT_EQ(first.verdict, "pass");
  EXPECT_EQ(run_point(*plan, 0).digest, first.digest);
  EXPECT_NE(run_point(*plan, 1).digest, first.digest) << "another seed";
  // Two links of 1 Gb/s: 100 B of data are 100 + 28 + 14 + 4 + 8 = 154 octets, 1.232 us each; and 1 us in the switch, 2 x 50 ns on 10 m by default or 0.
  ASSERT_TRUE(first.values[0]);
  EXPECT_GE(*first.values[0], 3.464);
  const auto back = unpacked(packed(first));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->digest, first.digest);
  EXPECT_EQ(back->values, first.values);
  EXPECT_FALSE(unpacked(packed(first).substr(1)));
  EXPECT_FALSE(unpacked(packed(first) + "x"));
}

}  // namespace
}  // namespace takt::study
