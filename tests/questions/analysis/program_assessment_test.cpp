// SPDX-License-Identifier: Apache-2.0
// What reactions of Programs rest on, and how many calls and faults come before a group has come to rest.
#include "analysis/program_assessment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "scenario/resolve.hpp"

namespace takt::analysis::program_assessment_test {
namespace {

using sim::Duration;
using namespace sim::literals;  // NOLINT
using A = Assumption;
using handshake::Cause;
using scenario::Reaction;

std::unique_ptr<scenario::Resolved> load(const std::string& text) {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(text, "cell.json", {}, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return resolved;
}

/// m is master of s over the switch sw; far is no participant. `program` goes into the Program, `more` into the
/// scenario, `host` into s.
std::unique_ptr<scenario::Resolved> cell(const std::string& program, const std::string& more = {},
                                         const std::string& host = {}) {
  return load(
      R"({"name": "cell", "duration": "1s", "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host")" + host +
      R"(}, "far": {"kind": "host"}, "sw": {"kind": "switch"}},
    "links": [{"ends": ["m", "sw"], "rate": "100Mbps"}, {"ends": ["s", "sw"], "rate": "100Mbps"}, {"ends": ["far", "sw"], "rate": "100Mbps"}]},
    "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "1ms")" +
      program + "}]" + more + "}");
}

std::vector<A> rests_on(const scenario::Resolved& resolved, Reaction kind, Cause cause = Cause::command) {
  for (const ReactionBound& each : bound(resolved).reactions)
    if (each.kind == kind && each.cause == cause) return each.assumptions.list();
  throw std::runtime_error("no such reaction");
}

std::string script(const std::vector<std::pair<Duration, std::string>>& calls) {
  std::string text;
  for (const auto& [at, what] : calls)
    text += (text.empty() ? "" : ", ") + std::string(R"({"at": ")") + std::to_string(at.ps()) +
            R"(ps", "program": "p", "call": ")" + what + "\"}";
  return R"(, "script": [)" + text + "]";
}

const std::string on_change = R"(, "publish": "on-change")";
const std::string paper = R"(, "variant": "paper")";
const std::string crash = R"(, "faults": [{"kind": "crash", "node": "s", "at": "500ms"}])";
const std::string chance =
    R"(, "faults": [{"kind": "frame-errors", "link": ["s", "sw"], "loss": 0.001, "at": "500ms"}])";

TEST(ProgramAssessment, WhatReactionsRestOn) {
  const auto simple = cell("");
  EXPECT_EQ(rests_on(*simple, Reaction::halt), (std::vector{A::nothing_else}));
  EXPECT_EQ(rests_on(*simple, Reaction::start), (std::vector{A::nothing_else, A::initialisation}));
  EXPECT_EQ(rests_on(*cell(on_change), Reaction::halt), (std::vector{A::nothing_else, A::program_publishes}));
  EXPECT_EQ(rests_on(*cell(paper), Reaction::halt), (std::vector{A::nothing_else, A::sampled_states}));
  EXPECT_EQ(
      rests_on(*cell("", "", R"(, "os": {"transmit": {"uniform": {"from": "1us", "to": "9us"}}})"), Reaction::halt),
      (std::vector{A::nothing_else, A::os_latency}));
  // A crash keeps words from those who notice it by their time-outs; a call rests on its words.
  const auto crashes = cell("", crash);
  EXPECT_EQ(rests_on(*crashes, Reaction::halt), (std::vector{A::nothing_else, A::listed_faults_only, A::no_loss}));
  EXPECT_EQ(rests_on(*crashes, Reaction::halt, Cause::crash), (std::vector{A::nothing_else, A::listed_faults_only}));
  EXPECT_EQ(rests_on(*crashes, Reaction::halt, Cause::silence),
            (std::vector{A::nothing_else, A::listed_faults_only, A::no_loss}));
  // Chance may take any word.
  const auto losses = cell("", chance);
  EXPECT_EQ(rests_on(*losses, Reaction::halt), (std::vector{A::nothing_else, A::listed_faults_only, A::no_loss}));
  EXPECT_EQ(rests_on(*losses, Reaction::halt, Cause::crash),
            (std::vector{A::nothing_else, A::listed_faults_only, A::no_loss}));
}

// Silence counts from the last word that came; a crash from an instant at which that was still under way, for as long
// as the slowest word may be.
TEST(ProgramAssessment, HaltsCountFromTheirCauses) {
  const auto halt = [](const Bounds& bounds, Cause cause) {
    return *std::find_if(bounds.reactions.begin(), bounds.reactions.end(),
                         [&](const ReactionBound& each) { return each.kind == Reaction::halt && each.cause == cause; });
  };
  const Bounds bounds = bound(*cell(""));
  Duration slowest_word;
  for (const StreamBound& each : bounds.streams) slowest_word = std::max(slowest_word, each.latency.value());
  EXPECT_GT(slowest_word, 10_us);
  EXPECT_EQ(*halt(bounds, Cause::crash).bound - *halt(bounds, Cause::silence).bound, slowest_word);
  EXPECT_EQ(halt(bounds, Cause::cut).bound, halt(bounds, Cause::crash).bound);
  // The next word of one that is back comes within a cycle; from there a halt spreads as one that is called.
  EXPECT_EQ(*halt(bounds, Cause::restart).bound - *halt(bounds, Cause::command).bound, 1_ms + slowest_word);
  const Bounds of_paper = bound(*cell(paper));
  EXPECT_TRUE(halt(of_paper, Cause::command).bound);
  for (const Cause cause : {Cause::crash, Cause::cut, Cause::silence, Cause::restart}) {
    EXPECT_FALSE(halt(of_paper, cause).bound);
    EXPECT_EQ(halt(of_paper, cause).reason, "the handshake paper notices neither silence nor a restart");
  }
}

TEST(ProgramAssessment, WhoLosesWordsHasNoProof) {
  EXPECT_EQ(bound(*cell("")).ledger[A::no_loss].standing, Standing::open);
  EXPECT_EQ(bound(*cell("")).ledger[A::no_loss].why, "");
  EXPECT_NE(bound(*cell("", chance)).ledger[A::no_loss].why.find("chance loses frames"), std::string::npos);
  EXPECT_EQ(bound(*cell(paper)).ledger[A::sampled_states].standing, Standing::open);
}

/// What becomes of "a participant publishes on change at most so often".
Standing changes_are(const std::string& program, const std::string& more) {
  return bound(*cell(program, more)).ledger[A::program_publishes].standing;
}

TEST(ProgramAssessment, CallsThatMeet) {
  const Bounds bounds = bound(*cell(on_change, script({{10_ms, "Start"}})));
  Duration longest;
  for (const ReactionBound& each : bounds.reactions) longest = std::max(longest, each.bound.value());
  const auto apart = [](Duration by) {
    return changes_are(on_change, script({{10_ms, "Start"}, {10_ms + by, "Halt"}}));
  };
  EXPECT_EQ(changes_are(on_change, script({{10_ms, "Start"}})), Standing::discharged);
  EXPECT_EQ(apart(1_ms), Standing::open);
  EXPECT_EQ(apart(longest), Standing::open);
  EXPECT_EQ(apart(longest + 1_ms), Standing::open) << "what it has last said is heard within a cycle";
  EXPECT_EQ(apart(longest + 1_ms + 1_ns), Standing::discharged);
}

TEST(ProgramAssessment, FaultsAndCallsThatMeet) {
  const auto start_at = [](Duration at) { return script({{at, "Start"}}); };
  // A crash keeps no word of others from anybody, but the loss of its own leaves it open when who is left publishes.
  EXPECT_EQ(changes_are(on_change, start_at(499_ms) + crash), Standing::open);
  const auto row = [](const std::string& more) {
    const auto resolved = cell("", more);
    const EventsInARow events = events_in_a_row(*resolved, bound(*resolved), 0);
    return std::pair(events.calls, events.faults);
  };
  using Pair = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(row(""), Pair(0, 0));
  EXPECT_EQ(row(start_at(10_ms)), Pair(1, 0));
  EXPECT_EQ(row(start_at(10_ms) + crash), Pair(1, 1));
  EXPECT_EQ(row(script({{10_ms, "Start"}, {11_ms, "Halt"}, {12_ms, "Reset"}, {300_ms, "Start"}, {301_ms, "Halt"}})),
            Pair(3, 0));
  EXPECT_EQ(row(script({{499_ms, "Start"}, {501_ms, "Halt"}}) + crash), Pair(2, 1));
  EXPECT_EQ(row(R"(, "faults": [{"kind": "crash", "node": "far", "at": "500ms"}])"), Pair(0, 0));
  // It is back after 1 ms: that is another one.
  EXPECT_EQ(row(R"(, "faults": [{"kind": "crash", "node": "s", "at": "500ms", "for": "1ms"}])"), Pair(0, 2));
}

// The paper's handshake does not notice a crash, so nothing is set in motion by it: its other reactions say when it
// rests.
TEST(ProgramAssessment, WhatIsNotNoticedNeedsNoRest) {
  EXPECT_EQ(changes_are(on_change + paper, script({{10_ms, "Start"}, {600_ms, "Halt"}})), Standing::discharged);
}

TEST(ProgramAssessment, WithoutABoundNothingIsKnownOfChanges) {
  EXPECT_EQ(changes_are(on_change, script({{10_ms, "Start"}}) + chance), Standing::open);
  // Frames at random instants in the Program's class: no word has a bound.
  const std::string random =
      R"(, "streams": [{"name": "noise", "from": "far", "to": "m", "payload": "1000B", "exponential": "1ms", "pcp": 7}])";
  const Bounds bounds = bound(*cell(on_change, script({{10_ms, "Start"}}) + random));
  EXPECT_EQ(bounds.ledger[A::program_publishes].standing, Standing::open);
  EXPECT_NE(bounds.ledger[A::program_publishes].why.find("have no bound"), std::string::npos)
      << bounds.ledger[A::program_publishes].why;
}

// Who gets or loses a role says so at once, in whatever state, but no more often than the script moves it.
TEST(ProgramAssessment, RolesAreSettledWhileTheProgramRuns) {
  const auto with_roles = [](const std::string& more) {
    return load(
        R"({"name": "roles", "duration": "1s", "network": {"nodes": {"m": {"kind": "host"}, "s": {"kind": "host", "offers": ["welding"]}}, "links": [{"ends": ["m", "s"], "rate": "100Mbps"}]},
      "programs": [{"name": "p", "master": "m", "roles": [{"name": "left", "skill": "welding"}], "cycle": "1ms"}])" +
        more + "}");
  };
  const Bounds idle = bound(*with_roles(""));
  EXPECT_TRUE(idle.streams.at(0).assumptions.contains(A::program_publishes));
  EXPECT_EQ(idle.ledger[A::program_publishes].standing, Standing::discharged);
  const Bounds called = bound(*with_roles(script({{10_ms, "Start"}})));
  EXPECT_EQ(called.ledger[A::program_publishes].standing, Standing::discharged);
  for (const ReactionBound& each : called.reactions) EXPECT_FALSE(each.bound);
  // One candidate and one call, each with up to 8 changes and one for the role: 18 words besides the cyclic one may be
  // in the queue when one more comes.
  const std::int64_t frame_ps = 6'720'000;  // of 84 octets at 100 Mbit/s
  EXPECT_GE(called.streams.at(0).latency->ps() - idle.streams.at(0).latency->ps(), 9 * frame_ps) << "9 changes more";
  // More than can be counted, and words that may be lost: a time-out may let go of somebody at any time.
  std::vector<std::pair<sim::Duration, std::string>> calls;
  for (int i = 1; i <= 22; ++i) calls.emplace_back(10_ms * i, i % 2 == 1 ? "Start" : "Halt");
  EXPECT_EQ(bound(*with_roles(script(calls))).ledger[A::program_publishes].standing, Standing::open);
  const Bounds lossy = bound(*with_roles(R"(, "faults": [{"kind": "frame-errors", "link": ["m", "s"], "loss": 0.1}])"));
  EXPECT_EQ(lossy.ledger[A::program_publishes].standing, Standing::open);
  // Who crashes is one of those whom the script moves, a cable that is pulled is not.
  EXPECT_EQ(bound(*with_roles(R"(, "faults": [{"kind": "crash", "node": "s", "at": "100ms", "for": "50ms"}])"))
                .ledger[A::program_publishes]
                .standing,
            Standing::discharged);
  EXPECT_EQ(
      bound(*with_roles(R"(, "faults": [{"kind": "link-down", "link": ["m", "s"], "at": "100ms", "for": "50ms"}])"))
          .ledger[A::program_publishes]
          .standing,
      Standing::open);
  EXPECT_NE(lossy.ledger[A::program_publishes].why.find("may be lost"), std::string::npos)
      << lossy.ledger[A::program_publishes].why;
}

}  // namespace
}  // namespace takt::analysis::program_assessment_test
