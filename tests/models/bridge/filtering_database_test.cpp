// SPDX-License-Identifier: Apache-2.0
// The database against std::map.
#include "models/bridge/filtering_database.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "sim/random.hpp"

namespace takt::models {
namespace {

using Ports = std::vector<std::uint16_t>;

Ports ports_of(const FilteringDatabase& database, VlanId vlan, std::uint32_t address) {
  const FilteringDatabase::Entry entry = database.find(vlan, AddressIndex{address});
  // What is known at once is what find() says.
  const std::uint32_t at_once = database.single_egress_port(vlan, AddressIndex{address});
  if (at_once != FilteringDatabase::not_at_once) {
    EXPECT_TRUE(entry.found() && entry.is_one_port());
    EXPECT_EQ(at_once, entry.port());
  }
  if (!entry.found()) return {};
  if (entry.is_one_port()) return {entry.port()};
  const auto several = database.ports_of(entry);
  return {several.begin(), several.end()};
}

// A lone entry lies where it is looked for first; one of several ports, or of another VLAN, is never known at once.
TEST(FilteringDatabase, KnowsOnePortAtOnce) {
  FilteringDatabase database;
  EXPECT_EQ(database.single_egress_port(1, AddressIndex{5}), FilteringDatabase::not_at_once);
  database.add(1, AddressIndex{5}, 0x7FFE);
  EXPECT_EQ(database.single_egress_port(1, AddressIndex{5}), 0x7FFEu);
  EXPECT_EQ(database.single_egress_port(2, AddressIndex{5}), FilteringDatabase::not_at_once);
  EXPECT_EQ(database.single_egress_port(1, AddressIndex{4}), FilteringDatabase::not_at_once);
  database.add(1, AddressIndex{5}, 3);
  EXPECT_EQ(database.single_egress_port(1, AddressIndex{5}), FilteringDatabase::not_at_once);
}

// The internal port of a station is none of those that a frame is handed to at once.
TEST(FilteringDatabase, NeverKnowsTheInternalPortAtOnce) {
  FilteringDatabase database;
  database.add(1, AddressIndex{5}, internal_port);
  EXPECT_EQ(database.single_egress_port(1, AddressIndex{5}), FilteringDatabase::not_at_once);
  EXPECT_EQ(database.entries(), 1u);
  EXPECT_EQ(ports_of(database, 1, 5), Ports{internal_port});
  database.add(1, AddressIndex{5}, 2);
  EXPECT_EQ(ports_of(database, 1, 5), (Ports{2, internal_port}));
}

TEST(FilteringDatabase, EmptyKnowsNothing) {
  const FilteringDatabase database;
  EXPECT_FALSE(database.find(0, AddressIndex{0}).found());
  EXPECT_FALSE(database.find(4'094, AddressIndex{0xFFFF'FFFF}).found());
  EXPECT_EQ(database.entries(), 0u);
}

TEST(FilteringDatabase, PortsAreAscendingAndDistinct) {
  FilteringDatabase database;
  for (const std::uint16_t port : std::initializer_list<std::uint16_t>{5, 2, 9, 2, 5, 0})
    database.add(7, AddressIndex{1}, port);
  EXPECT_EQ(ports_of(database, 7, 1), (Ports{0, 2, 5, 9}));
  EXPECT_EQ(database.entries(), 1u);
}

TEST(FilteringDatabase, VlanAndAddressAreBothTheKey) {
  FilteringDatabase database;
  database.add(1, AddressIndex{2}, 3);
  EXPECT_EQ(ports_of(database, 1, 2), Ports{3});
  EXPECT_TRUE(ports_of(database, 2, 1).empty());
  EXPECT_TRUE(ports_of(database, 0, 2).empty());
  EXPECT_TRUE(ports_of(database, 1, 3).empty());
}

TEST(FilteringDatabase, RefusesWhatDoesNotExist) {
  FilteringDatabase database;
  EXPECT_THROW(database.add(0, AddressIndex{}, 1), sim::InvariantBroken);
  EXPECT_THROW(database.add(4'095, AddressIndex{1}, 1), sim::InvariantBroken);
  EXPECT_THROW(database.add(0, AddressIndex{1}, 0x8000), sim::InvariantBroken);
  database.add(4'094, AddressIndex{0xFFFF'FFFE}, 0x7FFF);
  EXPECT_EQ(ports_of(database, 4'094, 0xFFFF'FFFE), Ports{0x7FFF});
}

TEST(FilteringDatabase, AgreesWithAMap) {
  FilteringDatabase database;
  std::map<std::pair<VlanId, std::uint32_t>, std::set<std::uint16_t>> oracle;
  sim::RandomStream chance(1, "filtering database", "test");
  for (int i = 0; i < 20'000; ++i) {
    const auto vlan = static_cast<VlanId>(chance.below(5) == 0 ? 4'094 : chance.below(3));
    const auto address = static_cast<std::uint32_t>(chance.below(4'000) + (chance.below(2) == 0 ? 0 : 0xFFFF'0000));
    const auto port = static_cast<std::uint16_t>(chance.below(8));
    database.add(vlan, AddressIndex{address}, port);
    oracle[{vlan, address}].insert(port);
    if (i % 1'000 != 0) continue;
    ASSERT_EQ(database.entries(), oracle.size());
    for (const auto& [key, ports] : oracle)
      ASSERT_EQ(ports_of(database, key.first, key.second), Ports(ports.begin(), ports.end()));
  }
  EXPECT_GT(oracle.size(), 5'000u);
  for (int i = 0; i < 20'000; ++i) {
    const auto vlan = static_cast<VlanId>(chance.below(4'095));
    const auto address = static_cast<std::uint32_t>(chance.below(5'000));
    const auto found = oracle.find({vlan, address});
    ASSERT_EQ(ports_of(database, vlan, address),
              found == oracle.end() ? Ports{} : Ports(found->second.begin(), found->second.end()));
  }
}

}  // namespace
}  // namespace takt::models
