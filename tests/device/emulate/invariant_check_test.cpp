// SPDX-License-Identifier: Apache-2.0
// Logs of nodes become steps, and steps out of order are seen.
#include "emulate/invariant_check.hpp"

#include <gtest/gtest.h>

#include "scenario/resolve.hpp"

namespace takt::emulate::invariant_check_test {
namespace {

using handshake::PublishedState;
using handshake::StateChange;

constexpr StateChange init{0, PublishedState::Halted, PublishedState::HaltedInit};
constexpr StateChange ready{1, PublishedState::HaltedInit, PublishedState::Ready};
constexpr StateChange running{2, PublishedState::Ready, PublishedState::Running};

/// p (master plc, slave m), and q within it (master m, slave x).
std::unique_ptr<scenario::Resolved> nested() {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(
      R"({"name": "s", "duration": "1s", "network": {"nodes": {"plc": {"kind": "host"}, "m": {"kind": "host"}, "x": {"kind": "host"}, "w": {"kind": "switch"}},
 "links": [{"ends": ["plc", "w"]}, {"ends": ["m", "w"]}, {"ends": ["x", "w"]}]},
 "programs": [{"name": "p", "master": "plc", "slaves": ["m"], "cycle": "1ms"}, {"name": "q", "within": "p", "master": "m", "slaves": ["x"], "cycle": "1ms"}]})",
      "s.json", {}, diagnostics);
  if (!resolved) throw std::runtime_error(diagnostics.to_text());
  return resolved;
}

LoggedStep step(std::int64_t time, std::uint32_t program, std::uint8_t participant, std::optional<StateChange> change,
                std::uint32_t run, std::uint32_t intent_run, std::optional<handshake::IntentKind> raised = {}) {
  LoggedStep made;
  made.time = time;
  made.program = program;
  made.participant = participant;
  made.raised = raised;
  made.change = change;
  made.run = run;
  made.intent_run = intent_run;
  return made;
}

/// A start of the tree: run 5 outside, 7 inside.
std::vector<LoggedStep> start() {
  const auto begin = handshake::IntentKind::Start;
  return {step(10, 0, 0, {}, 0, 5, begin), step(10, 0, 0, init, 0, 5),    step(11, 0, 1, init, 0, 5),
          step(11, 1, 0, {}, 0, 7, begin), step(11, 1, 0, init, 0, 7),    step(12, 1, 1, init, 0, 7),
          step(20, 1, 1, ready, 7, 7),     step(21, 0, 1, ready, 5, 5),   step(30, 0, 0, ready, 5, 5),
          step(31, 1, 0, ready, 7, 7),     step(32, 1, 1, running, 7, 7), step(33, 1, 0, running, 7, 7),
          step(33, 0, 1, running, 5, 5),   step(40, 0, 0, running, 5, 5)};
}

TEST(InvariantCheck, AStartOfATree) {
  const auto resolved = nested();
  const InvariantCheck check = check_invariants(*resolved, start());
  EXPECT_EQ(check.steps, 14u);
  EXPECT_EQ(check.violated, std::vector<std::string>());
}

struct Broken {
  std::size_t step;
  std::int64_t time;
  const char* what;
};

class Violations : public ::testing::TestWithParam<Broken> {};

TEST_P(Violations, AreSeen) {
  const auto resolved = nested();
  std::vector<LoggedStep> steps = start();
  steps[GetParam().step].time = GetParam().time;
  const InvariantCheck check = check_invariants(*resolved, steps);
  bool is_found = false;
  for (const std::string& each : check.violated) is_found = is_found || each == GetParam().what;
  EXPECT_TRUE(is_found) << ::testing::PrintToString(check.violated);
}

INSTANTIATE_TEST_SUITE_P(
    All, Violations,
    ::testing::Values(Broken{8, 35, "S1: x of q is Running in a run in which not all have been Ready (of the tree)"},
                      Broken{12, 45, "S2: plc of p is master and Running before all slaves have been Running"},
                      Broken{10, 50,
                             "S2: m of p is master and Running before all slaves have been Running (of the tree)"},
                      Broken{5, 25, "S5: x of q took a transition that does not leave its state"}));

TEST(InvariantCheck, ProgramsWithoutATree) {
  auto resolved = nested();
  resolved->programs[1].outer.reset();
  std::vector<LoggedStep> steps = start();
  steps[6].time = 60;
  const InvariantCheck check = check_invariants(*resolved, steps);
  EXPECT_FALSE(check.violated.empty());
  EXPECT_EQ(check.violated.front().substr(0, 4), "S5: ");
}

TEST(LogReader, NamesThePrograms) {
  const auto resolved = nested();
  PlannedNode node;
  node.parts = {{0, 1}, {1, 0}};
  LogReader reader(*resolved, node);
  for (
      const char* line :
      {R"({"time_ns": 1, "event": "start", "node": "m", "incarnation": 1})",
       R"({"time_ns": 5, "program": "p", "event": "transition", "number": 0, "from": "Halted", "to": "Halted.INIT", "run": 0, "intent_run": 5})",
       R"({"time_ns": 6, "program": "q", "event": "intent", "kind": "start", "cause": "nested group", "run": 0, "intent_run": 7})",
       R"({"time_ns": 6, "program": "q", "event": "transition", "number": 0, "from": "Halted", "to": "Halted.INIT", "run": 0, "intent_run": 7})",
       R"({"time_ns": 7, "prog)", R"({"time_ns": 9, "event": "start", "node": "m", "incarnation": 2})",
       R"({"event": "end", "time_ns": 12, "node": "m", "programs": []})"})
    EXPECT_TRUE(reader.take(line)) << line;
  EXPECT_FALSE(reader.take(
      R"({"time_ns": 5, "program": "r", "event": "transition", "number": 0, "from": "Halted", "to": "Halted.INIT"})"));
  EXPECT_FALSE(reader.take(
      R"({"time_ns": 5, "program": "q", "event": "transition", "number": 0, "from": "Halted", "to": "Gone"})"));
  const std::vector<LoggedStep> steps = reader.finish();
  ASSERT_EQ(steps.size(), 5u);  // two of them the crash between the two starts
  EXPECT_EQ(steps[0].program, 0u);
  EXPECT_EQ(steps[0].participant, 1);
  EXPECT_EQ(steps[1].raised, handshake::IntentKind::Start);
  EXPECT_EQ(steps[1].intent_run, 7u);
  EXPECT_TRUE(steps[3].is_crash && steps[4].is_crash);
  const std::vector<History> histories = histories_of(steps, 2);
  ASSERT_EQ(histories[0].changes.size(), 2u);
  EXPECT_EQ(histories[0].changes[1].change.to, PublishedState::Halted);
  EXPECT_EQ(histories[1].changes.size(), 2u);
}

}  // namespace
}  // namespace takt::emulate::invariant_check_test
