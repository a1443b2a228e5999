// SPDX-License-Identifier: Apache-2.0
// Which frame goes next: strict priority, arrivals before selection, canonical order of what comes at one instant.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "models/egress/class_set.hpp"
#include "tests/models/network_fixture.hpp"

namespace takt::models::selection_test {
namespace {

using namespace test;

StreamOptions with_priority(Priority priority) { return {priority, 0, Octets{0}}; }

/// A direct link of 1 Gb/s without cable, and one stream for each priority. A minimum frame takes 576 ns and occupies
/// 672 ns.
struct DirectLink : Line {
  DirectLink() : Line(0, 1_Gbps, 0_ns) {
    for (Priority priority = 0; priority < 8; ++priority)
      streams.push_back(builder.stream(talker, {listener}, with_priority(priority)));
  }
  /// Runs and returns when frames arrived, one a stream at most, in ns.
  std::vector<std::pair<Priority, std::int64_t>> arrivals() {
    NetworkRun run(builder.plan);
    run.until(1_ms);
    std::vector<std::pair<Priority, std::int64_t>> found;
    for (Priority priority = 0; priority < 8; ++priority) {
      const Stream& stream = run.stream(streams[priority]);
      if (stream.sent == 0) continue;
      EXPECT_EQ(stream.delivered, 1u);
      found.emplace_back(priority, (sent_at[priority] + stream.latency.maximum()).ps());
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    return found;
  }
  void send(Priority priority, Duration time, Octets payload = 0_B) {
    builder.send_at(streams[priority], payload, {time});
    sent_at[priority] = time;
  }
  std::vector<StreamIndex> streams;
  Duration sent_at[8];
};

using Arrivals = std::vector<std::pair<Priority, std::int64_t>>;

// 1500 octets tagged: 1522, with preamble 1530: last bit at 12.240 us, medium free at 1542 * 8 ns = 12.336 us. The
// urgent frame of 100 ns waits until then, and arrives at 12.912 us; what came before it in a lower class goes after
// it, at 13.008 + 0.576 us.
TEST(StrictPriority, ALowerFrameBlocksButIsNotInterrupted) {
  DirectLink link;
  link.send(0, 0_ns, 1500_B);
  link.send(2, 50_ns);
  link.send(7, 100_ns);
  EXPECT_EQ(link.arrivals(), (Arrivals{{0, 12'240'000}, {7, 12'912'000}, {2, 13'584'000}}));
}

// The medium is free at 672 ns. A frame that comes in that very instant counts as present and wins over the waiting
// lower one.
TEST(StrictPriority, ArrivalsComeBeforeSelection) {
  DirectLink link;
  link.send(0, 0_ns);
  link.send(3, 100_ns);
  link.send(5, 672_ns);
  EXPECT_EQ(link.arrivals(), (Arrivals{{0, 576'000}, {5, 1'248'000}, {3, 1'920'000}}));
}

TEST(StrictPriority, OnePicosecondLaterIsTooLate) {
  DirectLink link;
  link.send(0, 0_ns);
  link.send(3, 100_ns);
  link.send(5, 672'001_ps);
  EXPECT_EQ(link.arrivals(), (Arrivals{{0, 576'000}, {3, 1'248'000}, {5, 1'920'000}}));
}

// In the same class first come, first served, also in that instant.
TEST(StrictPriority, AnEqualClassDoesNotOvertake) {
  Line line(0, 1_Gbps, 0_ns);
  const StreamIndex waits = line.builder.stream(line.talker, {line.listener}, with_priority(4));
  const StreamIndex comes = line.builder.stream(line.talker, {line.listener}, with_priority(4));
  // The second stream's talker comes first in the plan, so that a wrong tie rule would show.
  line.builder.send_at(comes, 0_B, {672_ns});
  line.builder.send_at(waits, 0_B, {0_ns, 100_ns});
  NetworkRun run(line.builder.plan);
  run.until(1_ms);
  EXPECT_EQ(run.stream(waits).latency.maximum(), 1'148_ns);  // 672 + 576 - 100
  EXPECT_EQ(run.stream(comes).latency.maximum(), 1'248_ns);  // 1344 + 576 - 672
}

// All eight at one instant: the most urgent at once, then downwards; by Table 8-5 priority 1 (background) lies below 0.
TEST(StrictPriority, EightPrioritiesAtOneInstant) {
  DirectLink link;
  for (Priority priority = 0; priority < 8; ++priority) link.send(priority, 1_us);
  Arrivals expected;
  std::int64_t time = 1'576'000;
  for (const Priority priority : std::initializer_list<Priority>{7, 6, 5, 4, 3, 2, 0, 1}) {
    expected.emplace_back(priority, time);
    time += 672'000;
  }
  EXPECT_EQ(link.arrivals(), expected);
}

TEST(StrictPriority, IdentityMapping) {
  DirectLink link;
  link.builder.plan.port_configs[0].traffic_class_of_priority = identity_traffic_classes;
  link.send(0, 1_us);
  link.send(1, 1_us);
  EXPECT_EQ(link.arrivals(), (Arrivals{{1, 1'576'000}, {0, 2'248'000}}));
}

// With one class for all priorities nobody overtakes.
TEST(StrictPriority, OneClassIsFirstInFirstOut) {
  DirectLink link;
  link.builder.plan.port_configs[0].traffic_class_of_priority = {};
  link.send(0, 0_ns);
  link.send(1, 10_ns);
  link.send(7, 20_ns);
  EXPECT_EQ(link.arrivals(), (Arrivals{{0, 576'000}, {1, 1'248'000}, {7, 1'920'000}}));
}

/// Two hosts at ports 0 and 1 of a bridge send one frame each at the same instant to a third at port 2. Everything that
/// could decide which event comes first is varied: the order of nodes, of links and of talkers, and the tie shuffle.
struct Duel {
  bool swap_nodes = false;
  bool swap_links = false;
  bool swap_talkers = false;
  std::uint64_t tie_shuffle = 0;
};

std::vector<Duration> duel(const Duel& variant, Priority of_port_0, Priority of_port_1) {
  PlanBuilder builder;
  NodeIndex hosts[2];
  for (const int i : {variant.swap_nodes ? 1 : 0, variant.swap_nodes ? 0 : 1})
    hosts[i] = builder.host("host" + std::to_string(i));
  const NodeIndex sw = builder.bridge("sw");
  const NodeIndex target = builder.host("target");
  builder.link(hosts[0], sw);
  builder.link(hosts[1], sw);
  builder.link(sw, target);
  const StreamIndex streams[2] = {builder.stream(hosts[0], {target}, with_priority(of_port_0)),
                                  builder.stream(hosts[1], {target}, with_priority(of_port_1))};
  for (const int i : {variant.swap_talkers ? 1 : 0, variant.swap_talkers ? 0 : 1})
    builder.send_at(streams[i], 0_B, {1_us});
  if (variant.swap_links) std::swap(builder.plan.links[0], builder.plan.links[1]);
  NetworkRun run(builder.plan, 1, variant.tie_shuffle);
  run.until(1_ms);
  return {run.stream(streams[0]).latency.maximum(), run.stream(streams[1]).latency.maximum()};
}

std::vector<Duel> duels() {
  std::vector<Duel> all;
  for (int bits = 0; bits < 8; ++bits)
    for (const std::uint64_t key : {0ULL, 1ULL, 0xDEADBEEFULL, 0x123456789ABCDEFULL})
      all.push_back({(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, key});
  return all;
}

// Both frames are in the bridge at 1.576 us; the one of ingress port 0 goes first and is there 576 ns later, the other
// 672 ns after.
TEST(CanonicalOrder, TheLowerIngressPortGoesFirst) {
  for (const Duel& variant : duels()) EXPECT_EQ(duel(variant, 4, 4), (std::vector<Duration>{1'152_ns, 1'824_ns}));
}

TEST(CanonicalOrder, ThePriorityDecidesBeforeThePort) {
  for (const Duel& variant : duels()) EXPECT_EQ(duel(variant, 4, 5), (std::vector<Duration>{1'824_ns, 1'152_ns}));
}

// Two applications of a host send at one instant: the one that was installed first goes first, whatever the events'
// order.
TEST(CanonicalOrder, ApplicationsOfAHost) {
  for (const std::uint64_t key : {0ULL, 1ULL, 2ULL, 3ULL, 0xDEADBEEFULL}) {
    Line line(0, 1_Gbps, 0_ns);
    const StreamIndex one = line.builder.stream(line.talker, {line.listener});
    const StreamIndex two = line.builder.stream(line.talker, {line.listener});
    NetworkRun run(line.builder.plan, 1, key);
    install<Sender>(*run.network, line.talker, "first",
                    std::vector<Sender::Item>{{local(1_us), two, 8}, {local(1_us), one, 8}});
    install<Sender>(*run.network, line.talker, "second",
                    std::vector<Sender::Item>{{local(1_us), one, 8}, {local(1_us), two, 8}});
    const Listener& listener = listen(*run.network, line.listener, {one, two});
    run.until(1_ms);
    std::vector<StreamIndex> order;
    for (const Listener::Arrival& arrival : listener.arrivals) order.push_back(arrival.stream);
    EXPECT_EQ(order, (std::vector<StreamIndex>{two, one, one, two}));
  }
}

TEST(TransmissionSelection, TakesTheHighestCandidate) {
  for (int set = 1; set < 256; ++set) {
    int highest = 7;
    while ((set >> highest & 1) == 0) --highest;
    EXPECT_EQ(highest_class(static_cast<ClassSet>(set)), highest);
  }
}

}  // namespace
}  // namespace takt::models::selection_test
