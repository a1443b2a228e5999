// SPDX-License-Identifier: Apache-2.0
// Splitting and recovery with their timers, and the stacks of hosts.
#include <gtest/gtest.h>

#include <vector>

#include "models/frer/host_redundancy.hpp"

namespace takt::models {
namespace {

using namespace sim::literals;
using sim::Duration;
using sim::LocalTime;

constexpr AddressIndex compound{10};
constexpr AddressIndex member_a{11};
constexpr AddressIndex member_b{12};

struct Bench {
  Bench() {
    Stream stream;
    stream.destination = compound;
    index = traffic.add_stream(std::move(stream));
  }
  FrameIndex member(AddressIndex address, SequenceNumber number) {
    const FrameIndex frame = traffic.produce(index, Octets{100}, sim::TrueTime());
    traffic.frame(frame).destination = address;
    traffic.frame(frame).r_tag_sequence = number;
    traffic.set_tags(frame, false, true);
    return frame;
  }
  Traffic traffic;
  StreamIndex index;
};

StreamRecoveryConfig recovery_config(Duration reset_timeout = 10_ms) {
  StreamRecoveryConfig config;
  config.members = {{member_a, 0, 0}, {member_b, 0, 0}};
  config.destination = compound;
  config.reset_timeout = reset_timeout;
  return config;
}

bool receive(Bench& bench, StreamRecovery& recovery, AddressIndex address, SequenceNumber number, Duration when) {
  const FrameIndex frame = bench.member(address, number);
  const auto passed = recovery.receive(bench.traffic, frame, recovery.member_of(address, 0), 0, LocalTime() + when);
  bench.traffic.release(passed.value_or(frame));
  return passed.has_value();
}

// A sender restarts and counts from 0 again. Until the time-out its numbers are rogues; the time-out counts from the
// last frame that passed, and at its very instant any number is taken.
TEST(StreamRecovery, TheResetTimerRunsOutWithoutAnEvent) {
  Bench bench;
  StreamRecovery recovery(recovery_config());
  EXPECT_TRUE(receive(bench, recovery, member_a, 500, 1_ms));
  EXPECT_FALSE(receive(bench, recovery, member_a, 0, 2_ms));
  EXPECT_FALSE(receive(bench, recovery, member_a, 1, 10'999'999_ns));
  EXPECT_EQ(recovery.counters().resets, 1u);
  EXPECT_TRUE(receive(bench, recovery, member_a, 2, 11_ms));
  EXPECT_EQ(recovery.counters().resets, 2u);
  EXPECT_EQ(recovery.counters().rogue_packets, 2u);
}

TEST(StreamRecovery, AResetThatNoFrameFollowsIsCountedToo) {
  Bench bench;
  StreamRecovery recovery(recovery_config());
  EXPECT_TRUE(receive(bench, recovery, member_a, 0, 1_ms));
  recovery.catch_up(LocalTime() + 10_ms);
  EXPECT_EQ(recovery.counters().resets, 1u);
  recovery.catch_up(LocalTime() + 11_ms);
  recovery.catch_up(LocalTime() + 100_ms);
  EXPECT_EQ(recovery.counters().resets, 2u);  // it does not run again before a frame passes
}

// Both paths until 5.5 s, then one. Tests at 2 and 4 s find nothing (the first follows the reset at the start, which
// tells nothing); at 6 s four copies are missing (the frame of that instant comes after the test). Latent errors are
// forgiven at 30 s: then the difference starts anew.
TEST(StreamRecovery, LatentErrorsAreFound) {
  Bench bench;
  StreamRecoveryConfig config = recovery_config();
  config.latent_error_detection = LatentErrorDetectionConfig{2, 3, 2_s, 30_s};
  config.reset_timeout = 1_s;
  StreamRecovery recovery(config);
  SequenceNumber number = 0;
  for (Duration t = 100_ms; t <= 6'100_ms; t += 100_ms, ++number) {
    EXPECT_TRUE(receive(bench, recovery, member_a, number, t));
    if (t <= 5'500_ms) {
      EXPECT_FALSE(receive(bench, recovery, member_b, number, t));
    }
  }
  ASSERT_NE(recovery.latent_error_detection(), nullptr);
  EXPECT_EQ(recovery.latent_error_detection()->errors(), 1u);
  EXPECT_EQ(recovery.first_latent_error(), LocalTime() + 6_s);
  EXPECT_EQ(recovery.latent_error_detection()->resets(), 0u);
  recovery.catch_up(LocalTime() + 30_s);
  EXPECT_EQ(recovery.latent_error_detection()->resets(), 1u);
}

// A test at the instant of a frame comes before the frame, whatever asks first.
TEST(StreamRecovery, AnswersDoNotDependOnWhenTheyAreAsked) {
  const auto run = [](bool asks_often) {
    Bench bench;
    StreamRecoveryConfig config = recovery_config(3_ms);
    config.latent_error_detection = LatentErrorDetectionConfig{2, 0, 5_ms, 50_ms};
    StreamRecovery recovery(config);
    for (int i = 0; i < 400; ++i) {
      const Duration t = 1_ms * i;
      if (asks_often)
        for (int k = 1; k <= 10; ++k) recovery.catch_up(LocalTime() + t - 1_ms + 100_us * k);
      if (i % 37 < 30) receive(bench, recovery, member_a, static_cast<SequenceNumber>(i), t);
      if (i % 37 < 20) receive(bench, recovery, member_b, static_cast<SequenceNumber>(i), t);
    }
    recovery.catch_up(LocalTime() + 500_ms);
    return std::tuple(recovery.counters().passed_packets, recovery.counters().discarded_packets,
                      recovery.counters().resets, recovery.latent_error_detection()->errors(),
                      recovery.latent_error_detection()->resets(), recovery.first_latent_error());
  };
  EXPECT_EQ(run(false), run(true));
  EXPECT_EQ(std::get<2>(run(false)),
            12u);  // at the start, in each of the ten gaps that end before 400 ms, and at the end
}

TEST(HostRedundancy, ATalkerSplitsItsStreamsOverItsInterfaces) {
  Bench bench;
  Stream plain;
  plain.destination = AddressIndex{3};
  const StreamIndex other = bench.traffic.add_stream(std::move(plain));
  TalkerRedundancy talker;
  EXPECT_TRUE(talker.is_empty());
  talker.add(bench.index, {{{member_a, 0, 0}, {member_b, 0, 1}}});
  EXPECT_FALSE(talker.is_empty());

  EXPECT_EQ(talker.find(other), nullptr);

  const auto two = talker.send(bench.traffic, bench.traffic.produce(bench.index, Octets{100}, sim::TrueTime()));
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].port, 0);
  EXPECT_EQ(two[1].port, 1);
  EXPECT_EQ(bench.traffic.frame(two[0].frame).destination, member_a);
  EXPECT_EQ(bench.traffic.frame(two[1].frame).destination, member_b);
  EXPECT_EQ(bench.traffic.frame(two[1].frame).length, 14 + 6 + 100 + 4);
  EXPECT_EQ(bench.traffic.stream(bench.index).copies, 1u);
}

// Another copy of the frame, which shares its record, stays as it is.
TEST(HostRedundancy, MembersOfASharedFrameAreRecordsOfTheirOwn) {
  Bench bench;
  StreamSplit split({{{member_a, 0, 0}, {member_b, 0, 1}}});
  const FrameIndex shared = bench.traffic.produce(bench.index, Octets{100}, sim::TrueTime());
  bench.traffic.copy(shared);
  const auto members = split.split(bench.traffic, shared);
  ASSERT_EQ(members.size(), 2u);
  for (const FrameIndex member : members) {
    EXPECT_NE(member, shared);
    EXPECT_TRUE(bench.traffic.frame(member).r_tagged);
    EXPECT_EQ(bench.traffic.frame(member).r_tag_sequence, 0);
    EXPECT_EQ(bench.traffic.frame(member).length, 14 + 6 + 100 + 4);
  }
  EXPECT_FALSE(bench.traffic.frame(shared).r_tagged);
  EXPECT_EQ(bench.traffic.frame(shared).length, 14 + 100 + 4);
  EXPECT_EQ(bench.traffic.frame(shared).destination, compound);
}

// Few streams are gone through, many searched.
TEST(HostRedundancy, FindsItsStreamAmongFewAndMany) {
  Bench bench;
  TalkerRedundancy talker;
  ListenerRedundancy listener;
  std::vector<StreamIndex> added;
  for (int i = 0; i < 12; ++i) {
    const StreamIndex stream = bench.traffic.add_stream(Stream{});
    EXPECT_TRUE(talker.send(bench.traffic, bench.traffic.produce(stream, Octets{100}, sim::TrueTime()))
                    .empty());  // not split here
    EXPECT_EQ(talker.find(stream), nullptr);
    EXPECT_EQ(listener.find(stream), nullptr);
    if (i % 3 == 2) continue;
    talker.add(stream, {{{AddressIndex{100 + stream.value}, 0, 0}}});
    listener.add(stream, recovery_config());
    added.push_back(stream);
    for (const StreamIndex one : added) {
      ASSERT_NE(talker.find(one), nullptr);
      EXPECT_EQ(talker.find(one)->config().members[0].destination.value, 100 + one.value);
      EXPECT_NE(listener.find(one), nullptr);
      EXPECT_EQ(talker.send(bench.traffic, bench.traffic.produce(one, Octets{100}, sim::TrueTime())).size(), 1u);
    }
  }
}

TEST(HostRedundancy, AListenerTakesEachNumberOnce) {
  Bench bench;
  ListenerRedundancy listener;
  listener.add(bench.index, recovery_config());
  const auto passes = [&](FrameIndex frame, std::uint16_t port) {
    const auto passed = listener.receive(bench.traffic, frame, port, LocalTime() + 1_us);
    if (passed) {
      EXPECT_EQ(bench.traffic.frame(*passed).destination, compound);
      EXPECT_FALSE(bench.traffic.frame(*passed).r_tagged);
    }
    return passed.has_value();
  };
  EXPECT_TRUE(passes(bench.member(member_a, 0), 0));
  EXPECT_FALSE(passes(bench.member(member_b, 0), 1));
  EXPECT_TRUE(passes(bench.member(member_b, 1), 1));
  EXPECT_FALSE(passes(bench.member(member_a, 1), 0));
  std::uint64_t passed = 0;
  listener.for_each(LocalTime() + 2_us, [&](StreamIndex stream, const StreamRecovery& recovery) {
    EXPECT_EQ(stream, bench.index);
    passed += recovery.counters().passed_packets;
  });
  EXPECT_EQ(passed, 2u);
}

}  // namespace
}  // namespace takt::models
