// SPDX-License-Identifier: Apache-2.0
// Groups with roles: verdicts and numbers of states, and what the observer of roles sees.
#include <gtest/gtest.h>

#include <initializer_list>

#include "../ask.hpp"
#include "explore/model/roles_model.hpp"
#include "explore/report/chart.hpp"

namespace takt::explore {
namespace {

Query of_roles(std::uint8_t roles, std::uint8_t candidates, std::uint32_t commands, std::initializer_list<Fault> faults,
               bool starts_again = false) {
  Query query;
  query.slaves = roles;
  query.candidates = candidates;
  query.starts_again = starts_again;
  return with(query, commands, faults);
}

TEST(Roles, HoldInEveryOrder) {
  const Case cases[] = {
      {of_roles(1, 1, 1, {}), 398, 706},
      {of_roles(1, 1, 1, {Fault::loss, Fault::crash, Fault::restart, Fault::timeout}), 45383, 119880},
      {of_roles(1, 2, 1, {}), 12709, 47709},
      {of_roles(2, 2, 1, {}), 30245, 121548},
#ifdef NDEBUG
      {of_roles(1, 1, 2, {Fault::restart}), 273307, 782208},
      {of_roles(1, 2, 2, {}), 257385, 1078436},
      {of_roles(1, 2, 1, {Fault::crash}, true), 360120, 1545424},
#endif
  };
  for (const Case& each : cases) EXPECT_EQ(expect_to_hold(each)[Property::B1], PropertyVerdict::holds);
}

/// The group with roles is nested: its master is the last of so many slaves outside.
Query of_nested_roles(std::uint8_t outer_slaves, std::uint8_t roles, std::uint8_t candidates, std::uint32_t commands,
                      std::initializer_list<Fault> faults) {
  Query query = of_roles(outer_slaves, candidates, commands, faults);
  query.inner_slaves = roles;
  return query;
}

TEST(NestedRoles, HoldInEveryOrder) {
  const Case cases[] = {
      {of_nested_roles(1, 1, 1, 1, {}), 5764, 20280},
      {of_nested_roles(1, 1, 1, 1, {Fault::crash}), 35677, 130133},
      {of_nested_roles(2, 1, 1, 1, {}), 120736, 651422},
#ifdef NDEBUG
      {of_nested_roles(1, 1, 1, 3, {}), 1223467, 4827354},
      {of_nested_roles(1, 1, 1, 2, {Fault::crash}), 520078, 2020932},
      {of_nested_roles(1, 2, 2, 1, {}), 526754, 3104155},
#endif
  };
  for (const Case& each : cases) EXPECT_EQ(expect_to_hold(each)[Property::B1], PropertyVerdict::holds);
}

// A Start is taken by the group outside, which does not know that a role has nobody: all end Halted, and nobody waits
// for ever.
TEST(NestedRoles, AStartThatNobodyCanFollowEndsHalted) {
  Query query = of_nested_roles(1, 2, 2, 2, {});
  query.offers = {1, 1, 0};
  const SearchResult result = ask(query);
  EXPECT_EQ(result[Property::all_running], PropertyVerdict::unreached);
  EXPECT_EQ(result[transition_property(1)], PropertyVerdict::unreached);
  EXPECT_EQ(result[Property::L1], PropertyVerdict::holds);
}

TEST(NestedRoles, AChartNamesBothGroups) {
  Query query = of_nested_roles(1, 1, 1, 1, {});
  query.beginnings = Beginnings::switched_on;
  const SearchResult result = ask(query);
  ASSERT_EQ(result[transition_property(1)], PropertyVerdict::reached);
  const Trace& trace = *result.traces[index_of(transition_property(1))];
  const std::string text = chart(query, result.beginnings[trace.beginning], trace);
  for (const char* part :
       {"inner master        candidate 1         master              slave 1\n",
        "candidate 1 hears inner master: bound, role 1: candidate 1 life 1", "Start is called at the master",
        "slave 1 hears master: Halted.INIT (intent 1 start of master, run 0)"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(Roles, RunsBeginWhereverAGroupRests) {
  const RolesModel model(of_roles(2, 3, 1, {}));
  std::vector<std::string> names;
  for (const Beginning& each : model.beginnings()) names.push_back(each.name);
  EXPECT_EQ(names, (std::vector<std::string>{"switched on", "switched on, nobody has joined", "Running", "Suspended",
                                             "Ready after a reset"}));
}

// Whoever offers a skill that no role needs is never bound: the roles cannot be filled, so nothing can be started.
TEST(Roles, AGroupWhoseRolesNobodyFillsStaysHalted) {
  Query query = of_roles(2, 2, 2, {});
  query.offers = {1, 1, 0};
  const SearchResult result = ask(query);
  EXPECT_EQ(result[Property::all_running], PropertyVerdict::unreached);
  EXPECT_EQ(result[Property::L1], PropertyVerdict::holds);
  EXPECT_EQ(result[Property::B1], PropertyVerdict::holds);
}

/// A step in a state in which the property is violated by hand.
TEST(Roles, ASecondHolderThatCountsIsSeen) {
  Stations stations(of_roles(1, 2, 1, {}));
  // Bound is the first candidate; its word is said by the second one.
  const StationId first = stations.step_node(stations.candidate(0, 1, true, false), Happens::join).station;
  StationId master =
      stations.step_master(stations.master(1, false), Happens::received, 0, stations.announcement(first)).station;
  const StationId bound = stations.step_node(first, Happens::received, 0, stations.table(master)).station;
  ASSERT_TRUE(stations.node(bound).member.has_value());
  const auto heard = [&](std::size_t from) {
    return stations.events(stations.step_master(master, Happens::received, from, stations.word_of_node(bound)).events)
        .properties;
  };
  EXPECT_FALSE(heard(0).contains(Property::B1));
  EXPECT_TRUE(heard(1).contains(Property::B1));
}

TEST(Roles, AChartNamesTheRoles) {
  Query query = of_roles(1, 2, 1, {});
  query.beginnings = Beginnings::switched_on;
  const SearchResult result = ask(query);
  ASSERT_EQ(result[Property::all_running], PropertyVerdict::reached);
  const Trace& trace = *result.traces[index_of(Property::all_running)];
  const std::string text = chart(query, result.beginnings[trace.beginning], trace);
  for (const char* part :
       {"master              candidate 1         candidate 2\n", "hears master: bound, role 1: candidate 1 life 1",
        "Start is called at the master", "Running             Running, role 1     joins\n"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

}  // namespace
}  // namespace takt::explore
