// SPDX-License-Identifier: Apache-2.0
// Intervals that a neighbour changes by Signaling with the message-interval request TLV.
#include "models/gptp/message_interval.hpp"

#include <gtest/gtest.h>

#include "gptp_fixture.hpp"

namespace takt::models::gptp::message_interval_test {
namespace {

const sim::Duration cable = sim::Duration::from_ps(100'000);
constexpr std::size_t sync_length = 44, announce_base = 68, pdelay_request_length = 54;

TEST(MessageInterval, LingersWhereItGetsLonger) {
  MessageInterval interval(-3, 3);
  EXPECT_TRUE(interval.request(-1));
  EXPECT_EQ(interval.announced(), -1);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(interval.sent(), 125_ms) << i;
  EXPECT_EQ(interval.sent(), 500_ms);
  EXPECT_TRUE(interval.request(-2));
  EXPECT_EQ(interval.sent(), 250_ms) << "at once, where it gets shorter";
}

TEST(MessageInterval, WhatItIsAskedFor) {
  MessageInterval interval(-3, 3);
  EXPECT_FALSE(interval.request(MessageInterval::as_it_is));
  EXPECT_FALSE(interval.request(-3)) << "it is that already";
  for (const std::int8_t meaningless : {std::int8_t{25}, std::int8_t{125}, std::int8_t{-25}})
    EXPECT_FALSE(interval.request(meaningless)) << int{meaningless};
  EXPECT_TRUE(interval.request(-24));
  EXPECT_EQ(interval.log(), -7) << "as short as it can";
  EXPECT_TRUE(interval.request(24));
  EXPECT_EQ(interval.log(), 4);
  EXPECT_TRUE(interval.request(MessageInterval::none));
  EXPECT_TRUE(interval.is_stopped());
  EXPECT_EQ(interval.announced(), 127);
  EXPECT_TRUE(interval.request(MessageInterval::initial));
  EXPECT_TRUE(interval.is_initial());
}

/// 0 -- 1 -- 2; 0 is the grandmaster.
struct Line : Harness {
  Line() {
    for (std::uint8_t priority : {std::uint8_t{10}, std::uint8_t{20}, std::uint8_t{30}}) {
      NodeSetUp set_up;
      set_up.instances[0].system.priority1 = priority;
      add(set_up);
    }
    connect(0, 1, cable);
    connect(1, 2, cable);
    start();
    run(20_s);
  }
  void ask(std::size_t node, PortNumber port, const IntervalRequest& request) {
    Outputs outputs;
    station(node).machine.ask_for_intervals(0, port, request, outputs);
    ASSERT_EQ(outputs.size(), 1U);
    const auto [peer, peer_port] = station(node).peers[port - 1U];
    receive(peer, peer_port, std::get<SendMessage>(outputs[0]).message);
  }
  int messages(std::size_t from, sim::Duration during, std::size_t length) {
    int count = 0;
    is_lost = [&](const Message& message) {
      count += header_of(message).source == PortIdentity{identity(from), from == 1 ? PortNumber{2} : PortNumber{1}} &&
               encoded_length(message) == length;
      return false;
    };
    run(during);
    is_lost = [](const Message&) { return false; };
    return count;
  }
};

TEST(IntervalRequest, OfSyncToARelayChangesThatPortOnly) {
  Line line;
  EXPECT_EQ(line.messages(1, 4_s, sync_length), 32);
  line.ask(2, 1, {.time_sync = -5});
  const int samples = line.station(2).samples;
  EXPECT_NEAR(line.messages(1, 4_s, sync_length), 128, 1);
  EXPECT_NEAR(line.station(2).samples - samples, 128, 1);
  EXPECT_EQ(line.station(2).last_sample.log_sync_interval, -5);
  EXPECT_EQ(line.messages(0, 4_s, sync_length), 32) << "the grandmaster goes on as it did";
  EXPECT_LT(std::abs(line.offset(2, 0).ps()), 1'000'000);
  line.ask(2, 1, {.time_sync = MessageInterval::initial});
  line.run(1_s);
  EXPECT_EQ(line.messages(1, 4_s, sync_length), 32) << "relayed again";
}

TEST(IntervalRequest, OfSyncToTheGrandmaster) {
  Line line;
  line.ask(1, 1, {.time_sync = -2});
  line.run(2_s);
  EXPECT_EQ(line.messages(0, 4_s, sync_length), 16);
  EXPECT_EQ(line.messages(1, 4_s, sync_length), 16) << "what comes is relayed";
  EXPECT_EQ(line.instance(1).role(1), PortRole::time_receiver) << "nothing was lost on the way to the longer interval";
  EXPECT_EQ(line.station(2).grandmasters.back(), Harness::identity(0));
  line.ask(1, 1, {.time_sync = MessageInterval::none});
  line.run(1_ms);  // what was on its way
  EXPECT_EQ(line.messages(0, 4_s, sync_length), 0);
  line.ask(1, 1, {.time_sync = MessageInterval::initial});
  line.run(1_s);
  EXPECT_EQ(line.messages(0, 4_s, sync_length), 32);
}

TEST(IntervalRequest, OfAnnounce) {
  Line line;
  EXPECT_EQ(line.messages(1, 8_s, announce_base + 2 * 8), 8);
  line.ask(2, 1, {.announce = -2});
  EXPECT_NEAR(line.messages(1, 8_s, announce_base + 2 * 8), 32, 1);
  line.ask(2, 1, {.announce = 1});
  line.run(2_s);
  EXPECT_EQ(line.messages(1, 8_s, announce_base + 2 * 8), 4);
  EXPECT_EQ(line.instance(2).role(1), PortRole::time_receiver);
  const std::size_t changes = line.station(2).grandmasters.size();
  line.run(20_s);
  EXPECT_EQ(line.station(2).grandmasters.size(), changes) << "nobody takes the longer gaps for a loss";
}

TEST(IntervalRequest, OfTheLinksDelay) {
  Line line;
  line.ask(1, 1, {.link_delay = -3});
  EXPECT_NEAR(line.messages(0, 8_s, pdelay_request_length), 64 + 2 * 8, 2)
      << "its requests, and its answers to the neighbour's";
  line.ask(1, 1, {.link_delay = MessageInterval::none});
  EXPECT_EQ(line.messages(0, 8_s, pdelay_request_length), 2 * 8) << "answers alone";
  EXPECT_TRUE(line.station(0).machine.link(1).as_capable()) << "what was measured stays";
  line.set_link(0, 1, false);
  line.set_link(0, 1, true);
  line.run(1_s);
  EXPECT_EQ(line.messages(0, 8_s, pdelay_request_length), 8 + 2 * 8) << "as at the beginning";
}

TEST(IntervalRequest, OfWhoIsNotMeant) {
  Line line;
  Outputs outputs;
  line.station(2).machine.ask_for_intervals(0, 1, {.time_sync = -5}, outputs);
  Message message = std::get<SendMessage>(outputs.at(0)).message;
  std::get<Signaling>(message).target = {Harness::identity(1), 1};
  line.receive(1, 2, message);
  EXPECT_EQ(line.messages(1, 4_s, sync_length), 32);
}

}  // namespace
}  // namespace takt::models::gptp::message_interval_test
