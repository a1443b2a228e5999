// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/hot_standby.hpp"

#include <gtest/gtest.h>

namespace takt::models::gptp::hot_standby_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;
constexpr HotStandbyRole primary = HotStandbyRole::primary, secondary = HotStandbyRole::secondary;
LocalTime local(Duration d) { return LocalTime() + d; }

TEST(IsSynced, NeedsEnoughInARowAndForgivesOne) {
  IsSynced synced({.offset_max = 1_us, .met_count = 3, .exceeded_count = 2, .rx_sync_count = 5});
  for (int i = 0; i < 4; ++i) synced.sample(100_ns);
  EXPECT_FALSE(synced.is_synced()) << "four Syncs only";
  synced.sample(-(1_us));
  EXPECT_TRUE(synced.is_synced());
  synced.sample(2_us);
  EXPECT_TRUE(synced.is_synced());
  synced.sample(0_us);
  synced.sample(2_us);
  EXPECT_TRUE(synced.is_synced()) << "not in a row";
  synced.sample(-(2_us));
  EXPECT_FALSE(synced.is_synced());
  for (int i = 0; i < 3; ++i) synced.sample(0_us);
  EXPECT_TRUE(synced.is_synced());
  synced.lost();
  EXPECT_FALSE(synced.is_synced());
}

struct System {
  explicit System(const HotStandbyConfig& config = {}) : standby(config) {}
  /// Syncs of a grandmaster that is `behind` the node's oscillator. The node's clock is that oscillator.
  void feed(HotStandbyRole of, Duration behind = {}, int count = 4) {
    for (int i = 0; i < count; ++i) {
      now += 125_ms;
      const SyncSample sample{0, now, sim::PtpTime::from_ps(now.ps()) - behind, ClockRate::one()};
      standby.sample(of, sample, now, now);
    }
  }
  /// Both, in turn.
  void feed_both(Duration primary_behind, Duration secondary_behind, int count) {
    for (int i = 0; i < count; ++i) {
      feed(primary, primary_behind, 1);
      feed(secondary, secondary_behind, 1);
    }
  }
  HotStandby standby;
  LocalTime now;
};

TEST(HotStandby, WaitsForBothThenServesFromThePrimary) {
  System s;
  s.feed(secondary);
  EXPECT_EQ(s.standby.state(), HotStandbyState::init);
  s.feed(primary);
  EXPECT_EQ(s.standby.state(), HotStandbyState::redundant);
  EXPECT_EQ(s.standby.active(), primary);
}

TEST(HotStandby, SwitchesOverAndBack) {
  System s;
  s.feed(primary);
  s.feed(secondary);
  s.standby.sync_lost(primary, s.now);
  EXPECT_EQ(s.standby.state(), HotStandbyState::not_redundant);
  EXPECT_EQ(s.standby.active(), secondary);
  s.feed(primary, 50_ns);
  EXPECT_EQ(s.standby.state(), HotStandbyState::redundant);
  EXPECT_EQ(s.standby.active(), primary);
  s.standby.sync_lost(secondary, s.now);
  EXPECT_EQ(s.standby.state(), HotStandbyState::not_redundant);
  EXPECT_EQ(s.standby.active(), primary);
}

TEST(HotStandby, DoesNotCallThemRedundantIfTheyDisagree) {
  System s({.is_synced = {.offset_max = 10_us}, .primary_secondary_offset_thresh = 1_us});
  s.feed_both(0_us, 1'100_ns, 80);  // the servo of 802.1AS intervals has followed by then
  EXPECT_EQ(s.standby.state(), HotStandbyState::not_redundant);
  EXPECT_TRUE(s.standby.is_synced(secondary));
  EXPECT_EQ(s.standby.active(), primary);
  s.feed_both(0_us, 900_ns, 80);
  EXPECT_EQ(s.standby.state(), HotStandbyState::redundant);
  s.feed_both(0_us, 1'100_ns, 80);
  EXPECT_EQ(s.standby.state(), HotStandbyState::not_redundant) << "no longer";
  EXPECT_EQ(s.standby.active(), primary);
  s.standby.sync_lost(primary, s.now);
  EXPECT_EQ(s.standby.active(), secondary) << "better than none";
}

// Time comes from the primary while it is synced, however far the secondary has gone meanwhile.
TEST(HotStandby, ReturnsToAPrimaryThatIsFarFromTheSecondary) {
  System s;
  s.feed(primary);
  s.feed(secondary);
  s.standby.sync_lost(primary, s.now);
  EXPECT_EQ(s.standby.active(), secondary);
  s.feed(secondary, 1'500_ns, 80);
  EXPECT_TRUE(s.standby.is_synced(secondary));
  s.feed(primary, 0_us, 40);
  EXPECT_TRUE(s.standby.is_synced(primary));
  EXPECT_EQ(s.standby.active(), primary);
  EXPECT_EQ(s.standby.state(), HotStandbyState::not_redundant);
}

TEST(HotStandby, OutOfSyncAndBack) {
  System s;
  s.feed(primary);
  s.feed(secondary);
  s.standby.sync_lost(primary, s.now);
  s.standby.sync_lost(secondary, s.now);
  EXPECT_EQ(s.standby.state(), HotStandbyState::out_of_sync);
  s.feed(secondary);
  EXPECT_EQ(s.standby.state(), HotStandbyState::not_redundant);
  EXPECT_EQ(s.standby.active(), secondary);
}

TEST(HotStandby, WaitsBeforeGoingUp) {
  System s({.waiting_time = 2_s});
  s.feed(primary);
  s.feed(secondary);
  EXPECT_EQ(s.standby.state(), HotStandbyState::init);
  const LocalTime until = s.standby.next_evaluation();
  EXPECT_EQ(until, s.now + 2_s);
  s.standby.evaluate(until - 1_ps);
  EXPECT_EQ(s.standby.state(), HotStandbyState::init);
  s.standby.evaluate(until);
  EXPECT_EQ(s.standby.state(), HotStandbyState::redundant);
  EXPECT_EQ(s.standby.next_evaluation(), LocalTime::never());
}

TEST(HotStandby, AGrandmasterIsSyncedWithItself) {
  System s;
  s.standby.set_grandmaster(primary, true, local(1_s));
  s.feed(secondary);
  EXPECT_EQ(s.standby.state(), HotStandbyState::redundant);
}

TEST(HotStandby, TheGrandmasterOfTheSecondaryHasItsOwnTimeUntilThePrimaryIsSynced) {
  System s;
  s.standby.set_grandmaster(secondary, true, local(1_s));
  EXPECT_EQ(s.standby.active(), secondary);
  s.feed(primary, 0_us, 3);
  EXPECT_EQ(s.standby.active(), secondary);
  s.feed(primary, 0_us, 1);
  EXPECT_EQ(s.standby.active(), primary);
}

}  // namespace
}  // namespace takt::models::gptp::hot_standby_test
