// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/ptp_instance.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace takt::models::gptp::ptp_instance_test {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;

LocalTime local(Duration d) { return LocalTime() + d; }
ClockIdentity clock(std::uint64_t n) { return ClockIdentity::from_number(n); }

template <class Kind>
std::vector<Kind> all(const Outputs& outputs) {
  std::vector<Kind> found;
  for (const Output& output : outputs)
    if (const auto* const one = std::get_if<Kind>(&output)) found.push_back(*one);
  return found;
}
template <class Body>
std::vector<std::pair<PortNumber, Body>> sent(const Outputs& outputs) {
  std::vector<std::pair<PortNumber, Body>> found;
  for (const SendMessage& send : all<SendMessage>(outputs))
    if (const auto* const body = std::get_if<Body>(&send.message)) found.push_back({send.port, *body});
  return found;
}
std::optional<LocalTime> armed(const Outputs& outputs, PortNumber port, TimerPurpose purpose) {
  std::optional<LocalTime> at;
  for (const ArmTimer& arm : all<ArmTimer>(outputs))
    if (arm.timer.port == port && arm.timer.purpose == purpose) at = arm.at;
  return at;
}

/// Instance 50 with three ports, all with capable neighbours.
struct Bridge {
  explicit Bridge(InstanceConfig config = {}) : instance(with_clock(config), 0, 3) {
    instance.start(now, outputs);
    for (PortNumber port = 1; port <= 3; ++port) instance.set_port_capable(port, true, now, outputs);
  }
  static InstanceConfig with_clock(InstanceConfig config) {
    config.system.clock = clock(50);
    return config;
  }
  static Announce announce(std::uint8_t priority1, std::uint64_t root, std::uint16_t steps, std::uint64_t source) {
    Announce a;
    a.header.source = {clock(source), 1};
    a.header.log_message_interval = 0;
    a.grandmaster_priority1 = priority1;
    a.grandmaster = clock(root);
    a.steps_removed = steps;
    a.path_trace = {clock(root)};
    return a;
  }
  void hears(PortNumber port, const Announce& message) {
    outputs.clear();
    instance.received(message, port, now, outputs);
  }
  /// A two-step Sync from `source` with its Follow_Up, over a link without delay.
  void sync(PortNumber port, std::uint64_t source, std::uint16_t sequence = 1) {
    outputs.clear();
    Sync s;
    s.header.source = {clock(source), 1};
    s.header.sequence_id = sequence;
    s.header.log_message_interval = -3;
    instance.received(s, port, now, {0_ns, ClockRate::one()}, now, outputs);
    FollowUp f;
    f.header = s.header;
    f.precise_origin = {7, 0};
    instance.received(f, port, now, outputs);
  }
  LocalTime now = local(10_s);
  Outputs outputs;
  PtpInstance instance;
};

TEST(PtpInstance, AloneItAnnouncesItself) {
  Bridge bridge;
  const auto announces = sent<Announce>(bridge.outputs);
  ASSERT_EQ(announces.size(), 3u);
  EXPECT_EQ(announces[0].second.grandmaster, clock(50));
  EXPECT_EQ(announces[0].second.steps_removed, 0);
  EXPECT_EQ(announces[0].second.path_trace, std::vector<ClockIdentity>{clock(50)});
  EXPECT_EQ(armed(bridge.outputs, 1, TimerPurpose::announce_interval), bridge.now + 1_s);
  EXPECT_EQ(armed(bridge.outputs, 0, TimerPurpose::sync_interval), bridge.now + 125_ms);
}

TEST(PtpInstance, GivesTimeAsGrandmaster) {
  Bridge bridge;
  bridge.outputs.clear();
  bridge.instance.set_source_time({bridge.now, sim::PtpTime() + 100_s, ClockRate::one()});
  bridge.instance.timer_expired(0, TimerPurpose::sync_interval, bridge.now += 125_ms, bridge.outputs);
  const auto syncs = sent<Sync>(bridge.outputs);
  ASSERT_EQ(syncs.size(), 3u);
  bridge.outputs.clear();
  bridge.instance.transmitted({2, MessageType::sync, 0, syncs[1].second.header.sequence_id, bridge.now + 1_us + 250_ps},
                              bridge.outputs);
  const auto follow_ups = sent<FollowUp>(bridge.outputs);
  ASSERT_EQ(follow_ups.size(), 1u);
  EXPECT_EQ(follow_ups[0].second.precise_origin, (Timestamp{100, 125'001'000}));
  EXPECT_EQ(follow_ups[0].second.header.correction.scaled_ns, 16'384);
  EXPECT_EQ(follow_ups[0].second.information.cumulative_scaled_rate_offset, 0);
}

TEST(PtpInstance, FollowsABetterOneAndHandsItOnAtOnce) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 2, 30));
  EXPECT_EQ(bridge.instance.role(1), PortRole::time_receiver);
  EXPECT_EQ(bridge.instance.grandmaster().steps_removed, 3);
  const auto announces = sent<Announce>(bridge.outputs);
  ASSERT_EQ(announces.size(), 2u);
  EXPECT_EQ(announces[0].first, 2);
  EXPECT_EQ(announces[0].second.grandmaster, clock(9));
  EXPECT_EQ(announces[0].second.steps_removed, 3);
  EXPECT_EQ(announces[0].second.path_trace, (std::vector<ClockIdentity>{clock(9), clock(50)}));
  EXPECT_EQ(armed(bridge.outputs, 1, TimerPurpose::announce_receipt), bridge.now + 3_s);
  EXPECT_EQ(armed(bridge.outputs, 1, TimerPurpose::sync_receipt), bridge.now + 375_ms);
  bridge.hears(1, Bridge::announce(100, 9, 2, 30));
  EXPECT_TRUE(sent<Announce>(bridge.outputs).empty()) << "repeated";
}

TEST(PtpInstance, UnqualifiedAnnouncesAreIgnored) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 2, 50));  // from itself
  bridge.hears(1, Bridge::announce(100, 9, 255, 30));
  Announce loop = Bridge::announce(100, 9, 2, 30);
  loop.path_trace.push_back(clock(50));
  bridge.hears(1, loop);
  EXPECT_TRUE(bridge.instance.is_grandmaster());
}

TEST(PtpInstance, TheSameSenderMayBecomeWorse) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 2, 30));
  bridge.hears(1, Bridge::announce(249, 9, 2, 30));
  EXPECT_TRUE(bridge.instance.is_grandmaster());
  EXPECT_EQ(bridge.instance.role(1), PortRole::time_transmitter);
  EXPECT_EQ(sent<Announce>(bridge.outputs).size(), 3u);
}

TEST(PtpInstance, AnnounceReceiptTimeout) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 2, 30));
  bridge.outputs.clear();
  bridge.instance.timer_expired(1, TimerPurpose::announce_receipt, bridge.now += 3_s, bridge.outputs);
  EXPECT_TRUE(bridge.instance.is_grandmaster());
}

InstanceConfig never_grandmaster() {
  InstanceConfig config;
  config.system.priority1 = 255;
  return config;
}

// PortAnnounceTransmit (10.3.16) does not ask whether there is a grandmaster: those behind the bridge must hear that
// theirs is gone.
TEST(PtpInstance, ARootThatCannotBeGrandmasterAnnouncesItselfAndSendsNoSync) {
  Bridge bridge(never_grandmaster());
  bridge.hears(1, Bridge::announce(100, 9, 2, 30));
  bridge.outputs.clear();
  bridge.instance.timer_expired(1, TimerPurpose::announce_receipt, bridge.now += 3_s, bridge.outputs);
  const auto announces = sent<Announce>(bridge.outputs);
  ASSERT_EQ(announces.size(), 3u);
  EXPECT_EQ(announces[0].second.grandmaster, clock(50));
  EXPECT_EQ(announces[0].second.grandmaster_priority1, 255);
  EXPECT_TRUE(sent<Sync>(bridge.outputs).empty());
}

// PortAnnounceInformation (10.3.12): Sync is late only while a grandmaster is present.
TEST(PtpInstance, BelowARootThatCannotBeGrandmasterNoSyncIsExpected) {
  Bridge bridge(never_grandmaster());
  bridge.hears(1, Bridge::announce(255, 9, 2, 30));
  EXPECT_EQ(bridge.instance.role(1), PortRole::time_receiver);
  EXPECT_EQ(armed(bridge.outputs, 1, TimerPurpose::sync_receipt), std::nullopt);
  bridge.hears(1, Bridge::announce(100, 8, 2, 30));
  EXPECT_EQ(armed(bridge.outputs, 1, TimerPurpose::sync_receipt), bridge.now + 375_ms);
  bridge.sync(1, 30);
  bridge.hears(1, Bridge::announce(255, 9, 2, 30));  // its grandmaster is gone
  EXPECT_EQ(all<SyncLost>(bridge.outputs).size(), 1u);
  const auto cancelled = all<CancelTimer>(bridge.outputs);
  EXPECT_TRUE(std::any_of(cancelled.begin(), cancelled.end(), [](const CancelTimer& each) {
    return each.timer.port == 1 && each.timer.purpose == TimerPurpose::sync_receipt;
  }));
}

TEST(PtpInstance, RelaysASyncAtOnce) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 0, 9));
  bridge.sync(1, 9);
  ASSERT_EQ(all<SyncSample>(bridge.outputs).size(), 1u);
  EXPECT_EQ(all<SyncSample>(bridge.outputs)[0].grandmaster_time, sim::PtpTime() + 7_s);
  EXPECT_EQ(all<SyncSample>(bridge.outputs)[0].grandmaster, clock(9));
  const auto syncs = sent<Sync>(bridge.outputs);
  ASSERT_EQ(syncs.size(), 2u);
  bridge.outputs.clear();
  bridge.instance.transmitted({3, MessageType::sync, 0, syncs[1].second.header.sequence_id, bridge.now + 4_us},
                              bridge.outputs);
  const auto follow_ups = sent<FollowUp>(bridge.outputs);
  ASSERT_EQ(follow_ups.size(), 1u);
  EXPECT_EQ(follow_ups[0].second.precise_origin, (Timestamp{7, 0}));
  EXPECT_EQ(follow_ups[0].second.header.correction.duration(), 4_us);
}

TEST(PtpInstance, OneStepSyncIsPatchedAsItLeaves) {
  Bridge bridge({.two_step = false});
  bridge.hears(1, Bridge::announce(100, 9, 0, 9));
  bridge.sync(1, 9);
  SendMessage send = all<SendMessage>(bridge.outputs).at(0);
  ASSERT_TRUE(send.one_step.has_value());
  send.one_step->apply(send.message, bridge.now + 4_us);
  const Sync& sync = std::get<Sync>(send.message);
  ASSERT_TRUE(sync.one_step.has_value());
  EXPECT_EQ(sync.one_step->origin, (Timestamp{7, 0}));
  EXPECT_EQ(sync.header.correction.duration(), 4_us);
}

TEST(PtpInstance, SyncFromOthersIsIgnored) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 0, 9));
  bridge.sync(2, 9);
  EXPECT_TRUE(bridge.outputs.empty()) << "a port that is time transmitter";
  bridge.sync(1, 8);
  EXPECT_TRUE(bridge.outputs.empty()) << "not the one that announces";
}

TEST(PtpInstance, FollowUpWithoutItsSyncIsIgnored) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 0, 9));
  bridge.outputs.clear();
  FollowUp stray;
  stray.header.source = {clock(9), 1};
  bridge.instance.received(stray, 1, bridge.now, bridge.outputs);
  EXPECT_TRUE(bridge.outputs.empty());
}

TEST(PtpInstance, AFollowUpBehindTheAnnounceOfAnotherGrandmasterIsIgnored) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 0, 9));
  Sync sync;
  sync.header.source = {clock(9), 1};
  sync.header.sequence_id = 1;
  sync.header.log_message_interval = -3;
  bridge.instance.received(sync, 1, bridge.now, {0_ns, ClockRate::one()}, bridge.now, bridge.outputs);
  bridge.hears(1, Bridge::announce(90, 8, 1, 9));
  bridge.outputs.clear();
  FollowUp follow_up;
  follow_up.header = sync.header;
  follow_up.precise_origin = {7, 0};
  bridge.instance.received(follow_up, 1, bridge.now, bridge.outputs);
  EXPECT_TRUE(all<SyncSample>(bridge.outputs).empty()) << "the time of 9 as if it were that of 8";
  bridge.sync(1, 9, 2);
  ASSERT_EQ(all<SyncSample>(bridge.outputs).size(), 1u);
  EXPECT_EQ(all<SyncSample>(bridge.outputs)[0].grandmaster, clock(8));
}

TEST(PtpInstance, TellsNoTimeOfAFormerGrandmaster) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 0, 9));
  bridge.sync(1, 9);
  const auto syncs = sent<Sync>(bridge.outputs);
  ASSERT_EQ(syncs.size(), 2u);
  bridge.hears(1, Bridge::announce(90, 8, 1, 9));
  bridge.outputs.clear();
  bridge.instance.transmitted({3, MessageType::sync, 0, syncs[1].second.header.sequence_id, bridge.now + 4_us},
                              bridge.outputs);
  EXPECT_TRUE(sent<FollowUp>(bridge.outputs).empty());
}

TEST(PtpInstance, SyncReceiptTimeoutAndHoldoverAsGrandmaster) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 0, 9));
  bridge.sync(1, 9);
  EXPECT_EQ(armed(bridge.outputs, 1, TimerPurpose::sync_receipt), bridge.now + 375_ms);
  bridge.outputs.clear();
  bridge.instance.timer_expired(1, TimerPurpose::sync_receipt, bridge.now += 375_ms, bridge.outputs);
  EXPECT_EQ(all<SyncLost>(bridge.outputs).size(), 1u);
  EXPECT_TRUE(bridge.instance.is_grandmaster());
  EXPECT_EQ(bridge.instance.source_time().time_at(bridge.now), sim::PtpTime() + 7_s + 375_ms);
  EXPECT_EQ(sent<Sync>(bridge.outputs).size(), 3u) << "at once, at all ports";
}

TEST(PtpInstance, HostileNumbersAreRefused) {
  Bridge bridge;
  bridge.hears(1, Bridge::announce(100, 9, 0, 9));
  for (const Timestamp& origin : {Timestamp{std::uint64_t{1} << 47, 0}, Timestamp{9'000'000, 0}}) {
    Sync s{{.source = {clock(9), 1}}, Sync::OneStep{origin, {}}};
    bridge.outputs.clear();
    bridge.instance.received(s, 1, bridge.now, {0_ns, ClockRate::one()}, bridge.now, bridge.outputs);
    EXPECT_TRUE(bridge.outputs.empty());
  }
  Sync s{{.correction = {INT64_MIN}, .source = {clock(9), 1}}, Sync::OneStep{}};
  bridge.instance.received(s, 1, bridge.now, {0_ns, ClockRate::one()}, bridge.now, bridge.outputs);
  EXPECT_TRUE(bridge.outputs.empty());
}

}  // namespace
}  // namespace takt::models::gptp::ptp_instance_test
