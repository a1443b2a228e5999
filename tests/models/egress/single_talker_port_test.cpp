// SPDX-License-Identifier: Apache-2.0
// A port that one process alone sends by: what it sends is put on the medium beforehand, and nobody sees that, whenever
// one looks.
#include <gtest/gtest.h>

#include "tests/models/network_fixture.hpp"

namespace takt::models {
namespace {

using namespace test;
using sim::Distribution;

/// What can be seen of a run at its end.
struct Seen {
  std::uint64_t digest = 0;
  std::uint64_t events = 0;
  std::uint64_t delivered = 0;
  std::uint64_t frames = 0;
  std::uint64_t wire_octets = 0;
  std::uint32_t peak_frames = 0;
  std::uint32_t peak_octets = 0;
  bool operator==(const Seen&) const = default;
};

struct Plant {
  /// 100 Mbit/s, so that frames of 100 to 1400 octets wait for each other; to a host, or to a bridge with one behind
  /// it.
  explicit Plant(const Distribution& transmit, bool to_bridge, const PortConfig& config = {}) {
    OsLatency latency;
    latency.transmit = transmit;
    latency.receive = Distribution::uniform(1_us, 40_us);
    const std::uint32_t os = builder.os_latency(latency);
    builder.plan.port_configs = {config};
    talker = builder.host("talker", os);
    listener = builder.host("listener", os);
    if (to_bridge) {
      const NodeIndex bridge = builder.bridge("bridge", 2_us);
      builder.link(talker, bridge, 100_Mbps, 100_ns);
      builder.link(bridge, listener, 100_Mbps, 100_ns);
    } else {
      builder.link(talker, listener, 100_Mbps, 100_ns);
    }
    urgent = builder.stream(talker, {listener}, {5, 0, {}});
    other = builder.stream(talker, {listener}, {5, 0, {}});
    back = builder.stream(listener, {talker}, {5, 0, {}});
  }
  /// `ahead`, if asked for: how many frames the link has counted that the port has not begun to send.
  Seen run(Duration end, bool is_recorded, std::uint64_t tie_shuffle = 0, std::uint64_t* ahead = nullptr) const {
    NetworkRun run(builder.plan, 3, tie_shuffle);
    TraceLog trace;
    if (is_recorded) run.simulation.set_trace(&trace);
    std::vector<Sender::Item> items;
    for (int i = 0; i < 60; ++i)
      for (int k = 0; k <= i % 5; ++k)
        items.push_back(
            {local(50_us * i), k % 2 == 0 ? urgent : other, 100 + static_cast<std::size_t>(i * 97 + k * 310) % 1300});
    install<Sender>(*run.network, talker, "sender", items);
    install<Sender>(*run.network, listener, "answers",
                    std::vector<Sender::Item>{{local(70_us), back, 200}, {local(71_us), back, 200}});
    run.until(end);
    const EgressPort& port = run.port(talker, 0);
    if (ahead != nullptr) *ahead = port.link().frames_sent() - port.frames_sent();
    const TrafficClass q = port.config().traffic_class_of_priority[5];
    return {run.digest(),
            run.simulation.event_count(),
            run.stream(urgent).delivered + run.stream(other).delivered,
            port.frames_sent(),
            port.wire_octets_sent(),
            port.queues().peak_frames(q),
            port.queues().peak_octets(q)};
  }
  PlanBuilder builder;
  NodeIndex talker, listener;
  StreamIndex urgent, other, back;
};

// A recorder is told of each step at its time, so a recorded run takes all steps. At many ends, most of them with
// frames that are still to be sent.
TEST(SingleTalkerPort, SendsAsAPortDoes) {
  for (const Distribution& transmit :
       {Distribution::constant({}), Distribution::constant(9_us), Distribution::uniform(0_us, 90_us)}) {
    for (const bool to_bridge : {false, true}) {
      const Plant plant(transmit, to_bridge);
      std::uint32_t peak = 0;
      std::uint64_t most_ahead = 0;
      for (int i = 0; i < 130; ++i) {
        const Duration end = 1_us + 29'700_ns * i;
        std::uint64_t ahead = 0;
        const Seen seen = plant.run(end, false, 0, &ahead);
        most_ahead = std::max(most_ahead, ahead);
        const Seen recorded = plant.run(end, true);
        ASSERT_EQ(seen, recorded) << i << ": " << seen.frames << " and " << recorded.frames << " frames, peaks "
                                  << seen.peak_frames << " and " << recorded.peak_frames << ", events " << seen.events
                                  << " and " << recorded.events;
        ASSERT_EQ(plant.run(end, false, 77).digest, seen.digest);
        peak = std::max(peak, seen.peak_frames);
      }
      EXPECT_GE(peak, 3u);
      EXPECT_GT(most_ahead, 0u) << "it has a single talker";
    }
  }
}

// What goes on being recorded or not halfway has no part in it either: frames that were sent before are under way.
TEST(SingleTalkerPort, AnybodyMayBeginToRecord) {
  const Plant plant(Distribution::uniform(0_us, 90_us), false);
  const auto digest_of = [&](Duration from) {
    NetworkRun run(plant.builder.plan, 3);
    TraceLog trace;
    std::vector<Sender::Item> items;
    for (int i = 0; i < 200; ++i) items.push_back({local(7_us * i), i % 2 == 0 ? plant.urgent : plant.other, 700});
    install<Sender>(*run.network, plant.talker, "sender", items);
    run.until(from);
    run.simulation.set_trace(&trace);
    run.until(800_us);
    run.simulation.set_trace(nullptr);
    run.until(20_ms);
    EXPECT_EQ(run.stream(plant.urgent).delivered + run.stream(plant.other).delivered, 200u);
    return run.digest();
  };
  const std::uint64_t digest = digest_of(0_us);
  for (int i = 1; i < 10; ++i) EXPECT_EQ(digest_of(61_us * i), digest) << i;
}

// Two classes may overtake each other, a limit may drop frames, and a second sender may come in between: then a port
// decides as ever.
TEST(SingleTalkerPort, IsNoneWhereThereIsSomethingToDecide) {
  const auto same = [](const Plant& plant, const char* what) {
    for (int i = 0; i < 40; ++i) {
      std::uint64_t ahead = 0;
      ASSERT_EQ(plant.run(1_us + 97'300_ns * i, false, 0, &ahead), plant.run(1_us + 97'300_ns * i, true)) << what;
      ASSERT_EQ(ahead, 0u) << what;
    }
  };
  Plant two_classes(Distribution::uniform(0_us, 90_us), false);
  two_classes.builder.plan.streams[two_classes.other.value].priority = 3;
  same(two_classes, "two classes");
  PortConfig limited;
  for (QueueLimit& limit : limited.queue_limits) limit.frames = 1;
  same(Plant(Distribution::uniform(0_us, 90_us), false, limited), "a limit");
  Plant with_talker(Distribution::uniform(0_us, 90_us), false);
  with_talker.builder.talk(with_talker.other, 300_B, PeriodicSchedule{0_us, 40_us, 0_us});
  same(with_talker, "a talker");
}

}  // namespace
}  // namespace takt::models
