// SPDX-License-Identifier: Apache-2.0
// Nested programs and programs with roles on simulated hosts.
#include <fmt/format.h>

#include <algorithm>

#include "../../protocol/handshake/dice.hpp"
#include "evaluation/evaluate.hpp"
#include "support.hpp"

namespace takt::scenario::test::groups_test {
namespace {

using results::ProgramResult;
using results::RunResult;

RunResult run(const std::string& text) {
  const auto resolved = sound(text);
  LiveRun live(*resolved);
  live.advance();
  return evaluation::evaluate(live, false);
}

std::string scenario(const std::string& nodes, const std::string& rest) {
  std::string hosts;
  std::string links;
  for (const auto& [name, offers] : std::vector<std::pair<std::string, std::string>>{
           {"m", ""}, {"a", R"(, "offers": ["x"])"}, {"b", R"(, "offers": ["x"])"}, {"c", R"(, "offers": ["y"])"}}) {
    hosts += fmt::format(R"("{}": {{"kind": "host", "os": "preempt-rt"{}}}, )", name, offers);
    links += fmt::format(R"({}{{"ends": ["{}", "sw"]}})", links.empty() ? "" : ", ", name);
  }
  return fmt::format(
      R"({{"name": "g", "network": {{"nodes": {{{}{}"sw": {{"kind": "switch", "forwarding_delay": "1us"}}}}, "links": [{}]}}, {}}})",
      hosts, nodes, links, rest);
}

std::string nested(const std::string& script, const std::string& faults = "") {
  return scenario(
      "", R"("duration": "400ms", "programs": [{"name": "o", "master": "m", "slaves": ["a", "b"], "cycle": "1ms"},
    {"name": "i", "within": "o", "master": "b", "slaves": ["c"], "cycle": "250us", "process_data": [{"name": "d", "from": "b", "fields": {"x": "Double"}}]}],
    "script": [{"at": "10.1ms", "program": "o", "call": "Start"})" +
              script + "], \"faults\": [" + faults + "]");
}

void expect_all(const RunResult& result, const std::string& state) {
  for (const ProgramResult& program : result.programs) {
    for (const std::string& each : program.states) EXPECT_EQ(each, state) << program.name;
    EXPECT_TRUE(program.violations.empty()) << program.name;
  }
}

TEST(NestedPrograms, StartTogetherAndTheTreeHasAReactionOfItsOwn) {
  const RunResult result = run(nested(""));
  expect_all(result, "Running");
  ASSERT_EQ(result.programs[0].tree_reactions.size(), 1u);
  EXPECT_EQ(result.programs[0].tree_reactions[0].initiator, "o/m");
  EXPECT_EQ(result.programs[0].tree_reactions[0].duration(), result.programs[0].reactions[0].duration())
      << "the outer master is the last to run";
  EXPECT_TRUE(result.programs[1].tree_reactions.empty());
  EXPECT_EQ(result.programs[1].reactions[0].cause, "nested");
  EXPECT_GT(result.programs[1].process_data_received, 1000u);
}

TEST(NestedPrograms, EveryMethodPassesBothWays) {
  expect_all(run(nested(R"(, {"at": "100.1ms", "program": "i", "call": "Suspend", "on": "c"})")), "Suspended");
  expect_all(
      run(nested(
          R"(, {"at": "100.1ms", "program": "o", "call": "Suspend"}, {"at": "150.1ms", "program": "i", "call": "Resume", "on": "c"})")),
      "Running");
  expect_all(
      run(nested(
          R"(, {"at": "100.1ms", "program": "o", "call": "Suspend", "on": "a"}, {"at": "150.1ms", "program": "i", "call": "Reset", "on": "b"})")),
      "Ready");
  expect_all(run(nested(R"(, {"at": "100.1ms", "program": "i", "call": "Halt", "on": "c"})")), "Halted");
  expect_all(run(nested(R"(, {"at": "100.1ms", "program": "o", "call": "Halt"})")), "Halted");
}

TEST(NestedPrograms, ACrashAnywhereHaltsTheTreeAndItStartsAgain) {
  for (const char* node : {"m", "a", "b", "c"}) {
    const std::string fault = fmt::format(R"({{"kind": "crash", "node": "{}", "at": "100ms", "for": "50ms"}})", node);
    expect_all(run(nested("", fault)), "Halted");
    expect_all(run(nested(R"(, {"at": "300.1ms", "program": "o", "call": "Start"})", fault)), "Running");
  }
}

std::string with_roles(const std::string& script, const std::string& faults = "", const std::string& more = "") {
  return scenario(
      "",
      R"("duration": "400ms", "programs": [{"name": "p", "master": "m", "roles": [{"name": "r", "skill": "x"}, {"name": "s", "skill": "y"}],
    "announce_every": "2ms", "cycle": "500us")" +
          more + R"(, "process_data": [{"name": "up", "from": "r", "fields": {"v": "Float"}}]}],
    "script": [{"at": "20.1ms", "program": "p", "call": "Start"})" +
          script + "], \"faults\": [" + faults + "]");
}

/// A line of m and c, and c the master of a role that a and b may have.
std::string roles_within(const std::string& script, const std::string& faults = "", const std::string& more = "") {
  return scenario("",
                  R"("duration": "400ms", "programs": [{"name": "o", "master": "m", "slaves": ["c"], "cycle": "1ms"},
    {"name": "i", "within": "o", "master": "c", "roles": [{"name": "r", "skill": "x"}], "announce_every": "2ms", "cycle": "500us")" +
                      more + R"(,
     "process_data": [{"name": "up", "from": "r", "fields": {"v": "Float"}}]}],
    "script": [{"at": "20.1ms", "program": "o", "call": "Start"})" +
                      script + "], \"faults\": [" + faults + "]");
}

std::vector<std::string> bindings(const RunResult& result, std::size_t program = 0) {
  std::vector<std::string> all;
  for (const results::BindingResult& each : result.programs[program].bindings)
    all.push_back(each.role + " " + each.node);
  return all;
}

TEST(Roles, AreBoundAndRun) {
  const RunResult result = run(with_roles(""));
  expect_all(result, "Running");
  EXPECT_EQ(bindings(result), (std::vector<std::string>{"r a", "s c"}));
  EXPECT_GT(result.programs[0].process_data_received, 500u);
}

TEST(Roles, ASpareReplacesACrashedNode) {
  const std::string crash = R"({"kind": "crash", "node": "a", "at": "100ms", "for": "200ms"})";
  const RunResult stays = run(with_roles("", crash));
  expect_all(stays, "Halted");
  EXPECT_EQ(bindings(stays), (std::vector<std::string>{"r a", "s c", "r b"}));
  expect_all(run(with_roles("", crash, R"(, "on_replacement": "restart")")), "Running");
  expect_all(run(with_roles(R"(, {"at": "200.1ms", "program": "p", "call": "Start"})", crash)), "Running");
}

TEST(Roles, AbsentOnesJoinAndLeaversAreLetGo) {
  const RunResult late =
      run(with_roles(R"(, {"at": "100ms", "join": "c"}, {"at": "150.1ms", "program": "p", "call": "Start"})", "",
                     R"(, "absent": ["c"])"));
  expect_all(late, "Running");
  EXPECT_EQ(late.programs[0].reactions.size(), 1u) << "the first Start was refused";
  const RunResult left = run(with_roles(R"(, {"at": "100ms", "leave": "c"})"));
  expect_all(left, "Halted");
  EXPECT_EQ(bindings(left), (std::vector<std::string>{"r a", "s c", "s "}));
}

TEST(Roles, ARestartedMasterBindsAnew) {
  const std::string crash = R"({"kind": "crash", "node": "m", "at": "100ms", "for": "5ms"})";
  expect_all(run(with_roles(R"(, {"at": "200.1ms", "program": "p", "call": "Start"})", crash)), "Running");
}

TEST(NestedRoles, StartWithTheGroupOutsideAndPassMethodsBothWays) {
  const RunResult result = run(roles_within(""));
  expect_all(result, "Running");
  EXPECT_EQ(bindings(result, 1), (std::vector<std::string>{"r a"}));
  EXPECT_GT(result.programs[1].process_data_received, 500u);
  ASSERT_EQ(result.programs[0].tree_reactions.size(), 1u);
  EXPECT_EQ(result.programs[0].tree_reactions[0].initiator, "o/m");
  EXPECT_EQ(result.programs[0].tree_reactions[0].duration(), result.programs[0].reactions[0].duration())
      << "the outer master is the last to run";
  expect_all(run(roles_within(R"(, {"at": "100.1ms", "program": "i", "call": "Suspend", "on": "r"})")), "Suspended");
  expect_all(
      run(roles_within(
          R"(, {"at": "100.1ms", "program": "o", "call": "Suspend"}, {"at": "150.1ms", "program": "i", "call": "Reset", "on": "r"})")),
      "Ready");
}

// The role is bound anew in Halted, so the line stands still until somebody starts it again.
TEST(NestedRoles, WhoeverLeavesOrCrashesHaltsTheTreeAndIsReplaced) {
  const std::string again = R"(, {"at": "300.1ms", "program": "o", "call": "Start"})";
  const std::string leave = R"(, {"at": "100.1ms", "leave": "a"})";
  const std::string crash = R"({"kind": "crash", "node": "a", "at": "100ms"})";
  for (const auto& [script, fault] : {std::pair(leave, std::string()), std::pair(std::string(), crash)}) {
    const RunResult stays = run(roles_within(script, fault));
    expect_all(stays, "Halted");
    EXPECT_EQ(bindings(stays, 1), (std::vector<std::string>{"r a", "r b"}));
    expect_all(run(roles_within(script + again, fault)), "Running");
  }
}

// Whoever has no tool cannot run: it halts the group outside, which has started in good faith, and follows when the
// tool is there.
TEST(NestedRoles, AStartFollowsNoFurtherThanARoleThatNobodyHas) {
  const std::string absent = R"(, "candidates": ["a"], "absent": ["a"])";
  const RunResult result = run(roles_within("", "", absent));
  expect_all(result, "Halted");
  ASSERT_EQ(result.programs[0].tree_reactions.size(), 2u);
  EXPECT_TRUE(result.programs[0].tree_reactions[0].superseded);
  EXPECT_EQ(result.programs[0].tree_reactions[1].kind, "halt");
  EXPECT_EQ(result.programs[0].tree_reactions[1].cause, "leave");
  EXPECT_TRUE(result.programs[1].reactions.empty()) << "the inner group has never moved";
  expect_all(run(roles_within(R"(, {"at": "100ms", "join": "a"}, {"at": "200.1ms", "program": "o", "call": "Start"})",
                              "", absent)),
             "Running");
}

TEST(NestedRoles, ACrashOfEitherMasterHaltsTheTreeAndItStartsAgain) {
  for (const char* node : {"m", "c"}) {
    const std::string fault = fmt::format(R"({{"kind": "crash", "node": "{}", "at": "100ms", "for": "50ms"}})", node);
    expect_all(run(roles_within("", fault)), "Halted");
    expect_all(run(roles_within(R"(, {"at": "300.1ms", "program": "o", "call": "Start"})", fault)), "Running");
  }
}

// Calls, joins, leaves, crashes and lost words by chance, for 300 ms: the invariants of both groups and of the tree
// hold, and when all are there again a Start takes all to Running.
TEST(NestedRoles, HoldUnderRandomSchedules) {
  const char* const methods[] = {"Start", "Start", "Suspend", "Resume", "Reset", "Halt"};
  const std::vector<std::pair<const char*, const char*>> places = {{"o", "m"}, {"o", "c"}, {"i", "c"}, {"i", "r"}};
  const char* const nodes[] = {"m", "a", "b", "c"};
  for (std::uint64_t seed = 1; seed <= handshake::schedules_wanted(150, 20); ++seed) {
    handshake::Dice dice(seed);
    const auto some_time = [&dice] { return fmt::format("{}us", 30'000 + dice.below(250'000)); };
    std::vector<std::pair<std::uint32_t, std::string>> entries;
    for (std::uint32_t i = 0; i < 12; ++i) {
      const std::uint32_t at = 30'000 + dice.below(250'000);
      std::string what;
      if (dice.below(3) == 0) {
        what = fmt::format(R"("{}": "{}")", dice.below(2) == 0 ? "join" : "leave", dice.below(2) == 0 ? "a" : "b");
      } else {
        const auto& [program, on] = places[dice.below(4)];
        const char* const method = methods[dice.below(6)];
        what = std::string_view(method) == "Start"
                   ? R"("program": "o", "call": "Start")"
                   : fmt::format(R"("program": "{}", "call": "{}", "on": "{}")", program, method, on);
      }
      entries.emplace_back(at, what);
    }
    std::ranges::sort(entries);
    std::string script;
    for (const auto& [at, what] : entries) script += fmt::format(R"(, {{"at": "{}us", {}}})", at, what);
    script +=
        R"(, {"at": "330ms", "join": "a"}, {"at": "330ms", "join": "b"}, {"at": "360ms", "program": "o", "call": "Halt"}, {"at": "380ms", "program": "o", "call": "Start"})";
    std::string faults;
    for (std::uint32_t i = 0; i < 3; ++i)
      faults += fmt::format(R"({}{{"kind": "crash", "node": "{}", "at": "{}", "for": "{}ms"}})", i == 0 ? "" : ", ",
                            nodes[dice.below(4)], some_time(), 1 + dice.below(30));
    faults +=
        fmt::format(R"(, {{"kind": "frame-errors", "link": ["{}", "sw"], "loss": 0.{}, "at": "{}", "for": "20ms"}})",
                    nodes[dice.below(4)], 1 + dice.below(9), some_time());
    SCOPED_TRACE("seed " + std::to_string(seed) + script + faults);
    expect_all(run(roles_within(script, faults)), "Running");
  }
}

}  // namespace
}  // namespace takt::scenario::test::groups_test
