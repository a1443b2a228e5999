// SPDX-License-Identifier: Apache-2.0
// The tables against the core nodeset (tests/golden/program_state_machine.json, published by the OPC Foundation).
#include "program/table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "program/status.hpp"

namespace takt::program::table_test {
namespace {

nlohmann::json golden() {
  std::ifstream file(TAKT_SOURCE_DIR "/tests/golden/program_state_machine.json");
  return nlohmann::json::parse(file);
}

TEST(Table, StatesAreThoseOfTheNodeset) {
  const nlohmann::json expected = golden().at("states");
  ASSERT_EQ(expected.size(), states.size());
  for (const StateInfo& each : states) {
    const nlohmann::json& state = expected.at(std::string(each.name));
    EXPECT_EQ(state.at("nodeId"), each.node_id) << each.name;
    EXPECT_EQ(state.at("stateNumberNodeId"), each.state_number_node_id) << each.name;
    EXPECT_EQ(state.at("stateNumber"), number_of(each.state)) << each.name;
  }
}

TEST(Table, TransitionsAreThoseOfTheNodeset) {
  const nlohmann::json expected = golden().at("transitions");
  ASSERT_EQ(expected.size(), transitions.size());
  for (std::size_t i = 0; i < transitions.size(); ++i) {
    const Transition& each = transitions[i];
    EXPECT_EQ(expected[i].at("name"), each.name);
    EXPECT_EQ(expected[i].at("nodeId"), each.node_id) << each.name;
    EXPECT_EQ(expected[i].at("transitionNumberNodeId"), each.transition_number_node_id) << each.name;
    EXPECT_EQ(expected[i].at("transitionNumber"), each.number) << each.name;
    EXPECT_EQ(expected[i].at("from"), name_of(each.from)) << each.name;
    EXPECT_EQ(expected[i].at("to"), name_of(each.to)) << each.name;
    MethodSet causes;
    for (const nlohmann::json& cause : expected[i].at("causesInNodeSet")) {
      const MethodSet one{method_from_name(cause.get<std::string>()).value()};
      causes.bits = static_cast<std::uint8_t>(causes.bits | one.bits);
    }
    EXPECT_EQ(causes, each.nodeset_causes) << each.name;
  }
}

TEST(Table, MethodsAreThoseOfTheNodeset) {
  const nlohmann::json expected = golden().at("methods");
  ASSERT_EQ(expected.size(), methods.size());
  for (const MethodInfo& each : methods) EXPECT_EQ(expected.at(std::string(each.name)), each.node_id) << each.name;
}

TEST(Table, NamesAndNumbersAreFoundBack) {
  for (const StateInfo& each : states) EXPECT_EQ(state_from_number(number_of(each.state)), each.state);
  EXPECT_EQ(state_from_number(10), std::nullopt);
  EXPECT_EQ(state_from_number(15), std::nullopt);
  for (const MethodInfo& each : methods) EXPECT_EQ(method_from_name(each.name), each.method);
  EXPECT_EQ(method_from_name("start"), std::nullopt);
  EXPECT_EQ(transition_with_number(0), nullptr);
  EXPECT_EQ(transition_with_number(10), nullptr);
  for (const Transition& each : transitions) {
    EXPECT_EQ(transition_with_number(each.number), &each);
    EXPECT_EQ(transition_between(each.from, each.to), &each);
  }
}

// Part 10, Figure 4: of the 12 ordered pairs of states three have no transition.
TEST(Table, NineOfTwelvePairsHaveATransition) {
  EXPECT_EQ(transition_between(State::Halted, State::Running), nullptr);
  EXPECT_EQ(transition_between(State::Halted, State::Suspended), nullptr);
  EXPECT_EQ(transition_between(State::Ready, State::Suspended), nullptr);
  for (const StateInfo& from : states) {
    EXPECT_EQ(transition_between(from.state, from.state), nullptr);
    for (const StateInfo& to : states)
      EXPECT_EQ(transition_exists(from.state, to.state), transition_between(from.state, to.state) != nullptr);
  }
}

TEST(Status, NamesAreTheStandards) {
  EXPECT_EQ(static_cast<std::uint32_t>(StatusCode::BadInvalidState), 0x80AF0000U);
  EXPECT_EQ(name_of(StatusCode::BadInvalidState), "Bad_InvalidState");
  EXPECT_EQ(name_of(StatusCode::Good), "Good");
  EXPECT_EQ(name_of(static_cast<StatusCode>(0x80FFFFFFU)), "(unknown)");
  EXPECT_TRUE(is_good(StatusCode::Good));
  for (const StatusInfo& each : status_codes) EXPECT_EQ(is_good(each.code), each.code == StatusCode::Good) << each.name;
}

}  // namespace
}  // namespace takt::program::table_test
