// SPDX-License-Identifier: Apache-2.0
// What the digest of a run covers: runs that differ in anything that a frame does differ in their digest, even where
// the rest is the same to the picosecond. Minimum frames at 1 Gb/s occupy the medium for 672 ns.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "tests/models/network_fixture.hpp"

namespace takt::models::run_digest_test {
namespace {

using namespace test;

struct Outcome {
  std::uint64_t digest = 0;
  std::vector<sim::TraceRecord> received;
  std::vector<sim::TraceRecord> drops;
};

/// The sequence of frames that are sent over a direct link at these times.
Outcome send(const std::vector<Duration>& times, const StreamOptions& options = {}, QueueLimit limit = {},
             Octets payload = 8_B, Duration end = 1_ms) {
  Line line(0, 1_Gbps, 0_ns);
  line.builder.plan.port_configs[0].queue_limits.fill(limit);
  const StreamIndex stream = line.builder.stream(line.talker, {line.listener}, options);
  line.builder.send_at(stream, payload, times);
  NetworkRun run(line.builder.plan);
  TraceLog trace;
  run.simulation.set_trace(&trace);
  run.until(end);
  return {run.digest(), trace.of(Occurrence::received), trace.of(Occurrence::drop)};
}

void expect_same_arrivals(const Outcome& one, const Outcome& other) {
  ASSERT_EQ(one.received.size(), other.received.size());
  for (std::size_t i = 0; i < one.received.size(); ++i) EXPECT_EQ(one.received[i].time, other.received[i].time);
}

TEST(RunDigest, IsTheSameForTheSame) { EXPECT_EQ(send({0_ns, 1_us}).digest, send({0_ns, 1_us}).digest); }

// The second frame waits for the first until 672 ns whenever it was handed over: it arrives at the same time, but is
// not as old.
TEST(RunDigest, CoversLatency) {
  const Outcome early = send({0_ns, 100_ns});
  const Outcome late = send({0_ns, 200_ns});
  expect_same_arrivals(early, late);
  EXPECT_NE(early.digest, late.digest);
}

// Neither frame arrives before the end.
TEST(RunDigest, CoversProductionsThatArriveNowhere) {
  std::set<std::uint64_t> digests;
  for (const std::vector<Duration>& times : {std::vector<Duration>{}, {900_ns}, {901_ns}, {900_ns, 900_ns}}) {
    const Outcome outcome = send(times, {}, {}, 8_B, 1_us);
    EXPECT_TRUE(outcome.received.empty());
    digests.insert(outcome.digest);
  }
  EXPECT_EQ(digests.size(), 4u);
}

// Frames of 8 and of 9 octets are padded to one length on the wire; 47 octets are not.
TEST(RunDigest, CoversTheLengthOfAFrameThatDoesNotArrive) {
  EXPECT_NE(send({900_ns}, {}, {}, 8_B, 1_us).digest, send({900_ns}, {}, {}, 47_B, 1_us).digest);
}

TEST(RunDigest, CoversTheAddressingOfAFrame) {
  const Outcome plain = send({0_ns}, {Priority{5}, 0, Octets{0}});
  const Outcome other_priority = send({0_ns}, {Priority{4}, 0, Octets{0}});
  expect_same_arrivals(plain, other_priority);
  EXPECT_NE(plain.digest, other_priority.digest);
}

// Six frames at once, room for two, counted in frames or in octets: the same are lost at the same time for another
// reason.
TEST(RunDigest, CoversTheReasonOfALoss) {
  const std::vector<Duration> burst(6, 0_ns);
  const Outcome by_frames = send(burst, {}, {2, UINT32_MAX});
  const Outcome by_octets = send(burst, {}, {UINT32_MAX, 128});
  expect_same_arrivals(by_frames, by_octets);
  ASSERT_EQ(by_frames.drops.size(), 3u);
  ASSERT_EQ(by_octets.drops.size(), 3u);
  EXPECT_NE(by_frames.digest, by_octets.digest);
}

TEST(RunDigest, CoversTheAgeOfALoss) {
  std::set<std::uint64_t> digests;
  for (const std::int64_t produced : {0, 1, 2}) {
    sim::Simulation one(1);
    Traffic traffic;
    const StreamIndex stream = traffic.add_stream(Stream{});
    const FrameIndex frame = traffic.produce(stream, 8_B, sim::TrueTime::from_ps(produced));
    traffic.drop(frame, DropReason::link_loss, {}, one);
    digests.insert(one.digest().value());
  }
  EXPECT_EQ(digests.size(), 3u);
}

// Streams that differ in the number they have, in both addresses, in VLAN, priority or tag only.
TEST(RunDigest, ProductionsOfAllStreamsDiffer) {
  std::set<std::uint64_t> keys;
  std::size_t count = 0;
  Traffic traffic;
  for (std::uint32_t source = 0; source < 3; ++source)
    for (std::uint32_t destination = 0; destination < 3; ++destination)
      for (VlanId vlan = 0; vlan < 3; ++vlan)
        for (Priority priority = 0; priority < 3; ++priority)
          for (const bool tagged : {false, true}) {
            const auto stream = [&] {
              Stream made;
              made.source = AddressIndex{source};
              made.destination = AddressIndex{destination};
              made.vlan = vlan;
              made.priority = priority;
              made.tagged = tagged;
              return made;
            };
            Traffic alone;
            keys.insert(alone.stream(alone.add_stream(stream())).production.hash);
            keys.insert(traffic.stream(traffic.add_stream(stream())).production.hash);
            count += 2;
          }
  EXPECT_EQ(keys.size(), count - 1);  // the first of all is the first of its own, too
}

}  // namespace
}  // namespace takt::models::run_digest_test
