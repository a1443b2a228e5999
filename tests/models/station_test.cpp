// SPDX-License-Identifier: Apache-2.0
// Stations: a host and a bridge in one node; and hosts with several interfaces. All links 1 Gbit/s with 50 ns of cable
// unless a test says otherwise; a payload of 100 octets is 118 octets untagged, 126 with the preamble: 1008 ns to the
// last bit, 1104 ns with the gap.
#include <gtest/gtest.h>

#include <vector>

#include "tests/models/network_fixture.hpp"

namespace takt::models::station_test {
namespace {

using namespace test;  // NOLINT

constexpr Duration cable = 50_ns;
constexpr Duration forwarding = 500_ns;
constexpr Duration frame = 1008_ns;
constexpr Duration gap = 96_ns;

/// left - station - right.
struct Chain {
  explicit Chain(const PortConfig& config = {}) {
    left = builder.host("left");
    station = builder.station("station", forwarding, builder.port_config(config));
    right = builder.host("right");
    builder.link(left, station, 1_Gbps, cable);
    builder.link(station, right, 1_Gbps, cable);
  }
  /// When a frame that the stream's talker sends at 0 is there.
  std::vector<LocalTime> arrivals_at(NodeIndex host, StreamIndex stream) {
    NetworkRun run(builder.plan);
    install<Sender>(*run.network, builder.plan.streams[stream.value].talker, "sender",
                    std::vector<Sender::Item>{{local(0_ns), stream, 100}});
    const Listener& listener = listen(*run.network, host, {stream});
    run.until(1_ms);
    std::vector<LocalTime> times;
    for (const Listener::Arrival& arrival : listener.arrivals) times.push_back(arrival.time);
    return times;
  }
  PlanBuilder builder;
  NodeIndex left, station, right;
};

StreamOptions tagged(Priority priority) { return {priority, 0, Octets{0}}; }

TEST(Station, ForwardsAsASwitchDoes) {
  Chain chain;
  const StreamIndex through = chain.builder.stream(chain.left, {chain.right});
  chain.builder.send_at(through, 100_B, {0_ns});
  NetworkRun run(chain.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(through).latency.maximum(), frame + cable + forwarding + frame + cable);  // 2616 ns
}

TEST(Station, SendsWithoutAForwardingDelay) {
  Chain chain;
  const StreamIndex own = chain.builder.stream(chain.station, {chain.right});
  chain.builder.send_at(own, 100_B, {0_ns});
  NetworkRun run(chain.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(own).latency.maximum(), frame + cable);  // 1058 ns
}

TEST(Station, ReceivesBehindTheForwardingDelay) {
  Chain chain;
  const StreamIndex in = chain.builder.stream(chain.left, {chain.station});
  chain.builder.send_at(in, 100_B, {0_ns});
  NetworkRun run(chain.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(in).latency.maximum(), frame + cable + forwarding);  // 1558 ns
}

TEST(Station, ReceivesBehindTheForwardingDelayAndItsOperatingSystem) {
  Chain chain;
  chain.builder.plan.nodes[chain.station.value].os_latency =
      chain.builder.os_latency({.receive = sim::Distribution::constant(7_us)});
  const StreamIndex in = chain.builder.stream(chain.left, {chain.station});
  chain.builder.send_at(in, 100_B, {0_ns});
  NetworkRun run(chain.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(in).latency.maximum(), frame + cable + forwarding + 7_us);
}

// What comes through is at the port at 1558 ns. A frame of the station's own that started at 1000 ns has the medium
// until 2008 + 96 ns.
TEST(Station, ItsOwnFramesCompeteWithThoseThatItForwards) {
  Chain chain;
  const StreamIndex through = chain.builder.stream(chain.left, {chain.right});
  const StreamIndex own = chain.builder.stream(chain.station, {chain.right});
  chain.builder.send_at(through, 100_B, {0_ns});
  chain.builder.send_at(own, 100_B, {1000_ns});
  NetworkRun run(chain.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(own).latency.maximum(), frame + cable);
  EXPECT_EQ(run.stream(through).latency.maximum(), 1000_ns + frame + gap + frame + cable);  // 3162 ns
}

// At one instant what comes through goes first, whichever event was handled first: the own frame starts at 1558 + 1104
// ns.
TEST(Station, AtOneInstantWhatComesThroughGoesFirst) {
  for (const std::uint64_t shuffle : {0u, 1u, 2u, 3u, 4u, 5u}) {
    Chain chain;
    const StreamIndex own = chain.builder.stream(chain.station, {chain.right});
    const StreamIndex through = chain.builder.stream(chain.left, {chain.right});
    chain.builder.send_at(own, 100_B, {1558_ns});
    chain.builder.send_at(through, 100_B, {0_ns});
    NetworkRun run(chain.builder.plan, 1, shuffle);
    run.until(1_ms);
    EXPECT_EQ(run.stream(through).latency.maximum(), 2616_ns);
    EXPECT_EQ(run.stream(own).latency.maximum(), 2 * frame + gap + cable);  // 2162 ns
  }
}

// Tagged frames of 122 octets, 130 with the preamble: 1040 ns. The header is 22 octets and the tag: 26 * 8 = 208 ns, so
// the frame begins to leave at 758 ns. The station's host has it when it is stored, at 1040 + 550 ns.
TEST(Station, CutsThroughAndGivesItsHostWholeFrames) {
  PortConfig config;
  config.cut_through = only(6);
  Chain chain(config);
  const StreamIndex all = chain.builder.stream(chain.left, {chain.station, chain.right}, tagged(6));
  EXPECT_EQ(chain.arrivals_at(chain.station, all), std::vector<LocalTime>{local(1590_ns)});
  EXPECT_EQ(chain.arrivals_at(chain.right, all), std::vector<LocalTime>{local(208_ns + 550_ns + 1040_ns + cable)});
}

// An own frame of 1500 octets is on the medium when an express frame is there, at 1590 ns (tagged): 198 octets and 3/4
// of one have left, preamble included. With the 199th it ends, mCRC (4 octets) and gap (12) follow: (199 + 16) * 8 =
// 1720 ns.
TEST(Station, CutsItsOwnFramesForExpressOnes) {
  PortConfig config;
  config.preemption.emplace();
  config.preemption->preemptable = only(1);  // priority 0
  Chain chain(config);
  const StreamIndex through = chain.builder.stream(chain.left, {chain.right}, tagged(6));
  const StreamIndex own = chain.builder.stream(chain.station, {chain.right}, tagged(0));
  chain.builder.send_at(through, 100_B, {0_ns});
  chain.builder.send_at(own, 1500_B, {0_ns});
  NetworkRun run(chain.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(through).latency.maximum(), 1720_ns + 1040_ns + cable);
}

// A frame to all leaves a station by both its ports at once, and is not given back to its own host.
TEST(Station, SendsByAllPortsThatLeadToListeners) {
  Chain chain;
  const StreamIndex all = chain.builder.stream(chain.station, {chain.left, chain.right});
  EXPECT_EQ(chain.arrivals_at(chain.left, all), std::vector<LocalTime>{local(1058_ns)});
  EXPECT_EQ(chain.arrivals_at(chain.right, all), std::vector<LocalTime>{local(1058_ns)});
}

TEST(Station, TakesOffTagsOfItsOwnFramesToo) {
  PortConfig config;
  config.untagged = true;
  Chain chain(config);
  const StreamIndex own = chain.builder.stream(chain.station, {chain.right}, tagged(6));
  chain.builder.send_at(own, 100_B, {0_ns});
  NetworkRun run(chain.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(own).latency.maximum(), frame + cable);  // of the untagged frame
}

// One power supply: while it is down nothing goes through, nothing is sent or received.
TEST(Station, ACrashTakesBothParts) {
  Chain chain;
  for (LinkPlan& link : chain.builder.plan.links) link.may_fail = true;
  const StreamIndex through = chain.builder.stream(chain.left, {chain.right});
  const StreamIndex own = chain.builder.stream(chain.station, {chain.right});
  const StreamIndex in = chain.builder.stream(chain.left, {chain.station});
  for (const StreamIndex stream : {through, own, in}) chain.builder.send_at(stream, 100_B, {0_us, 50_us, 100_us});
  NetworkRun run(chain.builder.plan);
  run.until(40_us);
  run.network->set_node(chain.station, false);
  run.until(90_us);
  run.network->set_node(chain.station, true);
  run.until(1_ms);
  EXPECT_EQ(run.stream(through).delivered, 2u);
  EXPECT_EQ(run.stream(own).delivered, 2u);
  EXPECT_EQ(run.stream(own).sent, 2u);  // a host that is down produces nothing
  EXPECT_EQ(run.stream(in).delivered, 2u);
}

// Down from 40 us; from 60 us on the relay makes one cable of 100 ns of two: 1008 + 100 ns, without a forwarding delay.
// From 150 us on all is dark again, and from 170 us on the station forwards.
TEST(Station, ABypassJoinsTheCablesOfOneThatIsDown) {
  Chain chain;
  for (LinkPlan& link : chain.builder.plan.links) link.may_fail = true;
  const StreamIndex there = chain.builder.stream(chain.left, {chain.right});
  const StreamIndex back = chain.builder.stream(chain.right, {chain.left});
  const StreamIndex in = chain.builder.stream(chain.left, {chain.station});
  for (const StreamIndex stream : {there, back})
    chain.builder.send_at(stream, 100_B, {0_us, 50_us, 70_us, 160_us, 200_us});
  chain.builder.send_at(in, 100_B, {80_us});
  NetworkRun run(chain.builder.plan);
  const auto at_the_time = [&](Duration time, const auto& what) {
    run.until(time);
    what();
  };
  at_the_time(40_us, [&] { run.network->set_node(chain.station, false); });
  at_the_time(60_us, [&] { run.network->set_bypass(chain.station, true); });
  at_the_time(150_us, [&] { run.network->set_bypass(chain.station, false); });
  at_the_time(170_us, [&] { run.network->set_node(chain.station, true); });
  run.until(1_ms);
  for (const StreamIndex stream : {there, back}) {
    EXPECT_EQ(run.stream(stream).delivered, 3u);
    EXPECT_EQ(run.stream(stream).latency.minimum(), frame + 2 * cable);                           // 1108 ns
    EXPECT_EQ(run.stream(stream).latency.maximum(), frame + cable + forwarding + frame + cable);  // 2616 ns
    EXPECT_EQ(run.stream(stream).dropped[static_cast<std::size_t>(DropReason::link_down)], 2u);
  }
  EXPECT_EQ(run.stream(in).delivered, 0u);  // there is nobody; the frame comes to the right host, which it is not for
  EXPECT_EQ(run.stream(in).dropped[static_cast<std::size_t>(DropReason::no_filtering_entry)], 1u);
}

// A frame on the way through the relay is lost when that opens.
TEST(Station, ABypassThatOpensCutsWhatIsOnIt) {
  Chain chain;
  for (LinkPlan& link : chain.builder.plan.links) link.may_fail = true;
  const StreamIndex there = chain.builder.stream(chain.left, {chain.right});
  chain.builder.send_at(there, 100_B, {70_us, 71104_ns});
  NetworkRun run(chain.builder.plan);
  run.until(10_us);
  run.network->set_node(chain.station, false);
  run.until(20_us);
  run.network->set_bypass(chain.station, true);
  run.until(72_us);  // the second frame has begun and not ended
  run.network->set_bypass(chain.station, false);
  run.until(1_ms);
  EXPECT_EQ(run.stream(there).delivered, 1u);
  EXPECT_EQ(run.stream(there).dropped[static_cast<std::size_t>(DropReason::link_down)], 1u);
}

// Two stations that are down side by side: three cables are one. A cut of any of them is a cut of all.
TEST(Station, BypassesJoinInARow) {
  PlanBuilder builder;
  const NodeIndex left = builder.host("left"), one = builder.station("one", forwarding),
                  two = builder.station("two", forwarding), right = builder.host("right");
  builder.link(left, one, 1_Gbps, cable);
  builder.link(one, two, 1_Gbps, cable);
  builder.link(two, right, 1_Gbps, cable);
  for (LinkPlan& link : builder.plan.links) link.may_fail = true;
  const StreamIndex there = builder.stream(left, {right});
  builder.send_at(there, 100_B, {50_us, 150_us, 250_us, 350_us});
  NetworkRun run(builder.plan);
  run.until(1_us);
  for (const NodeIndex node : {one, two}) run.network->set_node(node, false);
  for (const NodeIndex node : {two, one}) run.network->set_bypass(node, true);
  run.until(100_us);
  EXPECT_EQ(run.stream(there).latency.maximum(), frame + 3 * cable);
  run.network->set_link(1, false);
  run.until(200_us);
  EXPECT_EQ(run.stream(there).delivered, 1u);
  run.network->set_link(1, true);
  run.until(300_us);
  EXPECT_EQ(run.stream(there).delivered, 2u);
  run.network->set_bypass(two, false);  // one joins left to two, which is back
  run.network->set_node(two, true);
  run.until(1_ms);
  EXPECT_EQ(run.stream(there).delivered, 3u);
  EXPECT_EQ(run.stream(there).latency.maximum(), frame + 2 * cable + forwarding + frame + cable);
}

// A host with two interfaces chooses by its filtering entries, and does not forward between them.
TEST(HostWithTwoInterfaces, SendsByTheOneThatLeadsThere) {
  PlanBuilder builder;
  const NodeIndex left = builder.host("left");
  const NodeIndex middle = builder.host("middle");
  const NodeIndex right = builder.host("right");
  builder.link(left, middle, 1_Gbps, cable);
  builder.link(middle, right, 1_Gbps, cable);
  const StreamIndex to_left = builder.stream(middle, {left});
  const StreamIndex to_right = builder.stream(middle, {right});
  builder.send_at(to_left, 100_B, {0_ns});
  builder.send_at(to_right, 100_B, {0_ns});
  NetworkRun run(builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(to_left).latency.maximum(), frame + cable);
  EXPECT_EQ(run.stream(to_right).latency.maximum(), frame + cable);
}

// Frames that come by both interfaces at one instant are taken in by the order of the interfaces, whichever event was
// handled first.
TEST(HostWithTwoInterfaces, TakesInTheFramesOfAnInstantByPort) {
  for (const std::uint64_t shuffle : {0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u}) {
    PlanBuilder builder;
    const NodeIndex middle = builder.host("middle");
    const NodeIndex right = builder.host("right");
    const NodeIndex left = builder.host("left");
    builder.link(left, middle, 1_Gbps, cable);
    builder.link(middle, right, 1_Gbps, cable);
    const StreamIndex second = builder.stream(right, {middle});
    const StreamIndex first = builder.stream(left, {middle});
    NetworkRun run(builder.plan, 1, shuffle);
    install<Sender>(*run.network, right, "sender", std::vector<Sender::Item>{{local(0_ns), second, 100}});
    install<Sender>(*run.network, left, "sender", std::vector<Sender::Item>{{local(0_ns), first, 100}});
    const Listener& listener = listen(*run.network, middle, {first, second});
    run.until(1_ms);
    ASSERT_EQ(listener.arrivals.size(), 2u);
    EXPECT_EQ(listener.arrivals[0].stream, first);
    EXPECT_EQ(listener.arrivals[1].stream, second);
    EXPECT_EQ(listener.arrivals[1].time, local(frame + cable));
  }
}

}  // namespace
}  // namespace takt::models::station_test
