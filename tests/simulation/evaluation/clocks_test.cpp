// SPDX-License-Identifier: Apache-2.0
// What a run says of clocks: who follows whom, over which links, and how far clocks are apart.
#include <algorithm>

#include "evaluation/evaluate.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::scenario::test::clocks_test {
namespace {

using results::RequirementResult;
using results::RunResult;
using results::Verdict;
using sim::Duration;
using sim::TrueTime;
using namespace sim::literals;

RunResult judged(const Resolved& resolved) {
  LiveRun live(resolved);
  live.advance();
  return evaluation::evaluate(live, false);
}
RunResult judged(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return judged(*sound(text, overrides));
}

RunResult finding(const std::string& name, const std::vector<std::string>& overrides = {}) {
  json::Diagnostics diagnostics;
  const auto resolved =
      load_file(std::string(TAKT_SOURCE_DIR) + "/tests/findings/" + name + ".json", overrides, diagnostics);
  if (!resolved) throw std::runtime_error("refused:\n" + diagnostics.to_text());
  return judged(*resolved);
}

const results::GptpLinkResult& link(const RunResult& result, std::string_view node, std::string_view peer) {
  return *std::ranges::find_if(result.gptp_links,
                               [&](const auto& each) { return each.node == node && each.peer == peer; });
}
const results::ClockDifferenceResult& difference(const RunResult& result, std::string_view name) {
  return *std::ranges::find(result.clock_differences, name, &results::ClockDifferenceResult::name);
}
const results::ClockResult& clock(const RunResult& result, std::string_view node) {
  return *std::ranges::find(result.clocks, node, &results::ClockResult::node);
}
bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

// Both halves follow a grandmaster of their own. Each clock is within nanoseconds of it, and the halves are
// milliseconds apart.
TEST(Clocks, OfTwoGrandmastersAreNotInSync) {
  const RunResult result = finding("long-cable", {"clocks.gptp.link_delay_threshold=800ns"});
  EXPECT_EQ(result.verdict, Verdict::fail);
  const RequirementResult& sync = result.requirements.at(0);
  EXPECT_EQ(sync.verdict, Verdict::fail);
  EXPECT_GT(*sync.measured, 100_us);
  EXPECT_TRUE(has(sync.remark, "b follows itself and not a, from 10ms on")) << sync.remark;
  const results::GptpLinkResult& between = link(result, "s1", "s2");
  EXPECT_FALSE(between.is_capable);
  EXPECT_TRUE(between.why_not.starts_with("its delay of 10.0") &&
              between.why_not.ends_with("us is beyond the threshold of 800ns"))
      << between.why_not;
  EXPECT_NEAR(static_cast<double>(between.link_delay->ps()), 10e6, 20e3);
  EXPECT_TRUE(link(result, "a", "s1").is_capable);
  EXPECT_EQ(link(result, "a", "s1").why_not, "");
  EXPECT_GT(*difference(result, "ways").greatest, 100_us);
}

// 2 km are no copper: fibre has no threshold.
TEST(Clocks, FollowOneGrandmasterOverFibre) {
  const RunResult result = finding("long-cable");
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::pass) << result.requirements.at(0).remark;
  EXPECT_TRUE(link(result, "s2", "s1").is_capable);
  EXPECT_FALSE(link(result, "s2", "s1").threshold);
  EXPECT_EQ(link(result, "s2", "b").threshold, 800_ns);
  // Each half has a grandmaster of its own until the long link is measured.
  ASSERT_FALSE(result.grandmasters.empty());
  EXPECT_EQ(result.grandmasters.back().node + " " + result.grandmasters.back().event, "a leads");
  EXPECT_LT(result.grandmasters.back().at, TrueTime() + 3_s);
}

// (1044 + 2133) ns at each of two nodes, half of which shows as link delay, and 50 ns of cable.
TEST(Clocks, BehindLatenciesThatNothingMakesUpForFollowThemselves) {
  const RunResult result = finding("phy-latency");
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::fail);
  EXPECT_TRUE(has(link(result, "a", "s").why_not, "beyond the threshold of 800ns")) << link(result, "a", "s").why_not;
  EXPECT_NEAR(static_cast<double>(link(result, "a", "s").link_delay->ps()), 3.227e6, 20e3);
}

// However near clocks are that nothing holds together: they are not synchronised.
TEST(Clocks, OfSeveralGrandmastersThatAgreeByChanceAreUndecided) {
  const std::vector<std::string> exact = {"clocks.all.offset=0ppm",
                                          "require.1={\"sync\": \"1us\", \"node\": \"b\", \"after\": \"10s\"}"};
  const RunResult result = finding("phy-latency", exact);
  EXPECT_EQ(result.verdict, Verdict::undecided);
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::undecided);
  EXPECT_TRUE(has(result.requirements.at(0).remark, "b follows itself and not a, from "))
      << result.requirements.at(0).remark;
  EXPECT_EQ(result.requirements.at(1).verdict, Verdict::undecided);
}

TEST(Clocks, ThatNobodyCanLeadAreUndecided) {
  const RunResult result = judged(
      R"({"name": "t", "duration": "4s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"]}]},
    "clocks": {"gptp": {"nodes": {"a": {"priority1": 255}, "b": {"priority1": 255}}}}, "require": [{"sync": "1us"}]})");
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::undecided);
  EXPECT_TRUE(has(result.requirements.at(0).remark, "no node can be grandmaster")) << result.requirements.at(0).remark;
}

// gm crashes at 20 s; its Sync is missed 250 us later, and the first to be locked to h1 is so after two of its Syncs.
TEST(Clocks, TellWhoLeadsAndWhoIsLost) {
  const RunResult result =
      finding("grandmaster-lost", {"duration=25s", "programs=[]", "script=[]", "require=[{\"sync\": \"1us\"}]"});
  EXPECT_EQ(result.requirements.at(0).verdict, Verdict::pass)
      << result.requirements.at(0).remark;  // an election takes a moment
  ASSERT_EQ(result.grandmasters.size(), 3u);
  EXPECT_EQ(result.grandmasters[0].node + " " + result.grandmasters[0].event, "gm leads");
  EXPECT_EQ(result.grandmasters[1].node + " " + result.grandmasters[1].event, "gm lost");
  EXPECT_EQ(result.grandmasters[1].at, TrueTime() + 20_s);
  EXPECT_EQ(result.grandmasters[2].node + " " + result.grandmasters[2].event, "h1 leads");
  EXPECT_NEAR(static_cast<double>(result.grandmasters[2].at.ps()), 20.25e12, 0.01e12);
  EXPECT_TRUE(clock(result, "gm").was_never_to_lock());
  EXPECT_FALSE(clock(result, "gm").time_to_lock);
  EXPECT_FALSE(clock(result, "sw1").was_never_to_lock());
  const results::ClockResult& h1 = clock(result, "h1");
  EXPECT_TRUE(h1.has_led);
  ASSERT_TRUE(h1.greatest_at);
  EXPECT_GE(*h1.greatest_at, TrueTime() + *h1.time_to_lock);
}

std::string two_oscillators(const std::string& require) {
  return R"({"name": "clocks", "duration": "3s", "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "c": {"kind": "host"}, "s": {"kind": "switch"}},
    "links": [{"ends": ["a", "s"]}, {"ends": ["b", "s"]}, {"ends": ["c", "s"]}]},
    "clocks": {"nodes": {"a": {"offset": "10ppm"}, "b": {"offset": "-10ppm"}}}, "require": [)" +
         require + "]}";
}

// 20 ppm in 3 s are 60 us, less what a last look may miss: 10 ms of it, 0.2 us. c and s know true time.
TEST(Clocks, DifferWithoutAnythingThatHoldsThemTogether) {
  const RunResult result = judged(two_oscillators(
      R"({"clocks": ["a", "b"], "within": "60001ns"}, {"clocks": ["a", "b"], "within": "59us"}, {"clocks": ["a", "c"], "within": "30us"}, {"clocks": ["c", "s"], "within": "0s"},
    {"clocks": "*", "within": "59us"}, {"clocks": ["a", "b", "c"], "within": "60001ns"}, {"figure": "clocks", "at_most": "60001ns"})"));
  const Verdict expected[] = {Verdict::pass, Verdict::fail, Verdict::pass, Verdict::pass,
                              Verdict::fail, Verdict::pass, Verdict::pass};
  for (std::size_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(result.requirements.at(i).verdict, expected[i])
        << result.requirements.at(i).text << ": " << result.requirements.at(i).remark;
  EXPECT_EQ(result.requirements.at(0).text, "clocks of a, b within 60.001us of each other");
  EXPECT_EQ(result.requirements.at(4).text, "all clocks within 59us of each other");
  EXPECT_GE(*result.requirements.at(0).measured, 59'800_ns);
  const results::ClockDifferenceResult& all = difference(result, "all");
  EXPECT_EQ(all.ahead, "a");
  EXPECT_EQ(all.behind, "b");
  EXPECT_GE(*all.at, TrueTime() + 2'990_ms);
  EXPECT_EQ(difference(result, "a, c").ahead, "a");
}

TEST(Clocks, RequirementsNameNodes) {
  const auto told = [](const std::string& require) { return load(two_oscillators(require)).diagnostics.to_text(); };
  EXPECT_TRUE(has(told(R"({"clocks": ["a", "x"], "within": "1us"})"), "/require/0/clocks/1"))
      << told(R"({"clocks": ["a", "x"], "within": "1us"})");
  EXPECT_TRUE(has(told(R"({"clocks": ["a", "a"], "within": "1us"})"), "a node twice"));
  EXPECT_TRUE(has(told(R"({"clocks": "a", "within": "1us"})"), "a difference of one clock"));
  EXPECT_TRUE(has(told(R"({"clocks": ["a", "b"]})"), "missing key"));
  EXPECT_TRUE(has(told(R"({"clocks": ["a", "b"], "within": 5})"), "a time without a unit"));
}

}  // namespace
}  // namespace takt::scenario::test::clocks_test
