// SPDX-License-Identifier: Apache-2.0
// Discovery by a server: clients tell it alone, it tells each what it needs.
#include <gtest/gtest.h>

#include "dds/discovery/network.hpp"

namespace takt::dds {
namespace {

using namespace test;
using Kind = DiscoveryEvent::Kind;

struct Served : Network {
  explicit Served(std::size_t clients) : server(add(settings(DiscoveryKind::server))) {
    for (std::size_t i = 0; i < clients; ++i) client.push_back(&add(settings(DiscoveryKind::client)));
  }
  static DiscoverySettings settings(DiscoveryKind kind) {
    DiscoverySettings made;
    made.kind = kind;
    if (kind == DiscoveryKind::client) made.servers = {metatraffic(1)};
    return made;
  }
  void start_all() {
    for (const auto& node : nodes) start(*node);
  }
  Node& server;
  std::vector<Node*> client;
};

TEST(Server, TellsEachClientWhatItNeeds) {
  Served net(3);
  net.announce(*net.client[0], publication(net.client[0]->writer(1), "T"));
  net.announce(*net.client[1], subscription(net.client[1]->reader(1), "T"));
  net.announce(*net.client[2], subscription(net.client[2]->reader(1), "U"));
  net.start_all();
  net.run_until(at(2_s));
  EXPECT_EQ(net.client[1]->discovery.publications().count(net.client[0]->writer(1)), 1u);
  EXPECT_EQ(net.client[0]->discovery.subscriptions().count(net.client[1]->reader(1)), 1u);
  // The third has nobody: it knows of the server alone.
  EXPECT_EQ(net.client[2]->discovery.participants().size(), 1u);
  EXPECT_TRUE(net.client[2]->discovery.publications().empty());
  EXPECT_EQ(net.client[0]->discovery.participants().size(), 2u);
  EXPECT_EQ(net.server.discovery.participants().size(), 3u);
  EXPECT_EQ(net.server.discovery.figures().forwarded, 4u) << "a participant and an endpoint to each of two clients";
  // Where user data goes is known though the two never heard of each other directly.
  const auto& found = net.client[1]->discovery.publications().at(net.client[0]->writer(1));
  EXPECT_EQ(net.client[1]->discovery.matched_writer(found).unicast, std::vector{Locator::udp_v4({10, 0, 0, 2}, 7411)});
}

// One way to the server, one back with the server's data; the endpoints go there, and the server forwards: four ways.
TEST(Server, TimesToMatch) {
  Served net(2);
  net.announce(*net.client[0], publication(net.client[0]->writer(1), "T"));
  net.announce(*net.client[1], subscription(net.client[1]->reader(1), "T"));
  net.start_all();
  net.run_until(at(2_s));
  EXPECT_EQ(net.client[0]->discovery.figures().found_at.at(net.server.discovery.self().guid), at(200_us));
  EXPECT_EQ(net.server.discovery.figures().found_at.at(net.client[0]->writer(1)), at(300_us));
  EXPECT_EQ(net.client[1]->discovery.figures().found_at.at(net.client[0]->writer(1)), at(400_us));
  EXPECT_EQ(net.client[0]->discovery.figures().found_at.at(net.client[1]->reader(1)), at(400_us));
}

TEST(Server, IsAnnouncedToUntilItAnswers) {
  Served net(1);
  net.start(*net.client[0]);
  net.run_until(at(2_s));
  EXPECT_EQ(net.log.size(), 5u) << "0, 450, 900, 1350, 1800 ms";
  net.start(net.server);
  net.run_until(at(2300_ms));
  EXPECT_EQ(net.client[0]->discovery.participants().size(), 1u);
  // From the answer on every 3 s.
  net.run_until(at(9_s));
  EXPECT_EQ(net.client[0]->discovery.figures().participants_sent.messages, 6u + 2u);
  EXPECT_EQ(net.client[0]->count(Kind::participant_lost), 0u);
}

TEST(Server, SurvivesTheLossOfAnyMessage) {
  for (std::uint64_t lost = 1; lost <= 30; ++lost) {
    Served net(2);
    net.announce(*net.client[0], publication(net.client[0]->writer(1), "T"));
    net.announce(*net.client[1], subscription(net.client[1]->reader(1), "T"));
    net.loses = [&](std::uint64_t number) { return number == lost; };
    net.start_all();
    net.run_until(at(12_s));
    EXPECT_EQ(net.client[1]->discovery.publications().size(), 1u) << lost;
    EXPECT_EQ(net.client[0]->discovery.subscriptions().size(), 1u) << lost;
  }
}

TEST(Server, TellsWhoHasGone) {
  Served net(3);
  net.announce(*net.client[0], publication(net.client[0]->writer(1), "T"));
  net.announce(*net.client[1], subscription(net.client[1]->reader(1), "T"));
  net.announce(*net.client[2], publication(net.client[2]->writer(1), "T"));
  net.start_all();
  net.run_until(at(2_s));
  EXPECT_EQ(net.client[1]->discovery.publications().size(), 2u);
  net.withdraw(*net.client[2], net.client[2]->writer(1));
  net.run_until(at(3_s));
  EXPECT_EQ(net.client[1]->discovery.publications().size(), 1u);
  EXPECT_EQ(net.client[1]->discovery.participants().size(), 2u) << "the other one is no more of its business";
  net.crash(*net.client[0]);
  net.run_until(at(30_s));
  EXPECT_EQ(net.server.discovery.figures().leases_expired, 1u);
  EXPECT_TRUE(net.client[1]->discovery.publications().empty());
  EXPECT_EQ(net.client[1]->discovery.participants().size(), 1u);
  EXPECT_EQ(net.client[1]->count(Kind::participant_lost), 2u);
  net.stop(*net.client[1]);
  net.run_until(at(31_s));
  EXPECT_EQ(net.server.discovery.participants().size(), 1u);
}

/// Endpoint messages of one writer that N - 1 others read, until all is quiet.
std::uint64_t messages(bool by_server, std::size_t count) {
  std::uint64_t sum = 0;
  const auto run = [&](Network& net, std::size_t first) {
    for (std::size_t i = first; i < net.nodes.size(); ++i) {
      Node& node = *net.nodes[i];
      if (i == first)
        net.announce(node, publication(node.writer(1), "T"));
      else
        net.announce(node, subscription(node.reader(1), "T"));
    }
    for (const auto& node : net.nodes) net.start(*node);
    net.run_until(at(2_s));
    EXPECT_EQ(net.nodes[first]->discovery.subscriptions().size(), count - 1);
    for (const auto& node : net.nodes) sum += node->discovery.figures().endpoints_sent.messages;
  };
  if (by_server) {
    Served net(count);
    run(net, 1);
  } else {
    Network net;
    for (std::size_t i = 0; i < count; ++i) net.add({});
    run(net, 0);
  }
  return sum;
}

// Everybody with everybody: four times as much for twice as many. By a server: twice as much.
TEST(Server, GrowsWithNInsteadOfItsSquare) {
  const auto simple = static_cast<double>(messages(false, 16)) / static_cast<double>(messages(false, 8));
  const auto served = static_cast<double>(messages(true, 16)) / static_cast<double>(messages(true, 8));
  EXPECT_GT(simple, 3.5);
  EXPECT_LT(served, 2.3);
  EXPECT_LT(messages(true, 16), messages(false, 16));
}

TEST(Server, MessagesAreDissected) {
  ASSERT_TRUE(has_tshark()) << "this test needs tshark";
  Served net(2);
  net.announce(*net.client[0], publication(net.client[0]->writer(1), "T"));
  net.announce(*net.client[1], subscription(net.client[1]->reader(1), "T"));
  net.start_all();
  net.run_until(at(2_s));
  net.withdraw(*net.client[0], net.client[0]->writer(1));
  net.stop(*net.client[1]);
  net.run_until(at(3_s));
  Network simple;
  for (int i = 0; i < 3; ++i) simple.add({});
  for (const auto& node : simple.nodes) {
    simple.announce(*node, publication(node->writer(1), "T"));
    simple.start(*node);
    node->discovery.assert_liveliness(ParticipantMessageData::Kind::automatic, simple.now, node->outbox);
  }
  simple.loses = [](std::uint64_t number) { return number % 5 == 0; };
  simple.run_until(at(4_s));
  std::vector<Datagram> all = net.log;
  all.insert(all.end(), simple.log.begin(), simple.log.end());
  const TemporaryFile file("discovery.pcap");
  write_pcap(file.path(), all);
  const Dissected dissected = dissect(file.path());
  EXPECT_EQ(dissected.protocols.size(), all.size());
  for (const std::string& protocols : dissected.protocols) EXPECT_EQ(protocols, "raw:ip:udp:rtps");
  EXPECT_EQ(dissected.complaints, std::vector<std::string>());
}

}  // namespace
}  // namespace takt::dds
