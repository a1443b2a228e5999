// SPDX-License-Identifier: Apache-2.0
// The functional tests of the DISCO network calculator: networks of servers whose delays and backlogs are known, as
// exact fractions. And a search for runs that exceed what is answered: in networks where paths part and meet again the
// analysed flow makes its own cross traffic burstier.
#include <gtest/gtest.h>

#include <deque>
#include <string>

#include "analysis/server_network.hpp"
#include "sim/random.hpp"

namespace takt::analysis::disco_test {
namespace {

struct KnownFlow {
  TokenBucket arrival;
  std::vector<std::size_t> path;
};
struct KnownBound {
  const char* delay;
  const char* backlog;
};
struct KnownAnswer {
  Multiplexing multiplexing;
  std::string analysis;
  std::size_t flow;
  std::vector<KnownBound> any_of;  // of those that the calculator gives, by the order in which it bounds arrivals
};
struct KnownNetwork {
  const char* name;
  std::vector<RateLatency> servers;
  std::vector<KnownFlow> flows;
  std::vector<KnownAnswer> answers;
};

const std::vector<KnownNetwork>& known_networks() {
  static const std::vector<KnownNetwork> all = {
      {"FF_3S_1SC_2F_1AC_2P",
       {{20, 20}, {20, 20}, {20, 20}},
       {{{5, 25}, {0, 2}}, {{5, 25}, {0, 1, 2}}},
       {{Multiplexing::fifo, "TFA", 0, {{"485/8", "1125/2"}}},
        {Multiplexing::fifo, "TFA", 1, {{"1395/16", "1125/2"}}},
        {Multiplexing::fifo, "SFA", 0, {{"2615/48", "4625/16"}}},
        {Multiplexing::fifo, "SFA", 1, {{"3335/48", "5825/16"}}},
        {Multiplexing::arbitrary, "TFA", 0, {{"385/3", "1900/3"}}},
        {Multiplexing::arbitrary, "TFA", 1, {{"470/3", "1900/3"}}},
        {Multiplexing::arbitrary, "SFA", 0, {{"670/9", "3500/9"}}},
        {Multiplexing::arbitrary, "SFA", 1, {{"790/9", "4100/9"}}}}},
      {"FF_4S_1SC_4F_1AC_4P",
       {{20, 20}, {20, 20}, {20, 20}, {20, 20}},
       {{{5, 25}, {0, 1, 3}}, {{5, 25}, {2, 3}}, {{5, 25}, {2, 1}}, {{5, 25}, {2, 0, 3}}},
       {{Multiplexing::fifo, "TFA", 0, {{"3735/32", "975"}}},
        {Multiplexing::fifo, "TFA", 1, {{"155/2", "975"}}},
        {Multiplexing::fifo, "TFA", 2, {{"1875/32", "3975/8"}}},
        {Multiplexing::fifo, "TFA", 3, {{"845/8", "975"}}},
        {Multiplexing::fifo, "SFA", 0, {{"1525/16", "7825/16"}}},
        {Multiplexing::fifo, "SFA", 1, {{"575/8", "2975/8"}}},
        {Multiplexing::fifo, "SFA", 2, {{"1695/32", "8875/32"}}},
        {Multiplexing::fifo, "SFA", 3, {{"1405/16", "7225/16"}}},
        {Multiplexing::arbitrary, "TFA", 0, {{"1370/3", "1400"}, {"2765/6", "8525/6"}}},
        {Multiplexing::arbitrary, "TFA", 1, {{"2395/6", "8525/6"}, {"395", "1400"}}},
        {Multiplexing::arbitrary, "TFA", 2, {{"1105/6", "2075/3"}}},
        {Multiplexing::arbitrary, "TFA", 3, {{"1400/3", "8525/6"}, {"925/2", "1400"}}},
        {Multiplexing::arbitrary, "SFA", 0, {{"2345/12", "11875/12"}, {"580/3", "5875/6"}}},
        {Multiplexing::arbitrary, "SFA", 1, {{"2095/12", "10625/12"}, {"345/2", "875"}}},
        {Multiplexing::arbitrary, "SFA", 2, {{"1625/18", "4175/9"}}},
        {Multiplexing::arbitrary, "SFA", 3, {{"560/3", "5675/6"}}}}},
      {"S_1SC_1F_1AC",
       {{10, 10}},
       {{{5, 25}, {0}}},
       {{Multiplexing::fifo, "TFA", 0, {{"25/2", "75"}}},
        {Multiplexing::fifo, "SFA", 0, {{"25/2", "75"}}},
        {Multiplexing::arbitrary, "TFA", 0, {{"25/2", "75"}}},
        {Multiplexing::arbitrary, "SFA", 0, {{"25/2", "75"}}}}},
      {"S_1SC_2F_2AC",
       {{10, 10}},
       {{{4, 10}, {0}}, {{5, 25}, {0}}},
       {{Multiplexing::fifo, "TFA", 0, {{"27/2", "125"}}},
        {Multiplexing::fifo, "TFA", 1, {{"27/2", "125"}}},
        {Multiplexing::fifo, "SFA", 0, {{"29/2", "60"}}},
        {Multiplexing::fifo, "SFA", 1, {{"91/6", "80"}}},
        {Multiplexing::arbitrary, "TFA", 0, {{"135", "125"}}},
        {Multiplexing::arbitrary, "TFA", 1, {{"135", "125"}}},
        {Multiplexing::arbitrary, "SFA", 0, {{"27", "110"}}},
        {Multiplexing::arbitrary, "SFA", 1, {{"45/2", "350/3"}}}}},
      {"TA_2S_1SC_2F_1AC_1P",
       {{10, 10}, {10, 10}},
       {{{5, 25}, {0, 1}}, {{5, 25}, {0, 1}}},
       {{Multiplexing::fifo, "TFA", 0, {{"40", "250"}}},
        {Multiplexing::fifo, "TFA", 1, {{"40", "250"}}},
        {Multiplexing::fifo, "SFA", 0, {{"35", "175"}}},
        {Multiplexing::fifo, "SFA", 1, {{"35", "175"}}},
        {Multiplexing::arbitrary, "TFA", 0, {{"unbounded", "250"}}},
        {Multiplexing::arbitrary, "TFA", 1, {{"unbounded", "250"}}},
        {Multiplexing::arbitrary, "SFA", 0, {{"65", "325"}}},
        {Multiplexing::arbitrary, "SFA", 1, {{"65", "325"}}}}},
      {"TA_2S_1SC_4F_1AC_1P",
       {{10, 10}, {10, 10}},
       {{{2, 10}, {0, 1}}, {{2, 10}, {0, 1}}, {{2, 10}, {0, 1}}, {{2, 10}, {0, 1}}},
       {{Multiplexing::fifo, "TFA", 0, {{"36", "200"}}},
        {Multiplexing::fifo, "TFA", 1, {{"36", "200"}}},
        {Multiplexing::fifo, "TFA", 2, {{"36", "200"}}},
        {Multiplexing::fifo, "TFA", 3, {{"36", "200"}}},
        {Multiplexing::fifo, "SFA", 0, {{"69/2", "74"}}},
        {Multiplexing::fifo, "SFA", 1, {{"69/2", "74"}}},
        {Multiplexing::fifo, "SFA", 2, {{"69/2", "74"}}},
        {Multiplexing::fifo, "SFA", 3, {{"69/2", "74"}}},
        {Multiplexing::arbitrary, "TFA", 0, {{"180", "200"}}},
        {Multiplexing::arbitrary, "TFA", 1, {{"180", "200"}}},
        {Multiplexing::arbitrary, "TFA", 2, {{"180", "200"}}},
        {Multiplexing::arbitrary, "TFA", 3, {{"180", "200"}}},
        {Multiplexing::arbitrary, "SFA", 0, {{"165/2", "170"}}},
        {Multiplexing::arbitrary, "SFA", 1, {{"165/2", "170"}}},
        {Multiplexing::arbitrary, "SFA", 2, {{"165/2", "170"}}},
        {Multiplexing::arbitrary, "SFA", 3, {{"165/2", "170"}}}}},
      {"TA_2S_2SC_2F_1AC_1P",
       {{10, 10}, {6, 6}},
       {{{Rational(5, 2), Rational(25, 2)}, {0, 1}}, {{Rational(5, 2), Rational(25, 2)}, {0, 1}}},
       {{Multiplexing::fifo, "TFA", 0, {{"31", "105"}}},
        {Multiplexing::fifo, "TFA", 1, {{"31", "105"}}},
        {Multiplexing::fifo, "SFA", 0, {{"379/14", "285/4"}}},
        {Multiplexing::fifo, "SFA", 1, {{"379/14", "285/4"}}},
        {Multiplexing::arbitrary, "TFA", 0, {{"136", "105"}}},
        {Multiplexing::arbitrary, "TFA", 1, {{"136", "105"}}},
        {Multiplexing::arbitrary, "SFA", 0, {{"277/7", "205/2"}}},
        {Multiplexing::arbitrary, "SFA", 1, {{"277/7", "205/2"}}}}},
      {"TA_3S_1SC_3F_1AC_3P",
       {{20, 20}, {20, 20}, {20, 20}},
       {{{5, 25}, {0, 1}}, {{5, 25}, {2}}, {{5, 25}, {0, 1, 2}}},
       {{Multiplexing::fifo, "TFA", 0, {{"55", "450"}}},
        {Multiplexing::fifo, "TFA", 1, {{"2205/64", "7825/16"}}},
        {Multiplexing::fifo, "TFA", 2, {{"5725/64", "7825/16"}}},
        {Multiplexing::fifo, "SFA", 0, {{"295/6", "525/2"}}},
        {Multiplexing::fifo, "SFA", 1, {{"6695/192", "12225/64"}}},
        {Multiplexing::fifo, "SFA", 2, {{"845/12", "1475/4"}}},
        {Multiplexing::arbitrary, "TFA", 0, {{"110", "450"}}},
        {Multiplexing::arbitrary, "TFA", 1, {{"1405/18", "5225/9"}, {"145/2", "525"}}},
        {Multiplexing::arbitrary, "TFA", 2, {{"3385/18", "5225/9"}, {"365/2", "525"}}},
        {Multiplexing::arbitrary, "SFA", 0, {{"65", "1025/3"}}},
        {Multiplexing::arbitrary, "SFA", 1, {{"1405/27", "7475/27"}, {"145/3", "775/3"}}},
        {Multiplexing::arbitrary, "SFA", 2, {{"280/3", "1450/3"}}}}},
      {"TR_3S_1SC_2F_1AC_2P",
       {{20, 20}, {20, 20}, {20, 20}},
       {{{5, 25}, {0, 2}}, {{5, 25}, {1, 2}}},
       {{Multiplexing::fifo, "TFA", 0, {{"215/4", "450"}}},
        {Multiplexing::fifo, "TFA", 1, {{"215/4", "450"}}},
        {Multiplexing::fifo, "SFA", 0, {{"575/12", "1025/4"}}},
        {Multiplexing::fifo, "SFA", 1, {{"575/12", "1025/4"}}},
        {Multiplexing::arbitrary, "TFA", 0, {{"345/4", "450"}}},
        {Multiplexing::arbitrary, "TFA", 1, {{"345/4", "450"}}},
        {Multiplexing::arbitrary, "SFA", 0, {{"170/3", "300"}}},
        {Multiplexing::arbitrary, "SFA", 1, {{"170/3", "300"}}}}},

  };
  return all;
}

std::string text(const std::optional<Rational>& value) { return value ? value->to_text() : "unbounded"; }

TEST(Disco, EveryKnownAnswer) {
  std::size_t answers = 0;
  for (const KnownNetwork& known : known_networks())
    for (const KnownAnswer& answer : known.answers) {
      ServerNetwork network;
      for (const RateLatency& service : known.servers) network.servers.push_back({"s", service});
      for (const KnownFlow& flow : known.flows) network.flows.push_back({"f", flow.arrival, flow.path});
      network.multiplexing = answer.multiplexing;
      const std::vector<FlowBound> bounds =
          answer.analysis == "TFA" ? total_flow_analysis(network) : separated_flow_analysis(network);
      const FlowBound& bound = bounds[answer.flow];
      const bool is_known = std::any_of(answer.any_of.begin(), answer.any_of.end(), [&](const KnownBound& each) {
        return text(bound.delay) == each.delay && text(bound.backlog) == each.backlog;
      });
      EXPECT_TRUE(is_known) << known.name << (answer.multiplexing == Multiplexing::fifo ? " FIFO " : " arbitrary ")
                            << answer.analysis << " f" << answer.flow << ": " << text(bound.delay) << ", "
                            << text(bound.backlog);
      ++answers;
    }
  EXPECT_EQ(answers, 88u);
}

// By hand, FF_3S, FIFO: f0 goes s0, s2; f1 goes s0, s1, s2; R = T = 20, r = 5, b = 25. To f1 s0 leaves rate 15 after 20
// + 25 / 20 = 21.25 beside f0, who counts, since f1 comes back by another way; s1 all. It comes to s2 with 25 + 5 *
// (21.25 + 20) = 231.25. f0: s0 leaves rate 15 after 21.25, s2 after 20 + 231.25 / 20 = 31.5625, and then 25 / 15.
TEST(Disco, TheAnalysedFlowCountsWhereItMeetsOthersAgain) {
  ServerNetwork network;
  for (int s = 0; s < 3; ++s) network.servers.push_back({"s", {20, 20}});
  network.flows = {{"f0", {5, 25}, {0, 2}}, {"f1", {5, 25}, {0, 1, 2}}};
  EXPECT_EQ(separated_flow_analysis(network)[0].delay, Rational(85, 4) + Rational(505, 16) + Rational(25, 15));
}

// Stretches that are neither nested nor apart: f0 goes s0, s1, s2; f1 s0, s1; f2 s1, s2. R = 20, T = 20, r = 5, b = 25.
// FIFO: f2 comes to s2 after s1 with f0 and f1, and f0 counts. s0 leaves it rate 15 after 20 + 25 / 20 = 21.25. f1
// comes from there with 25 + 5 * 21.25 = 131.25, so that s1 leaves rate 10 after 20 + 156.25 / 20 = 27.8125. f0 and f1,
// which come by one link with 50 + 10 * 20 = 250, leave f2 at s1 what comes after 20 + 250 / 20 = 32.5: it leaves with
// 25 + 5 * 32.5 = 187.5, and s2 leaves rate 15 after 20 + 187.5 / 20 = 29.375. And 25 / 10.
TEST(Disco, TheAnalysedFlowCountsWhereOthersComeAndGoInTurns) {
  ServerNetwork network;
  for (int s = 0; s < 3; ++s) network.servers.push_back({"s", {20, 20}});
  network.flows = {{"f0", {5, 25}, {0, 1, 2}}, {"f1", {5, 25}, {0, 1}}, {"f2", {5, 25}, {1, 2}}};
  EXPECT_EQ(separated_flow_analysis(network)[0].delay,
            Rational(85, 4) + Rational(445, 16) + Rational(235, 8) + Rational(25, 10));
}

/// Cells in discrete time: a server that, from the start of a busy period on, has sent at least R (t - T) by each whole
/// t, in the order of arrival, and now and then all that it has. Between whole instants it keeps still, so that it is a
/// server of rate R and latency T + 1.
class CellNetwork {
 public:
  CellNetwork(const ServerNetwork& network, std::uint64_t number)
      : network_(network),
        chance_(number, "cells", "run"),
        queues_(network.servers.size()),
        begun_(network.servers.size(), -1),
        sent_(network.servers.size(), 0),
        credit_(network.flows.size()) {
    for (std::size_t s = 0; s < network.servers.size(); ++s) dumps_.push_back(chance_.below(3) == 0 ? 40 : 1'000'000);
    for (std::size_t f = 0; f < network.flows.size(); ++f) begins_.push_back(chance_.below(3) * chance_.below(20));
  }
  /// The longest delay of each flow.
  std::vector<std::int64_t> run(std::int64_t steps) {
    std::vector<std::int64_t> longest(network_.flows.size(), 0);
    for (std::int64_t now = 0; now < steps; ++now) {
      for (std::size_t f = 0; f < network_.flows.size(); ++f) produce(f, now);
      for (std::size_t s = 0; s < queues_.size(); ++s) serve(s, now, longest);  // servers are in the order of paths
    }
    return longest;
  }

 private:
  struct Cells {
    std::size_t flow;
    std::size_t hop;
    std::int64_t born;
    std::int64_t count;
  };
  /// All that the bucket gives, or what it gives in the long run, or nothing for a while.
  void produce(std::size_t f, std::int64_t now) {
    const TokenBucket& bucket = network_.flows[f].arrival;
    credit_[f] = now == 0 ? static_cast<std::int64_t>(bucket.burst.to_double())
                          : std::min<std::int64_t>(credit_[f] + static_cast<std::int64_t>(bucket.rate.to_double()),
                                                   static_cast<std::int64_t>(bucket.burst.to_double()));
    if (now < static_cast<std::int64_t>(begins_[f]) || credit_[f] == 0) return;
    if (chance_.below(60) == 0) begins_[f] = static_cast<std::uint64_t>(now) + chance_.below(40);
    queues_[network_.flows[f].path.front()].push_back({f, 0, now, credit_[f]});
    credit_[f] = 0;
  }
  void serve(std::size_t s, std::int64_t now, std::vector<std::int64_t>& longest) {
    std::deque<Cells>& queue = queues_[s];
    if (queue.empty()) {
      begun_[s] = -1;
      return;
    }
    if (begun_[s] < 0) {
      begun_[s] = now;
      sent_[s] = 0;
    }
    const auto rate = static_cast<std::int64_t>(network_.servers[s].service.rate.to_double());
    const auto latency = static_cast<std::int64_t>(network_.servers[s].service.latency.to_double()) - 1;
    std::int64_t due = std::max<std::int64_t>(0, rate * (now - begun_[s] - latency) - sent_[s]);
    if (chance_.below(dumps_[s]) == 0) due = 1'000'000'000;
    while (due > 0 && !queue.empty()) {
      Cells& head = queue.front();
      const std::int64_t part = std::min(due, head.count);
      due -= part;
      sent_[s] += part;
      head.count -= part;
      const ServerFlow& flow = network_.flows[head.flow];
      if (head.hop + 1 < flow.path.size())
        queues_[flow.path[head.hop + 1]].push_back({head.flow, head.hop + 1, head.born, part});
      else
        longest[head.flow] = std::max(longest[head.flow], now - head.born);
      if (head.count == 0) queue.pop_front();
    }
    if (queue.empty()) begun_[s] = -1;
  }

  const ServerNetwork& network_;
  sim::RandomStream chance_;
  std::vector<std::deque<Cells>> queues_;
  std::vector<std::int64_t> begun_, sent_, credit_;
  std::vector<std::uint64_t> dumps_, begins_;
};

/// Paths go up through the servers, leaving some out: they part and meet again.
ServerNetwork random_network(std::uint64_t number) {
  sim::RandomStream chance(number, "cells", "network");
  ServerNetwork made;
  const std::size_t servers = 3 + chance.below(4);
  for (std::size_t s = 0; s < servers; ++s)
    made.servers.push_back(
        {"s", {static_cast<std::int64_t>(12 + chance.below(20)), static_cast<std::int64_t>(1 + chance.below(5))}});
  const std::size_t flows = 2 + chance.below(3);
  for (std::size_t f = 0; f < flows; ++f) {
    ServerFlow flow{"f",
                    {static_cast<std::int64_t>(1 + chance.below(4)),
                     static_cast<std::int64_t>(4 + chance.below(3) * chance.below(300))},
                    {}};
    for (std::size_t s = 0; s < servers; ++s)
      if (chance.below(3) != 0) flow.path.push_back(s);
    if (flow.path.empty()) flow.path.push_back(0);
    made.flows.push_back(std::move(flow));
  }
  return made;
}

TEST(Disco, NoRunExceedsSeparatedFlows) {
  std::size_t compared = 0;
  double nearest = 0;
  for (std::uint64_t number = 0; number < 2000; ++number) {
    const ServerNetwork network = random_network(number);
    const std::vector<FlowBound> separated = separated_flow_analysis(network);
    const std::vector<FlowBound> total = total_flow_analysis(network);
    const std::vector<std::int64_t> seen = CellNetwork(network, number).run(400);
    for (std::size_t f = 0; f < seen.size(); ++f)
      for (const FlowBound* const bound : {&separated[f], &total[f]}) {
        if (!bound->delay) continue;
        ++compared;
        EXPECT_LE(static_cast<double>(seen[f]), bound->delay->to_double()) << "network " << number << ", flow " << f;
        nearest = std::max(nearest, static_cast<double>(seen[f]) / bound->delay->to_double());
      }
  }
  EXPECT_GT(compared, 8000u);
  EXPECT_GT(nearest, 0.7) << "runs that never come near a bound say nothing";
}

}  // namespace
}  // namespace takt::analysis::disco_test
