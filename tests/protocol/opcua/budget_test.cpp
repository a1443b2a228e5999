// SPDX-License-Identifier: Apache-2.0
// Budgets as values: rates, turns, octets, places. No server, no clock.
#include "opcua/server/budget.hpp"

#include <gtest/gtest.h>

#include "opcua/server/places.hpp"
#include "support/opcua_bench.hpp"

namespace takt::opcua {
namespace {

sim::LocalTime at_ms(std::int64_t count) { return test::at(count).local; }

// 100 units a second: those of a second at once, then one each 10 ms.
TEST(Budget, ARateGivesASecondAtOnceAndThenOneUnitAfterTheOther) {
  Rate rate(100);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(rate.try_spend(1, at_ms(0)));
  EXPECT_FALSE(rate.try_spend(1, at_ms(9)));
  EXPECT_EQ(rate.ready(1), at_ms(10));
  EXPECT_TRUE(rate.try_spend(1, at_ms(10)));
  EXPECT_EQ(rate.ready(3), at_ms(40));
  EXPECT_TRUE(rate.try_spend(100, at_ms(2000)));
  EXPECT_FALSE(rate.try_spend(1, at_ms(2000)));
}

TEST(Budget, MoreThanThoseOfASecondCanBeSpentAfterASilence) {
  Rate rate(10);
  EXPECT_TRUE(rate.try_spend(1000, at_ms(0)));
  EXPECT_FALSE(rate.try_spend(1000, at_ms(999)));
  EXPECT_TRUE(rate.try_spend(1000, at_ms(1000)));
}

TEST(Budget, WhoeverHasSpentLeastIsNext) {
  FairShares shares;
  shares.serve("flood", 1000);
  shares.serve("flood", 1000);
  EXPECT_LT(shares.spent("plain"), shares.spent("flood"));
  shares.serve("plain", 1);
  EXPECT_LT(shares.spent("plain"), shares.spent("flood"));
}

// A pause is no credit: who comes back begins where the others are.
TEST(Budget, APauseSavesNothing) {
  FairShares shares;
  for (int i = 0; i < 10; ++i) shares.serve("busy", 100);
  EXPECT_EQ(shares.spent("late"), 900u);
}

TEST(Budget, OctetsAreTakenInAllAccountsOrInNone) {
  const auto all = std::make_shared<OctetAccount>(100, nullptr);
  const auto one = std::make_shared<OctetAccount>(80, all);
  const auto other = std::make_shared<OctetAccount>(80, all);
  HeldOctets held(one);
  EXPECT_TRUE(held.add(70));
  EXPECT_FALSE(held.add(11));
  HeldOctets of_other(other);
  EXPECT_FALSE(of_other.add(31));
  EXPECT_EQ(std::tuple(all->held(), one->held(), other->held()), std::tuple(70u, 70u, 0u));
  held = HeldOctets();
  EXPECT_TRUE(of_other.add(80));
  of_other.remove(10);
  EXPECT_EQ(all->held(), 70u);
}

TEST(Budget, WhatIsHeldGoesAlongWithItsAccount) {
  const auto all = std::make_shared<OctetAccount>(100, nullptr);
  const auto first = std::make_shared<OctetAccount>(50, all);
  const auto second = std::make_shared<OctetAccount>(50, all);
  const auto moving = std::make_shared<OctetAccount>(50, first);
  HeldOctets held(moving);
  ASSERT_TRUE(held.add(40));
  moving->move_below(second);
  EXPECT_EQ(std::tuple(first->held(), second->held(), all->held()), std::tuple(0u, 40u, 40u));
  held = HeldOctets();
  EXPECT_EQ(std::tuple(second->held(), all->held()), std::tuple(0u, 0u));
}

Place place(const std::string& account, int rank, std::int64_t since_ms, bool is_left = false, int progress = 0) {
  return {account, rank, progress, is_left, at_ms(since_ms)};
}

TEST(Places, WhatWasLeftGoesFirst) {
  const std::vector<Place> places = {place("anonymous", 0, 0), place("operator", 2, 5, true), place("observer", 1, 1)};
  EXPECT_EQ(place_to_give(places, {"new", 2}), 1u);
  EXPECT_EQ(place_to_give(places, {"new", 0}), 1u);
}

TEST(Places, LessRankThenWhoHasMostThenTheOldest) {
  const std::vector<Place> places = {place("a", 1, 0), place("b", 1, 3), place("b", 1, 2), place("c", 2, 1)};
  EXPECT_EQ(place_to_give(places, {"operator", 2}), 2u);
}

TEST(Places, OneRankSharesEvenly) {
  const std::vector<Place> places = {place("many", 1, 0), place("many", 1, 1), place("many", 1, 2), place("few", 1, 3)};
  EXPECT_EQ(place_to_give(places, {"few", 1}), 0u);  // 3 and 1 become 2 and 2
  EXPECT_EQ(place_to_give({place("many", 1, 0), place("many", 1, 1)}, {"many", 1}), std::nullopt);
  EXPECT_EQ(place_to_give({place("a", 1, 0), place("b", 1, 1)}, {"c", 1}),
            std::nullopt);  // one each: nobody has too many
  EXPECT_EQ(place_to_give({place("operator", 2, 0)}, {"observer", 1}), std::nullopt);
}

TEST(Places, WithinAnAccountWhoHasComeLeastFarGoes) {
  EXPECT_EQ(place_to_give({place("host", 0, 0, false, 4), place("host", 0, 1, false, 0), place("host", 0, 2, false, 0)},
                          {"host", 1}),
            1u);
}

}  // namespace
}  // namespace takt::opcua
