// SPDX-License-Identifier: Apache-2.0
// On every shipped scenario nothing that happens exceeds its bound.
#include <gtest/gtest.h>

#include "analysis/bounds.hpp"
#include "analysis/report.hpp"
#include "tests/questions/analysis/falsification.hpp"
#include "tests/simulation/scenario/support.hpp"

namespace takt::analysis::sandwich_test {
namespace {

using scenario::test::shipped_names;

/// Cut short: clocks that are followed for a minute.
std::string duration_of(const std::string& name) { return name.starts_with("clocks/") ? "2s" : ""; }

std::span<const handshake::Reaction> seen_by(const scenario::Run& run, const ReactionBound& reaction) {
  if (!reaction.of_tree) return run.monitor(reaction.program).reactions();
  for (const auto& tree : run.trees())
    if (tree->programs().front() == reaction.program) return tree->reactions();
  return {};
}

TEST(Verification, NothingExceedsItsBound) {
  std::size_t reactions = 0;
  std::size_t trees = 0;
  std::size_t faults = 0;
  test::Verdict all;
  for (const std::string& name : shipped_names()) {
    if (name.starts_with("findings/")) continue;  // they show the paper's handshake failing
    const auto resolved = scenario::test::shipped(name, duration_of(name));
    if (!resolved->applications.empty()) continue;  // which takt bound refuses
    const Bounds bounds = bound(*resolved);
    scenario::Run run(*resolved);
    run.advance();
    const test::Verdict verdict = test::judge(run, bounds);
    for (const std::string& violation : verdict.violations) ADD_FAILURE() << name << ": " << violation;
    all.compared += verdict.compared;
    all.unbounded += verdict.unbounded;
    for (const ReactionBound& reaction : bounds.reactions) {
      const bool has_roles = std::ranges::any_of(resolved->programs, [&](const scenario::ResolvedProgram& program) {
        const auto number = static_cast<std::size_t>(&program - resolved->programs.data());
        const bool is_within = program.outer && program.outer->program == reaction.program &&
                               (reaction.of_tree || reaction.kind == scenario::Reaction::start);
        return program.has_roles() && (number == reaction.program || is_within);
      });
      if (has_roles) {
        EXPECT_FALSE(reaction.bound) << name;
        EXPECT_NE(reaction.reason, "") << name;
        continue;
      }
      for (const handshake::Reaction& seen : seen_by(run, reaction)) {
        // What spreads as a call does is bounded as a call.
        const bool is_call = seen.cause == handshake::Cause::nested || seen.cause == handshake::Cause::mismatch;
        if ((is_call ? handshake::Cause::command : seen.cause) != reaction.cause) continue;
        faults += reaction.cause != handshake::Cause::command;
        if (handshake::name_of(seen.kind) != std::string_view(scenario::spelling(reaction.kind)) ||
            seen.outcome != handshake::ReactionOutcome::completed)
          continue;
        if (!reaction.bound && !resolved->programs[reaction.program].replies.empty()) {
          EXPECT_NE(reaction.reason, "") << name;  // replies may come without a least gap
          continue;
        }
        ASSERT_TRUE(reaction.bound) << name << ": " << reaction.reason;
        EXPECT_LE(seen.completed - seen.began, *reaction.bound) << name << " " << handshake::name_of(seen.kind);
        ++(reaction.of_tree ? trees : reactions);
      }
    }
  }
  EXPECT_GT(all.compared, 80u);
  EXPECT_LT(all.unbounded,
            30u);  // random gaps, replies without a least gap, links and gates that get more than they let through
  EXPECT_GE(reactions, 20u);
  EXPECT_GE(trees, 5u);
  EXPECT_GE(faults, 3u);
}

// The figures of the first page of the documentation.
TEST(Verification, RobotArm) {
  const auto resolved = scenario::test::shipped("robot-arm");
  const Bounds bounds = bound(*resolved);
  EXPECT_EQ(bounds.streams[0].name, "camera");
  // camera: 1000 + 46 octets and a preamble of 8 at 1 Gb/s, 8.432 us, twice; at the second port behind three short
  // frames of the robot... in all 18.512 us; cables of 25 m and 10 m, forwarding 1 us, and 50 us in the generator's
  // operating system.
  ASSERT_TRUE(bounds.streams[0].latency);
  EXPECT_EQ(bounds.streams[0].hops.size(), 2u);
  EXPECT_EQ(*bounds.streams[0].hops[0].delay, sim::Duration::from_ps(8'464'000));
  ASSERT_EQ(bounds.requirements.size(), 7u);
  for (const RequirementBound& requirement : bounds.requirements)
    EXPECT_TRUE(requirement.duration || requirement.count) << requirement.reason;
  EXPECT_NE(text_report(*resolved, bounds).find("reaction start within 12ms"), std::string::npos);
  EXPECT_NE(json_report(*resolved, bounds).find("\"bound_ps\""), std::string::npos);
}

}  // namespace
}  // namespace takt::analysis::sandwich_test
