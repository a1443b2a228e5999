// SPDX-License-Identifier: Apache-2.0
// The values of which messages are made: ids, numbers, sets, times, ports.
#include <gtest/gtest.h>

#include "dds/message/fragments.hpp"
#include "dds/message/submessage.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;

TEST(Guid, TellsWhatAnEntityIs) {
  const EntityId writer = EntityId::user(0x123456, EntityKind::writer_no_key);
  EXPECT_EQ(writer.value, 0x12345603u);
  EXPECT_EQ(writer.key(), 0x123456u);
  EXPECT_TRUE(writer.is_writer());
  EXPECT_FALSE(writer.has_key());
  EXPECT_FALSE(writer.is_built_in());
  EXPECT_TRUE(entity_id::sedp_publications_reader.is_built_in());
  EXPECT_TRUE(entity_id::sedp_publications_reader.is_reader());
  EXPECT_TRUE(entity_id::spdp_writer.has_key());
  EXPECT_EQ(to_string(Guid{{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}}, entity_id::participant}),
            "01020304.05060708.090a0b0c|000001c1");
}

TEST(NumberSet, HoldsBaseAnd255More) {
  SequenceNumberSet set(SequenceNumber{10});
  EXPECT_TRUE(set.is_empty());
  EXPECT_EQ(set.bit_count(), 0u);
  EXPECT_TRUE(set.insert({10}));
  EXPECT_TRUE(set.insert({265}));
  EXPECT_FALSE(set.insert({9}));
  EXPECT_FALSE(set.insert({266}));
  EXPECT_EQ(set.bit_count(), 256u);
  EXPECT_EQ(set.count(), 2u);
  EXPECT_EQ(set.greatest(), SequenceNumber{265});
  EXPECT_EQ(set.word(0), 0x8000'0000u);
  EXPECT_EQ(set.word(7), 1u);
  std::vector<std::int64_t> members;
  set.for_each([&](SequenceNumber number) { members.push_back(number.value); });
  EXPECT_EQ(members, (std::vector<std::int64_t>{10, 265}));
  // Bits behind numBits are nobody's.
  EXPECT_EQ(SequenceNumberSet({1}, 33, {0, 0xFFFF'FFFFU}).count(), 1u);
}

// 1 ms is 4294967.296 fractions, so 4294967 is sent: 0.999999931 ms, which is 1 ms in whole nanoseconds.
TEST(Time, KeepsWholeNanoseconds) {
  EXPECT_EQ(Duration::from(1_ms), (Duration{0, 4294967}));
  EXPECT_EQ(Duration::from(1_ms).to_sim(), 1_ms);
  EXPECT_EQ(Duration::from(100_ms), (Duration{0, 429496730}));
  for (std::int64_t ns = 0; ns < 3'000'000'000; ns += 7'654'321) {
    const auto duration = sim::Duration::from_ps(ns * 1000);
    ASSERT_EQ(Duration::from(duration).to_sim(), duration);
    ASSERT_EQ(Duration::from(-duration).to_sim(), -duration);
  }
  // What is nearer to the next second than to the last fraction.
  EXPECT_EQ(Duration::from(sim::Duration::from_ps(999'999'999'999)), (Duration{1, 0}));
  EXPECT_EQ(Time::from(sim::LocalTime::from_ps(-500'000'000'000)), (Time{-1, 0x8000'0000U}));
}

TEST(Time, EndsAtInfinity) {
  EXPECT_TRUE(Duration::from(infinite).is_infinite());
  EXPECT_EQ(Duration::infinite().to_sim(), infinite);
  EXPECT_EQ((Duration{100'000'000, 0}).to_sim(), infinite) << "three years are beyond the simulation";
  EXPECT_EQ(Time::from(sim::LocalTime::never()).to_local(), sim::LocalTime::never());
  EXPECT_EQ((Time{1'700'000'000, 0}).to_local(), sim::LocalTime::never()) << "a clock that counts from 1970";
  EXPECT_TRUE((Time{-1, 0xFFFF'FFFFU}).is_invalid());
}

TEST(Ports, AreThoseOfTheTable) {
  EXPECT_EQ(ports_of(0, 0), (Ports{7400, 7410, 7401, 7411}));
  EXPECT_EQ(ports_of(0, 1), (Ports{7400, 7412, 7401, 7413}));
  EXPECT_EQ(ports_of(1, 0), (Ports{7650, 7660, 7651, 7661}));
}

TEST(Ports, EndWhereTheNextDomainBegins) {
  EXPECT_EQ(port_problem(0, 119), "") << "11 + 2 * 119 = 249";
  EXPECT_EQ(port_problem(0, 120), "domain 0, participant 120: port 7651 belongs to domain 1");
  EXPECT_EQ(port_problem(232, 0), "");
  EXPECT_EQ(port_problem(232, 62), "") << "7400 + 250 * 232 + 11 + 124 = 65535";
  EXPECT_EQ(port_problem(232, 63), "domain 232, participant 63: port 65537 is above 65535");
  EXPECT_EQ(port_problem(4'000'000'000, 0), "domain 4000000000, participant 0: port 1000000007411 is above 65535");
  EXPECT_THROW(ports_of(233, 0), sim::InvariantBroken);
}

TEST(Locator, KnowsMulticast) {
  const Locator group = Locator::udp_v4(discovery_group, 7400);
  EXPECT_EQ(to_string(group), "udp/239.255.0.1:7400");
  EXPECT_TRUE(group.is_multicast());
  EXPECT_FALSE(Locator::udp_v4(0x0A000001, 7410).is_multicast());
  EXPECT_EQ(Locator::udp_v4({10, 0, 0, 1}, 1), Locator::udp_v4(0x0A000001, 1));
}

TEST(Fragments, AreOfOneSizeButTheLast) {
  EXPECT_EQ(fragment_count(1000, 400), 3u);
  EXPECT_EQ(fragment_count(800, 400), 2u);
  const std::vector<std::byte> sample(1000);
  const DataFrag last = fragments_of(sample, {3}, 1, 400);
  EXPECT_EQ(last.payload.size(), 200u);
  EXPECT_EQ(last.payload.data(), sample.data() + 800);
  EXPECT_EQ(fragments_of(sample, {1}, 2, 400).payload.size(), 800u);
  EXPECT_THROW(fragments_of(sample, {3}, 2, 400), sim::InvariantBroken);
}

}  // namespace
}  // namespace takt::dds
