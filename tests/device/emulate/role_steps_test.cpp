// SPDX-License-Identifier: Apache-2.0
// Logs of a master and of candidates become steps of roles, and statuses become states of a group.
#include "emulate/role_steps.hpp"

#include <gtest/gtest.h>

#include "emulate/expectation.hpp"
#include "emulate/invariant_check.hpp"
#include "scenario/resolve.hpp"

namespace takt::emulate::role_steps_test {
namespace {

using handshake::PublishedState;

/// A master m, the role r; a and b weld.
std::unique_ptr<scenario::Resolved> group(const std::string& more = "") {
  json::Diagnostics diagnostics;
  auto resolved = scenario::load_text(
      R"({"name": "s", "duration": "400ms", "network": {"nodes": {"m": {"kind": "host"}, "a": {"kind": "host", "offers": ["welding"]}, "b": {"kind": "host", "offers": ["welding"]},
 "w": {"kind": "switch"}}, "links": [{"ends": ["m", "w"]}, {"ends": ["a", "w"]}, {"ends": ["b", "w"]}]},
 "programs": [{"name": "p", "master": "m", "roles": [{"name": "r", "skill": "welding"}], "cycle": "1ms", "on_replacement": "restart"}])" +
          more + "}",
      "s.json", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}

PlannedNode node(std::optional<std::uint8_t> candidate) {
  PlannedNode planned;
  planned.parts = {{0, 0, candidate}};
  return planned;
}

std::string bound(int time, const std::string& to, int life) {
  return R"({"time_ns": )" + std::to_string(time) + R"(, "event": "bound", "role": "r", "to": )" + to +
         R"(, "life": )" + std::to_string(life) + "}";
}
std::string taken(int time, int life) {
  return R"({"time_ns": )" + std::to_string(time) + R"(, "role": "r", "event": "role taken", "life": )" +
         std::to_string(life) + "}";
}
std::string change(int time, const std::string& from, const std::string& to, int number, int run, bool is_role = true) {
  return R"({"time_ns": )" + std::to_string(time) + (is_role ? R"(, "role": "r")" : "") +
         R"(, "event": "transition", "number": )" + std::to_string(number) + R"(, "from": ")" + from + R"(", "to": ")" +
         to + R"(", "run": )" + std::to_string(run) + R"(, "intent_run": )" + std::to_string(run) + "}";
}

std::vector<LoggedStep> read(const scenario::Resolved& resolved, std::optional<std::uint8_t> candidate,
                             const std::vector<std::string>& lines) {
  LogReader reader(resolved, node(candidate));
  for (const std::string& line : lines) EXPECT_TRUE(reader.take(line)) << line;
  return reader.finish();
}

std::vector<LoggedStep> joined(std::vector<std::vector<LoggedStep>> logs) {
  std::vector<LoggedStep> all;
  for (const auto& log : logs) all.insert(all.end(), log.begin(), log.end());
  return all;
}

const std::string end = R"({"event": "end", "node": "x"})";

// a runs in the role, is killed and replaced by b. What a does after that, in its former role, is nobody's.
TEST(RoleSteps, AReplacedNodeIsNobody) {
  const auto resolved = group();
  const RoleSteps found = steps_of_roles(
      *resolved,
      joined({read(*resolved, std::nullopt,
                   {bound(10, "\"a\"", 5), change(20, "Halted", "Halted.INIT", 0, 0, false),
                    change(27, "Halted.INIT", "Ready", 1, 7, false), change(40, "Ready", "Running", 2, 7, false),
                    change(50, "Running", "Halted", 3, 7, false), bound(50, "\"b\"", 9), end}),
              read(*resolved, 0,
                   {taken(11, 5), change(21, "Halted", "Halted.INIT", 0, 0), change(25, "Halted.INIT", "Ready", 1, 7),
                    change(30, "Ready", "Running", 2, 7), change(55, "Running", "Halted", 3, 7),
                    R"({"time_ns": 60, "role": "r", "event": "role dropped"})", end}),
              read(*resolved, 1, {taken(61, 9), change(70, "Halted", "Halted.INIT", 0, 8)})}));
  ASSERT_EQ(found.histories[0].size(), 1u);
  EXPECT_EQ(found.histories[0][0].nodes, (std::vector<std::string>{"a", "b"}));
  std::vector<std::string> of_role;
  const std::vector<History> histories = histories_of(found.steps, 1);
  for (const Change& each : histories[0].changes)
    if (each.participant == 1)
      of_role.push_back((each.change.transition == 0 && each.change.to == PublishedState::Halted ? "x " : "") +
                        std::string(name_of(each.change.to)));
  // a's own halt at 55 is not there; b was killed at the end, in INIT.
  EXPECT_EQ(of_role,
            (std::vector<std::string>{"Halted.INIT", "Ready", "Running", "x Halted", "Halted.INIT", "x Halted"}));
  EXPECT_TRUE(check_invariants(*resolved, found.steps).violated.empty());
}

// The check can fail: the master runs before whoever has the role.
TEST(RoleSteps, WhatIsWrongIsSeen) {
  const auto resolved = group();
  const RoleSteps found = steps_of_roles(
      *resolved,
      joined({read(*resolved, std::nullopt,
                   {bound(10, "\"b\"", 5), change(20, "Halted", "Halted.INIT", 0, 0, false),
                    change(27, "Halted.INIT", "Ready", 1, 7, false), change(28, "Ready", "Running", 2, 7, false), end}),
              read(*resolved, 1,
                   {taken(11, 5), change(21, "Halted", "Halted.INIT", 0, 0), change(25, "Halted.INIT", "Ready", 1, 7),
                    change(30, "Ready", "Running", 2, 7), end})}));
  const InvariantCheck check = check_invariants(*resolved, found.steps);
  ASSERT_EQ(check.violated.size(), 1u);
  EXPECT_EQ(check.violated[0].substr(0, 3), "S2:");
}

TEST(RoleSteps, LinesThatNoNodeWrites) {
  const auto resolved = group();
  for (const std::string& line :
       {bound(1, "\"m\"", 1), std::string(R"({"time_ns": 1, "event": "bound", "role": "s", "to": null, "life": 0})")}) {
    LogReader reader(*resolved, node(std::nullopt));
    EXPECT_FALSE(reader.take(line)) << line;
  }
  LogReader reader(*resolved, node(0));
  EXPECT_FALSE(reader.take(change(21, "Halted", "Halted.INIT", 0, 0)));  // without a role
}

// Before the crash a has the role and all run; after it b; a comes back as a spare. Right behind an action nothing is
// settled.
TEST(Expectation, OfTheSimulatedRun) {
  const auto resolved = group(
      R"(, "script": [{"at": "50ms", "program": "p", "call": "Start"}, {"at": "58ms", "program": "p", "call": "Suspend"}, {"at": "90ms", "program": "p", "call": "Resume"}],
 "faults": [{"kind": "crash", "node": "a", "at": "95ms", "for": "205ms"}])");
  const Plan plan = plan_of(*resolved);
  const auto expectation = expectation_of(*resolved, plan);
  ASSERT_TRUE(expectation);
  ASSERT_EQ(plan.actions.size(), 5u);
  ASSERT_EQ(expectation->before.size(), 6u);
  EXPECT_EQ(expectation->order[0], (std::vector<std::uint8_t>{0, 1}));
  const GroupState halted{{PublishedState::Halted, PublishedState::Halted}, {"a"}, {true, true}};
  const GroupState running{{PublishedState::Running, PublishedState::Running}, {"a"}, {true, true}};
  EXPECT_EQ(expectation->before[0][0], halted);
  EXPECT_EQ(expectation->before[1][0], std::nullopt);
  const GroupState suspended{{PublishedState::Suspended, PublishedState::Suspended}, {"a"}, {true, true}};
  EXPECT_EQ(expectation->before[2][0], suspended);
  EXPECT_EQ(expectation->before[3][0], std::nullopt);  // it resumed 5 ms ago, which took some of them
  const GroupState replaced{{PublishedState::Running, PublishedState::Running}, {"b"}, {false, true}};
  EXPECT_EQ(expectation->before[4][0], replaced);
  const GroupState returned{{PublishedState::Running, PublishedState::Running}, {"b"}, {true, true}};
  EXPECT_EQ(expectation->before[5][0], returned);
  EXPECT_EQ(difference(replaced, replaced, *resolved, 0), "");
  EXPECT_EQ(difference(replaced, returned, *resolved, 0), "a is there, simulated not");
  EXPECT_EQ(difference(running, replaced, *resolved, 0), "role r has b, simulated a");
  EXPECT_EQ(difference(running, halted, *resolved, 0), "m is Halted, simulated Running");
}

TEST(Expectation, OfAStatus) {
  const auto resolved = group();
  const auto found = group_of_status(
      R"({"node": "m", "program": "p", "state": "Running", "roles": [{"name": "r", "skill": "welding", "node": null}],
 "candidates": [{"name": "a", "present": false, "role": null}, {"name": "b", "present": true, "role": null}]})",
      resolved->programs[0]);
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, (GroupState{{PublishedState::Running, PublishedState::Halted}, {""}, {false, true}}));
  EXPECT_FALSE(group_of_status(R"({"node": "m", "state": "Running"})", resolved->programs[0]));
  EXPECT_EQ(state_of_status(R"({"state": "Halted.INIT"})"), PublishedState::HaltedInit);
}

}  // namespace
}  // namespace takt::emulate::role_steps_test
