// SPDX-License-Identifier: Apache-2.0
// What a scenario comes down to on a machine, without touching one.
#include "emulate/plan.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "node/config.hpp"
#include "scenario/resolve.hpp"

namespace takt::emulate::plan_test {
namespace {

std::string scenario(const std::string& nodes, const std::string& links, const std::string& more) {
  return R"({"name": "s", "duration": "1s", "network": {"nodes": {"m": {"kind": "host"}, "a": {"kind": "host"}, "x": {"kind": "switch"})" +
         nodes + R"(}, "links": [{"ends": ["m", "x"]}, )" + links + "]}" + more + "}";
}
const std::string program =
    R"(, "programs": [{"name": "p", "master": "m", "slaves": ["a"], "cycle": "1ms", "vlan": 7, "pcp": 5, "publish": "on-change"}])";

struct Planned {
  explicit Planned(const std::string& text) {
    json::Diagnostics diagnostics;
    resolved = scenario::load_text(text, "s.json", {}, diagnostics);
    if (!resolved) throw std::runtime_error(diagnostics.to_text());
    plan = plan_of(*resolved);
  }
  std::unique_ptr<scenario::Resolved> resolved;
  Plan plan;
};

bool speaks_of(const std::vector<std::string>& texts, const std::string& what) {
  for (const std::string& each : texts)
    if (each.find(what) != std::string::npos) return true;
  return false;
}

TEST(Plan, HostsSwitchesAndCables) {
  const Planned planned(scenario(
      "", R"({"ends": ["a", "x"]})",
      program +
          R"(, "script": [{"at": "500ms", "program": "p", "call": "Halt", "on": "a"}, {"at": "100ms", "program": "p", "call": "Start"}])"));
  const Plan& plan = planned.plan;
  EXPECT_TRUE(plan.refusals.empty());
  EXPECT_EQ(plan.is_bridge, (std::vector<bool>{false, false, true}));
  ASSERT_EQ(plan.cables.size(), 2u);
  EXPECT_EQ(plan.cables[1].a.interface, "eth0");
  EXPECT_EQ(plan.cables[1].b.interface, "p1");
  ASSERT_EQ(plan.nodes.size(), 2u);
  ASSERT_EQ(plan.actions.size(), 2u);
  EXPECT_EQ(std::get<CallAction>(plan.actions[0].what).node, 0u);
  EXPECT_EQ(std::get<CallAction>(plan.actions[1].what).node, 1u);
  EXPECT_EQ(std::get<CallAction>(plan.actions[1].what).method, program::Method::Halt);
}

// Every file is sound, and says of the Program what the scenario says.
TEST(Plan, FilesOfNodes) {
  const Planned planned(scenario("", R"({"ends": ["a", "x"]})", program));
  for (const PlannedNode& node : planned.plan.nodes) {
    const std::string path = std::string(::testing::TempDir()) + "takt-planned.json";
    std::ofstream(path) << node.config;
    json::Diagnostics diagnostics;
    const auto loaded = node::load_config(path, diagnostics);
    std::filesystem::remove(path);
    ASSERT_TRUE(loaded) << diagnostics.to_text();
    EXPECT_EQ(loaded->programs[0].endpoint.handshake.index, node.parts[0].participant);
    EXPECT_TRUE(loaded->programs[0].endpoint.publish_on_change);
    EXPECT_EQ(loaded->config.control, control_mark);
    const auto& transport = std::get<node::EthernetTransport>(loaded->config.transport);
    EXPECT_EQ(transport.vlan, 7);
    EXPECT_EQ(transport.pcp, 5);
  }
}

TEST(Plan, ARingIsOpened) {
  const Planned planned(
      scenario(R"(, "y": {"kind": "switch"}, "z": {"kind": "switch"})",
               R"({"ends": ["x", "y"]}, {"ends": ["y", "z"]}, {"ends": ["z", "x"]}, {"ends": ["a", "z"]})", program));
  EXPECT_EQ(planned.resolved->topology.links.size(), 5u);
  EXPECT_EQ(planned.plan.cables.size(), 4u);
  EXPECT_TRUE(speaks_of(planned.plan.notes, "z - x"));
}

TEST(Plan, WhatIsLeftOutIsSaid) {
  const Planned planned(
      scenario("", R"({"ends": ["a", "x"]})",
               program + R"(, "streams": [{"name": "t", "from": "m", "to": "a", "payload": "100B", "every": "1ms"}],
 "faults": [{"kind": "frame-errors", "link": ["m", "x"], "loss": 0.1}])"));
  EXPECT_TRUE(speaks_of(planned.plan.notes, "streams"));
  EXPECT_TRUE(speaks_of(planned.plan.notes, "frame errors"));
}

TEST(Plan, RoundTripsAreLeftOut) {
  json::Diagnostics diagnostics;
  const auto resolved =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/scenarios/applications/round-trip.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  const Plan made = plan_of(*resolved);
  EXPECT_TRUE(made.refusals.empty());
  EXPECT_TRUE(speaks_of(made.notes, "round trips"));
}

TEST(Plan, CrashesAndCutsAreActions) {
  const Planned planned(scenario(
      "", R"({"ends": ["a", "x"]})",
      program +
          R"(, "faults": [{"kind": "crash", "node": "a", "at": "100ms", "for": "50ms"}, {"kind": "link-down", "link": ["m", "x"], "at": "300ms", "for": "1ms"}])"));
  ASSERT_EQ(planned.plan.actions.size(), 4u);
  EXPECT_FALSE(std::get<HostAction>(planned.plan.actions[0].what).up);
  EXPECT_TRUE(std::get<HostAction>(planned.plan.actions[1].what).up);
  EXPECT_EQ(std::get<LinkAction>(planned.plan.actions[2].what).cable, 0u);
}

const std::string inner =
    R"({"name": "q", "within": "p", "master": "a", "slaves": ["b"], "cycle": "500us", "vlan": 7, "pcp": 5})";

std::string nested_scenario(const std::string& nested) {
  return scenario(R"(, "b": {"kind": "host"})", R"({"ends": ["a", "x"]}, {"ends": ["b", "x"]})",
                  program.substr(0, program.size() - 1) + ", " + nested +
                      R"(], "script": [{"at": "100ms", "program": "q", "call": "Halt"}])");
}

// The slave of the outer Program and the master of the inner one are one process.
TEST(Plan, NestedProgramsAreJoined) {
  const Planned planned(nested_scenario(inner));
  EXPECT_TRUE(planned.plan.refusals.empty());
  ASSERT_EQ(planned.plan.nodes.size(), 3u);
  const PlannedNode& both = planned.plan.nodes[1];
  ASSERT_EQ(both.parts.size(), 2u);
  EXPECT_EQ(both.parts[1].program, 1u);
  EXPECT_EQ(both.parts[1].participant, 0);
  EXPECT_EQ(std::get<CallAction>(planned.plan.actions[0].what).node, 1u);
  EXPECT_EQ(std::get<CallAction>(planned.plan.actions[0].what).part, 1u);
  const std::string path = std::string(::testing::TempDir()) + "takt-planned-nested.json";
  std::ofstream(path) << both.config;
  json::Diagnostics diagnostics;
  const auto loaded = node::load_config(path, diagnostics);
  std::filesystem::remove(path);
  ASSERT_TRUE(loaded) << diagnostics.to_text();
  ASSERT_EQ(loaded->programs.size(), 2u);
  EXPECT_EQ(loaded->programs[1].outer, 0u);
  EXPECT_EQ(loaded->programs[1].endpoint.format->shape().first_publisher_id, 3);
}

TEST(Plan, OneNodeHasOneTransport) {
  std::string tagged = inner;
  tagged.replace(tagged.find("\"vlan\": 7"), 9, "\"vlan\": 8");
  EXPECT_TRUE(speaks_of(Planned(nested_scenario(tagged)).plan.refusals, "VLANs"));
}

const std::string roles =
    R"(, "c": {"kind": "host", "offers": ["welding"]}, "d": {"kind": "host", "offers": ["welding", "painting"]}}, "links": [{"ends": ["m", "x"]}, {"ends": ["a", "x"]}, {"ends": ["c", "x"]}, {"ends": ["d", "x"]}]}, "programs": [
 {"name": "p", "master": "m", "cycle": "1ms", "roles": [{"name": "r", "skill": "welding"}], "absent": ["d"], "announce_every": "20ms", "on_replacement": "restart"}],
 "script": [{"at": "100ms", "program": "p", "call": "Start"}, {"at": "200ms", "join": "d"}, {"at": "300ms", "leave": "c"}, {"at": "400ms", "program": "p", "call": "Suspend", "on": "r"}]})";

// The master and each candidate are nodes; a call on a role waits for whoever has it.
TEST(Plan, RolesHaveCandidates) {
  const std::string begin =
      R"({"name": "s", "duration": "1s", "network": {"nodes": {"m": {"kind": "host"}, "a": {"kind": "host"}, "x": {"kind": "switch"})";
  const Planned planned(begin + roles);
  EXPECT_TRUE(planned.plan.refusals.empty());
  ASSERT_EQ(planned.plan.nodes.size(), 3u);
  EXPECT_EQ(planned.plan.nodes[0].parts[0].candidate, std::nullopt);
  EXPECT_EQ(planned.plan.nodes[2].parts[0].candidate, 1);
  EXPECT_FALSE(planned.plan.nodes[1].is_absent);
  EXPECT_TRUE(planned.plan.nodes[2].is_absent);
  const std::vector<Action>& actions = planned.plan.actions;
  ASSERT_EQ(actions.size(), 4u);
  EXPECT_EQ(std::get<CallAction>(actions[0].what).role, std::nullopt);
  EXPECT_TRUE(std::get<MembershipAction>(actions[1].what).joins);
  EXPECT_EQ(std::get<MembershipAction>(actions[1].what).node, 2u);
  EXPECT_EQ(std::get<MembershipAction>(actions[2].what).node, 1u);
  EXPECT_EQ(std::get<CallAction>(actions[3].what).node, 0u);
  EXPECT_EQ(std::get<CallAction>(actions[3].what).role, 0);
  for (const PlannedNode& node : planned.plan.nodes) {
    std::string config = node.config;
    if (const std::size_t mark = config.find(absent_mark); mark != std::string::npos)
      config.replace(mark, std::string(absent_mark).size(), "true");
    const std::string path = std::string(::testing::TempDir()) + "takt-planned-roles.json";
    std::ofstream(path) << config;
    json::Diagnostics diagnostics;
    const auto loaded = node::load_config(path, diagnostics);
    std::filesystem::remove(path);
    ASSERT_TRUE(loaded) << config << diagnostics.to_text();
    ASSERT_TRUE(loaded->programs[0].roles);
    const auto& offer = loaded->programs[0].roles->offer;
    EXPECT_EQ(offer ? std::optional(offer->number) : std::nullopt, node.parts[0].candidate);
    EXPECT_EQ(loaded->programs[0].program.on_replacement, node::OnReplacement::restart);
    EXPECT_EQ(loaded->programs[0].roles->announce_cycle, sim::Duration::from_ps(20'000'000'000));
    EXPECT_EQ(loaded->config.absent, node.parts[0].candidate.has_value());
  }
}

TEST(Plan, WithoutAProgramThereIsNothingToRun) {
  EXPECT_FALSE(Planned(scenario("", R"({"ends": ["a", "x"]})", "")).plan.refusals.empty());
}

}  // namespace
}  // namespace takt::emulate::plan_test
