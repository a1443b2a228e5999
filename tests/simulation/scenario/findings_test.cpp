// SPDX-License-Identifier: Apache-2.0
// Scenarios of tests/findings: what takt once got wrong, each with requirements that say what is right.
#include <algorithm>

#include "evaluation/evaluate.hpp"
#include "support.hpp"

namespace takt::scenario::test::findings_test {
namespace {

using sim::TrueTime;

std::string finding(const std::string& name) {
  return std::string(TAKT_SOURCE_DIR) + "/tests/findings/" + name + ".json";
}

void expect_pass(const std::string& name, const std::vector<std::string>& overrides = {}) {
  SCOPED_TRACE(name);
  json::Diagnostics diagnostics;
  const auto resolved = load_file(finding(name), overrides, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  LiveRun run(*resolved);
  ASSERT_TRUE(run.advance());
  const results::RunResult result = evaluation::evaluate(run, false);
  EXPECT_EQ(result.verdict, results::Verdict::pass);
  for (const results::RequirementResult& requirement : result.requirements)
    EXPECT_EQ(requirement.verdict, results::Verdict::pass) << requirement.text << ": " << requirement.remark;
}

// A relay that cannot be grandmaster announces that it has none, so the next best takes over at once and not after a
// time-out of its own.
TEST(Findings, ARelayThatCannotBeGrandmasterAnnounces) { expect_pass("announce-255"); }

TEST(Findings, TimeComesFromThePrimaryFromTheStart) { expect_pass("hot-standby-follows-secondary"); }
// Found by tests/generator: what a third domain heard was written beyond the two sides of the standby.
TEST(Findings, AThirdDomainHasNoPartInTheStandby) {
  expect_pass("hot-standby-follows-secondary",
              {R"(clocks.gptp.domains.1={"domain": 2, "nodes": {"h2": {"priority1": 90}}})",
               R"(clocks.gptp.domains.2={"domain": 3})"});
}
TEST(Findings, TimeComesFromThePrimaryAgain) { expect_pass("hot-standby-never-returns"); }

TEST(StandbyThresholds, AreThoseOfEveryNode) {
  json::Diagnostics diagnostics;
  const auto resolved = load_file(
      finding("hot-standby-never-returns"),
      {R"(clocks.gptp.standby_thresholds={"offset_max": "300ns", "offset_met": 5, "offset_exceeded": 3, "rx_sync_count": 7, "primary_secondary_offset": "2us", "waiting_time": "4s"})"},
      diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  ASSERT_EQ(resolved->plan.gptp_stations.size(), 4U);
  for (const models::gptp::StationPlan& station : resolved->plan.gptp_stations) {
    ASSERT_TRUE(station.standby);
    EXPECT_EQ(station.standby->is_synced.offset_max, sim::Duration::from_ps(300'000));
    EXPECT_EQ(station.standby->is_synced.met_count, 5);
    EXPECT_EQ(station.standby->is_synced.exceeded_count, 3);
    EXPECT_EQ(station.standby->is_synced.rx_sync_count, 7);
    EXPECT_EQ(station.standby->primary_secondary_offset_thresh, sim::Duration::from_ps(2'000'000));
    EXPECT_EQ(station.standby->waiting_time, sim::Duration::from_ps(4'000'000'000'000));
  }
}

TEST(StandbyThresholds, NeedAStandby) {
  json::Diagnostics diagnostics;
  EXPECT_FALSE(load_file(finding("hot-standby-never-returns"),
                         {"clocks.gptp.hot_standby=false", R"(clocks.gptp.standby_thresholds={"offset_max": "300ns"})"},
                         diagnostics));
  EXPECT_NE(diagnostics.to_text().find(
                R"(thresholds without a standby: found no "hot_standby", expected "hot_standby": true)"),
            std::string::npos)
      << diagnostics.to_text();
}

results::RunResult run_of(const std::string& name) {
  json::Diagnostics diagnostics;
  const auto resolved = load_file(finding(name), {}, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  LiveRun run(*resolved);
  run.advance();
  return evaluation::evaluate(run, false);
}

/// The line of that kind and cause; there is one.
const results::ReactionResult& reaction_of(const results::ProgramResult& program, const std::string& kind,
                                           const std::string& cause) {
  const auto is = [&](const results::ReactionResult& each) { return each.kind == kind && each.cause == cause; };
  EXPECT_EQ(std::count_if(program.reactions.begin(), program.reactions.end(), is), 1) << kind << " " << cause;
  return *std::find_if(program.reactions.begin(), program.reactions.end(), is);
}

// h3 crashes at 500 ms: 10.017 ms pass until both others are Halted, which are not "within 1 ms".
TEST(Findings, AHaltAfterACrashCountsFromTheCrash) {
  const results::RunResult result = run_of("crash-reaction");
  const results::ReactionResult& halt = reaction_of(result.programs[0], "halt", "crash");
  EXPECT_EQ(halt.initiator, "h3");
  EXPECT_EQ(halt.began, TrueTime() + 500_ms);
  ASSERT_TRUE(halt.completed);
  EXPECT_EQ(*halt.duration(), 10'017'132'664_ps);
  EXPECT_EQ(result.requirements[0].verdict, results::Verdict::fail);
  EXPECT_EQ(result.programs[0].states, (std::vector<std::string>{"Halted", "Halted", "dead"}));
  const auto& timeline = result.programs[0].timeline;
  const auto fault = std::find_if(timeline.begin(), timeline.end(),
                                  [](const results::TimelineEntry& entry) { return !entry.fault.empty(); });
  ASSERT_NE(fault, timeline.end());
  EXPECT_EQ(fault->fault, "h3 crashes");
  EXPECT_EQ(fault->at, TrueTime() + 500_ms);
  EXPECT_EQ((fault + 1)->state, "dead");
}

// a crashes at 1 s, its role goes to another node, and the group starts again by itself: all run again after 15 ms,
// not 5.
TEST(Findings, AStartAfterAReplacementCountsFromTheCrash) {
  const results::RunResult result = run_of("roles-crash-reaction");
  const results::ReactionResult& halt = reaction_of(result.programs[0], "halt", "crash");
  EXPECT_EQ(halt.began, TrueTime() + 1_s);
  EXPECT_EQ(halt.duration(), 9'001'252_ns);
  const results::ReactionResult& start = reaction_of(result.programs[0], "start", "crash");
  EXPECT_EQ(start.began, TrueTime() + 1_s);
  EXPECT_EQ(start.duration(), 15'001'924_ns);
  EXPECT_EQ(result.requirements[0].verdict, results::Verdict::fail);
}

/// Three hosts on two switches, in a group that starts at 10 ms; `faults` are entries of "faults", `require` of
/// "require".
results::RunResult cell_with(const std::string& faults, const std::string& require) {
  const auto resolved = sound(
      R"({"name": "c", "duration": "200ms", "network": {"nodes": {"h1": {"kind": "host"}, "h2": {"kind": "host"}, "h3": {"kind": "host"},
    "a": {"kind": "switch"}, "b": {"kind": "switch"}}, "links": [{"ends": ["h1", "a"]}, {"ends": ["h2", "a"]}, {"ends": ["a", "b"]}, {"ends": ["b", "h3"]}]},
  "programs": [{"name": "p", "master": "h1", "slaves": ["h2", "h3"], "cycle": "1ms", "receive_timeout": "5ms"}],
  "script": [{"at": "10ms", "program": "p", "call": "Start"}], "faults": [)" +
      faults + R"(], "require": [)" + require + "]}");
  LiveRun run(*resolved);
  run.advance();
  return evaluation::evaluate(run, false);
}

// The master finds h3 silent 5 ms after its last word, which came within the cycle before the cut; h3 finds the master
// silent likewise.
TEST(Reactions, ToACutCountFromTheCut) {
  for (const std::string fault : {R"({"kind": "link-down", "link": ["a", "b"], "at": "100ms"})",
                                  R"({"kind": "crash", "node": "b", "at": "100ms"})"}) {
    const results::RunResult result = cell_with(
        fault,
        R"({"reaction": "halt", "cause": "cut", "within": "7ms"}, {"reaction": "halt", "within": "4ms"}, {"reaction": "halt", "cause": "silence", "within": "1s"})");
    const results::ReactionResult& halt = reaction_of(result.programs[0], "halt", "cut");
    EXPECT_EQ(halt.began, TrueTime() + 100_ms);
    ASSERT_TRUE(halt.completed);
    EXPECT_GT(*halt.duration(), 4_ms);
    EXPECT_LT(*halt.duration(), 7_ms);
    EXPECT_EQ(result.requirements[0].verdict, results::Verdict::pass);
    EXPECT_EQ(result.requirements[1].verdict, results::Verdict::fail);
    EXPECT_EQ(result.requirements[2].remark, "no such reaction");
    EXPECT_EQ(result.programs[0].states, std::vector<std::string>(3, "Halted"));
  }
}

// All frames of the link are lost, which is chance to takt: the silence counts from the last word that came.
TEST(Reactions, ToSilenceCountFromTheLastWord) {
  const results::RunResult result =
      cell_with(R"({"kind": "frame-errors", "link": ["a", "b"], "loss": 1, "at": "100ms"})",
                R"({"reaction": "halt", "within": "7ms"})");
  const results::ReactionResult& halt = reaction_of(result.programs[0], "halt", "silence");
  EXPECT_GT(halt.began, TrueTime() + 98_ms);
  EXPECT_LE(halt.began, TrueTime() + 100_ms + 100_us);
  EXPECT_GE(*halt.duration(), 5_ms);
  const auto& timeline = result.programs[0].timeline;
  EXPECT_TRUE(std::any_of(timeline.begin(), timeline.end(), [](const results::TimelineEntry& entry) {
    return entry.fault == "frame errors on link a - b begin";
  }));
}

// A short cut that silences nobody is a line of the table, and no reaction.
TEST(Reactions, AShortCutIsNoReaction) {
  const results::RunResult result =
      cell_with(R"({"kind": "link-down", "link": ["a", "b"], "at": "100ms", "for": "2ms"})", "");
  EXPECT_EQ(result.programs[0].reactions.size(), 1u);
  EXPECT_EQ(std::ranges::count_if(result.programs[0].timeline,
                                  [](const results::TimelineEntry& entry) { return !entry.fault.empty(); }),
            2);
}

TEST(Reactions, OnlyHaltsHaveFaultsAsCauses) {
  const Loaded loaded = load(over_one_switch(
      R"(, "programs": [{"name": "p", "master": "a", "slaves": ["b"], "cycle": "1ms"}], "require": [{"reaction": "suspend", "cause": "crash", "within": "1ms"}])"));
  EXPECT_FALSE(loaded.resolved);
  EXPECT_NE(loaded.diagnostics.to_text().find("a reaction that has no such cause"), std::string::npos);
}

}  // namespace
}  // namespace takt::scenario::test::findings_test
