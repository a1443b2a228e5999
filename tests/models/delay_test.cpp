// SPDX-License-Identifier: Apache-2.0
// Delays to the picosecond, derived by hand. Latency is counted from production to delivery: the last bit in, plus the
// fixed delays.
#include <gtest/gtest.h>

#include "tests/models/network_fixture.hpp"

namespace takt::models::delay_test {
namespace {

using namespace test;

constexpr DataRate rate_2_5g{2'500'000'000};

/// The latency that all frames of the stream had.
Duration only_latency(const Stream& stream) {
  EXPECT_GT(stream.latency.count(), 0u);
  EXPECT_EQ(stream.latency.minimum(), stream.latency.maximum());
  return stream.latency.minimum();
}

/// One frame of that payload over a line; nothing else is under way.
Duration latency_over(Line line, Octets payload, const StreamOptions& options) {
  const StreamIndex stream = line.builder.stream(line.talker, {line.listener}, options);
  line.builder.send_at(stream, payload, {10_us});
  NetworkRun run(line.builder.plan);
  run.until(1_s);
  EXPECT_EQ(run.stream(stream).sent, 1u);
  EXPECT_EQ(run.stream(stream).delivered, 1u);
  return only_latency(run.stream(stream));
}

// 100 octets of payload, untagged: 14 + 100 + 4 = 118 octets, 126 with preamble; 126 * 8 ns = 1008 ns; cable 50 ns.
TEST(Delay, DirectLink) { EXPECT_EQ(latency_over({0, 1_Gbps, 50_ns}, 100_B, {}), 1'058_ns); }

// Tagged 122, 130 with preamble, at 100 Mb/s 80 ns each: 10.4 us; no cable.
TEST(Delay, DirectLinkTagged) {
  EXPECT_EQ(latency_over({0, 100_Mbps, 0_ns}, 100_B, {Priority{3}, 5, Octets{0}}), 10'400_ns);
}

// A host that sends over a direct link at each rate: 126 octets.
TEST(Delay, DirectLinkAtEveryRate) {
  EXPECT_EQ(latency_over({0, 10_Mbps, 0_ns}, 100_B, {}), 100'800_ns);
  EXPECT_EQ(latency_over({0, 100_Mbps, 0_ns}, 100_B, {}), 10'080_ns);
  EXPECT_EQ(latency_over({0, 1_Gbps, 0_ns}, 100_B, {}), 1'008_ns);
  EXPECT_EQ(latency_over({0, rate_2_5g, 0_ns}, 100_B, {}), 403'200_ps);
  EXPECT_EQ(latency_over({0, 10_Gbps, 0_ns}, 100_B, {}), 100'800_ps);
  EXPECT_EQ(latency_over({0, 100_Gbps, 0_ns}, 100_B, {}), 10'080_ps);
}

// Store and forward over n bridges: n + 1 times (1008 ns + 50 ns).
TEST(Delay, StoreAndForward) {
  EXPECT_EQ(latency_over({1, 1_Gbps, 50_ns}, 100_B, {}), 2'116_ns);
  EXPECT_EQ(latency_over({2, 1_Gbps, 50_ns}, 100_B, {}), 3'174_ns);
  EXPECT_EQ(latency_over({5, 1_Gbps, 50_ns}, 100_B, {}), 6'348_ns);
}

// Each bridge adds its forwarding delay: 6 * 1058 ns + 5 * 1.5 us.
TEST(Delay, ForwardingDelay) { EXPECT_EQ(latency_over({5, 1_Gbps, 50_ns, 1'500_ns}, 100_B, {}), 13'848_ns); }

// The published validation: 1200 octets of UDP payload untagged over device - switch - switch - device, 1 Gb/s, 50 ns a
// cable, no processing: 14 + 28 + 1200 + 4 + 8 = 1254 octets, 10.032 us; three times (10.032 + 0.05) us = 30.246 us.
TEST(Delay, PublishedValidation) { EXPECT_EQ(latency_over({2, 1_Gbps, 50_ns}, 1200_B, udp), 30'246_ns); }

// 10M, 100M, 1G, 2.5G, 10G, 100G in a row over five bridges of different forwarding delays. 126 octets each:
//   100 800 000 + 10 080 000 + 1 008 000 + 403 200 + 100 800 + 10 080 = 112 402 080 ps
// cables 10 + 20 + 30 + 40 + 50 + 60 = 210 ns; forwarding 1 + 2 + 3 + 4 + 5 = 15 us. In all 127 612 080 ps.
TEST(Delay, MixedRates) {
  PlanBuilder builder;
  const DataRate rates[] = {10_Mbps, 100_Mbps, 1_Gbps, rate_2_5g, 10_Gbps, 100_Gbps};
  const NodeIndex talker = builder.host("talker");
  NodeIndex last = talker;
  for (int i = 0; i < 5; ++i) {
    const NodeIndex next = builder.bridge("sw" + std::to_string(i), 1_us * (i + 1));
    builder.link(last, next, rates[i], 10_ns * (i + 1));
    last = next;
  }
  const NodeIndex listener = builder.host("listener");
  builder.link(last, listener, rates[5], 60_ns);
  const StreamIndex there = builder.stream(talker, {listener});
  const StreamIndex back = builder.stream(listener, {talker});
  builder.send_at(there, 100_B, {1_ms});
  builder.send_at(back, 100_B, {1_ms});
  NetworkRun run(builder.plan);
  run.until(1_s);
  EXPECT_EQ(only_latency(run.stream(there)), 127'612'080_ps);
  EXPECT_EQ(only_latency(run.stream(back)), 127'612'080_ps);  // full duplex: the ways do not disturb each other
}

// 64 octets on the wire with and without tag, and for every payload that the padding fills: 72 * 8 ns = 576 ns to the
// last bit.
TEST(Delay, MinimumFrame) {
  EXPECT_EQ(latency_over({0, 1_Gbps, 0_ns}, 0_B, {}), 576_ns);
  EXPECT_EQ(latency_over({0, 1_Gbps, 0_ns}, 46_B, {}), 576_ns);
  EXPECT_EQ(latency_over({0, 1_Gbps, 0_ns}, 47_B, {}), 584_ns);
  const StreamOptions tagged{Priority{0}, 0, Octets{0}};
  EXPECT_EQ(latency_over({0, 1_Gbps, 0_ns}, 0_B, tagged), 576_ns);
  EXPECT_EQ(latency_over({0, 1_Gbps, 0_ns}, 42_B, tagged), 576_ns);
  EXPECT_EQ(latency_over({0, 1_Gbps, 0_ns}, 43_B, tagged), 584_ns);
}

// Ten minimum frames at once: they arrive 672 ns apart (84 octets: preamble 8, frame 64, gap 12), the first after 576
// ns; the medium is occupied for 840 octets.
TEST(Delay, BackToBackFramesKeepTheGap) {
  for (const bool tagged : {false, true}) {
    Line line(0, 1_Gbps, 0_ns);
    const StreamIndex stream = line.builder.stream(line.talker, {line.listener},
                                                   {tagged ? std::optional<Priority>(1) : std::nullopt, 0, Octets{0}});
    NetworkRun run(line.builder.plan);
    install<Sender>(*run.network, line.talker, "sender", std::vector<Sender::Item>(10, {local(5_us), stream, 20}));
    const Listener& listener = listen(*run.network, line.listener, {stream});
    run.until(1_ms);
    ASSERT_EQ(listener.arrivals.size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_EQ(listener.arrivals[i].time, local(5_us + 576_ns + 672_ns * static_cast<std::int64_t>(i)));
      EXPECT_EQ(listener.arrivals[i].sequence, i);
    }
    EXPECT_EQ(run.port(line.talker, 0).wire_octets_sent(), 840u);
    EXPECT_EQ(run.port(line.talker, 0).frames_sent(), 10u);
  }
}

// The gap is kept through bridges too: after a slower link frames are spread (6.72 us apart at 100 Mb/s), after a
// faster one they keep the spacing of the slower. Two minimum frames at once over 1 Gb/s, 100 Mb/s, 1 Gb/s:
//   first: 576 ns + 5760 ns + 576 ns = 6912 ns; second 6720 ns later, since the slow port is busy when it comes.
TEST(Delay, TheSlowestLinkSpacesTheFrames) {
  PlanBuilder builder;
  const NodeIndex talker = builder.host("talker");
  const NodeIndex one = builder.bridge("one");
  const NodeIndex two = builder.bridge("two");
  const NodeIndex listener = builder.host("listener");
  builder.link(talker, one, 1_Gbps);
  builder.link(one, two, 100_Mbps);
  builder.link(two, listener, 1_Gbps);
  const StreamIndex stream = builder.stream(talker, {listener});
  builder.send_at(stream, 0_B, {0_us, 0_us});
  NetworkRun run(builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(stream).latency.minimum(), 6'912_ns);
  EXPECT_EQ(run.stream(stream).latency.maximum(), 13'632_ns);
}

// A frame that comes when the last bit of the one before is out, but within the gap, waits until the gap is over: the
// first (64 octets) is out at 576 ns, the medium is free at 672 ns. Produced at 600 ns: starts at 672, arrives at 1248,
// latency 648 ns.
TEST(Delay, AFrameWithinTheGapWaits) {
  Line line(0, 1_Gbps, 0_ns);
  const StreamIndex first = line.builder.stream(line.talker, {line.listener});
  const StreamIndex second = line.builder.stream(line.talker, {line.listener});
  const StreamIndex third = line.builder.stream(line.talker, {line.listener});
  line.builder.send_at(first, 0_B, {0_ns});
  line.builder.send_at(second, 0_B, {600_ns});
  line.builder.send_at(third, 0_B, {1'344_ns});  // exactly when the second's gap is over: 2 * 672
  NetworkRun run(line.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(only_latency(run.stream(second)), 648_ns);
  EXPECT_EQ(only_latency(run.stream(third)), 576_ns);
}

// Two events for a frame and hop through an uncongested port at most: production, then one arrival for each of six
// hops.
TEST(Delay, EventsOfAnUncongestedPath) {
  Line line(5, 1_Gbps, 50_ns, 1_us);
  const StreamIndex stream = line.builder.stream(line.talker, {line.listener});
  line.builder.send_at(stream, 100_B, {1_us});
  NetworkRun run(line.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.simulation.event_count(), 7u);
}

}  // namespace
}  // namespace takt::models::delay_test
