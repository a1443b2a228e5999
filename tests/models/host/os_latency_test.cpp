// SPDX-License-Identifier: Apache-2.0
// The operating system between program and wire: fixed and random delays, first in first out.
#include <gtest/gtest.h>

#include <vector>

#include "tests/models/network_fixture.hpp"

namespace takt::models {
namespace {

using namespace test;
using sim::Distribution;

/// A direct link of 1 Gb/s, 50 ns; both hosts have these latencies. 100 octets of payload: 1058 ns from the port to the
/// listener.
struct Link {
  explicit Link(const OsLatency& latency) {
    const std::uint32_t os = builder.os_latency(latency);
    talker = builder.host("talker", os);
    listener = builder.host("listener", os);
    builder.link(talker, listener, 1_Gbps, 50_ns);
    stream = builder.stream(talker, {listener});
  }
  PlanBuilder builder;
  NodeIndex talker, listener;
  StreamIndex stream;
};

OsLatency transmit(Distribution d) {
  OsLatency latency;
  latency.transmit = std::move(d);
  return latency;
}
OsLatency receive(Distribution d) {
  OsLatency latency;
  latency.receive = std::move(d);
  return latency;
}

// 10 us + 1.058 us + 20 us, for talkers and for applications.
TEST(OsLatency, FixedDelaysAdd) {
  OsLatency latency;
  latency.transmit = Distribution::constant(10_us);
  latency.receive = Distribution::constant(20_us);
  Link link(latency);
  link.builder.send_at(link.stream, 100_B, {5_us, 500_us});
  NetworkRun run(link.builder.plan);
  install<Sender>(*run.network, link.talker, "sender", std::vector<Sender::Item>{{local(200_us), link.stream, 100}});
  const Listener& listener = listen(*run.network, link.listener, {link.stream});
  run.until(1_ms);
  EXPECT_EQ(run.stream(link.stream).delivered, 3u);
  EXPECT_EQ(run.stream(link.stream).latency.minimum(), 31'058_ns);
  EXPECT_EQ(run.stream(link.stream).latency.maximum(), 31'058_ns);
  ASSERT_EQ(listener.arrivals.size(), 1u);  // the talkers' frames have no octets
  EXPECT_EQ(listener.arrivals[0].time, local(231'058_ns));
}

// A fixed delay lies in the time of the arrival event, and so does one that is drawn, unless somebody wants to know of
// the arrival itself. The results are the same.
TEST(OsLatency, AFixedDelayIsADegenerateRandomOne) {
  std::uint64_t digests[3];
  std::uint64_t events[3];
  for (const std::size_t i : {0u, 1u, 2u}) {
    const bool random = i > 0;
    OsLatency latency;
    latency.receive = random ? Distribution::uniform(3_us, 3_us) : Distribution::constant(3_us);
    latency.transmit = random ? Distribution::uniform(2_us, 2_us) : Distribution::constant(2_us);
    Link link(latency);
    link.builder.talk(link.stream, 100_B, PeriodicSchedule{0_us, 10_us, 0_us});
    NetworkRun run(link.builder.plan);
    if (i == 2) run.network->trace_paths();
    run.until(10_ms);
    digests[i] = run.digest();
    events[i] = run.simulation.event_count();
  }
  EXPECT_EQ(digests[1], digests[0]);
  EXPECT_EQ(digests[2], digests[0]);
  EXPECT_EQ(events[1], events[0]);
  EXPECT_EQ(events[2], events[0]);  // what is there for the recorder only does not count
}

// Latencies that are drawn are the same whether a link draws them or the host does: in the order of the frames.
TEST(OsLatency, WhoDrawsDoesNotMatter) {
  std::uint64_t digests[2];
  for (const std::size_t told : {0u, 1u}) {
    OsLatency latency;
    latency.receive = Distribution::uniform(0_us, 50_us);
    Link link(latency);
    link.builder.talk(link.stream, 100_B, PeriodicSchedule{0_us, 10_us, 0_us});
    NetworkRun run(link.builder.plan);
    if (told == 1) run.network->trace_paths();
    run.until(10_ms);
    digests[told] = run.digest();
  }
  EXPECT_EQ(digests[0], digests[1]);
}

// Frames every 2 us with delays of 0 .. 50 us: none overtakes another, and each delay stays within its bounds: a frame
// that waits for its predecessor came later than that one, so it waits at most what that one had left.
TEST(OsLatency, RandomReceiveKeepsTheOrderAndItsBounds) {
  Link link(receive(Distribution::uniform(4_us, 50_us)));
  NetworkRun run(link.builder.plan);
  std::vector<Sender::Item> items;
  for (int i = 0; i < 5'000; ++i) items.push_back({local(2_us * i), link.stream, 100});
  install<Sender>(*run.network, link.talker, "sender", items);
  const Listener& listener = listen(*run.network, link.listener, {link.stream});
  run.until(1_s);
  ASSERT_EQ(listener.arrivals.size(), 5'000u);
  for (std::size_t i = 0; i < 5'000; ++i) {
    ASSERT_EQ(listener.arrivals[i].sequence, i);
    ASSERT_GE(listener.arrivals[i].time, listener.arrivals[i == 0 ? 0 : i - 1].time);
  }
  EXPECT_GE(run.stream(link.stream).latency.minimum(), 5'058_ns);
  EXPECT_LE(run.stream(link.stream).latency.maximum(), 51'058_ns);
  // With 23 other frames under way the queue in front of each is nearly always near its worst: the draws really vary.
  EXPECT_GT(run.stream(link.stream).latency.maximum() - run.stream(link.stream).latency.minimum(), 20_us);
}

TEST(OsLatency, RandomTransmitKeepsTheOrder) {
  for (const bool application : {false, true}) {
    Link link(transmit(Distribution::exponential(30_us)));
    if (!application) link.builder.talk(link.stream, 100_B, PeriodicSchedule{0_us, 2_us, 0_us});
    NetworkRun run(link.builder.plan);
    TraceLog trace;
    run.simulation.set_trace(&trace);
    std::vector<Sender::Item> items;
    for (int i = 0; i < 1'000; ++i) items.push_back({local(2_us * i), link.stream, 100});
    if (application) install<Sender>(*run.network, link.talker, "sender", items);
    const Listener& listener = listen(*run.network, link.listener, {link.stream});
    run.until(10_ms);
    // Frames carry handles; they start in the order in which they were produced.
    const auto produced = trace.of(Occurrence::produced);
    const auto started = trace.of(Occurrence::started);
    ASSERT_GE(started.size(), 1'000u);
    bool any_delay = false;
    for (std::size_t i = 0; i < started.size(); ++i) {
      ASSERT_EQ(started[i].what, produced[i].what) << i;
      any_delay = any_delay || started[i].time > produced[i].time;
    }
    EXPECT_TRUE(any_delay);
    for (std::size_t i = 0; i < listener.arrivals.size(); ++i) ASSERT_EQ(listener.arrivals[i].sequence, i);
    EXPECT_EQ(listener.arrivals.size(), application ? 1'000u : 0u);
  }
}

// Each application has its own line and its own chance: one that waits does not hold up another.
TEST(OsLatency, ApplicationsDoNotQueueBehindEachOther) {
  const auto latency_of_first = [](bool with_second) {
    Link link(transmit(Distribution::uniform(0_us, 100_us)));
    const StreamIndex other = link.builder.stream(link.talker, {link.listener});
    NetworkRun run(link.builder.plan);
    install<Sender>(*run.network, link.talker, "first", std::vector<Sender::Item>{{local(10_us), link.stream, 100}});
    if (with_second)
      install<Sender>(*run.network, link.talker, "second", std::vector<Sender::Item>{{local(500_us), other, 100}});
    run.until(1_ms);
    EXPECT_EQ(run.stream(link.stream).delivered, 1u);
    return run.stream(link.stream).latency.maximum();
  };
  EXPECT_EQ(latency_of_first(false), latency_of_first(true));
}

TEST(LatencyLine, PassesInOrderAndSamplesFreely) {
  const Distribution distribution = Distribution::uniform(0_us, 10_us);
  LatencyLine line(distribution, 1, "host", "os receive");
  EXPECT_FALSE(line.is_none());
  TrueTime last;
  bool waited = false;
  for (int i = 0; i < 1'000; ++i) {
    const TrueTime start = at(1_us * i);
    const TrueTime end = line.pass(start);
    EXPECT_GE(end, start);
    EXPECT_GE(end, last);
    EXPECT_LE(end, start + 10_us);
    waited = waited || end == last;
    last = end;
  }
  EXPECT_TRUE(waited);
  const Distribution none = Distribution::constant(0_us);
  EXPECT_TRUE(LatencyLine(none, 1, "host", "os receive").is_none());
}

}  // namespace
}  // namespace takt::models
