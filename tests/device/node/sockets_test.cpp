// SPDX-License-Identifier: Apache-2.0
// The communication component over real sockets: the third stack behind PublishedData and SubscribedData, besides
// memory and the simulated network.
#include <gtest/gtest.h>
#include <poll.h>

#include "node/socket.hpp"
#include "node/sources.hpp"
#include "pubsub/communication.hpp"
#include "pubsub/data_set.hpp"
#include "support/reservation.hpp"

namespace takt::node::sockets_test {
namespace {

std::unique_ptr<Socket> open(std::uint16_t port, std::uint16_t other) {
  UdpTransport transport;
  transport.port = port;
  transport.destinations = {"127.0.0.1:" + std::to_string(other)};
  std::string problem;
  auto socket = open_socket(transport, problem);
  if (!socket) throw std::runtime_error(problem);
  return socket;
}

void wait_for(const Socket& socket) {
  pollfd waiting{socket.file_descriptor(), POLLIN, 0};
  ASSERT_EQ(::poll(&waiting, 1, -1), 1);
}

TEST(Sockets, CarryDataSets) {
  const auto ports = testing::Reservation::ports();
  const std::uint16_t first = ports.number();
  const std::uint16_t second = static_cast<std::uint16_t>(first + 1);
  const auto here = open(first, second);
  const auto there = open(second, first);
  pubsub::DataSet<std::tuple<double, std::array<std::int32_t, 3>, std::string>> sent({2.5, {1, 2, 3}, "text"});
  pubsub::DataSet<std::tuple<double, std::array<std::int32_t, 3>, std::string>> received;
  int messages = 0;
  received.on_received([&messages](const auto&) { ++messages; });

  pubsub::Publisher publisher(uadp::PublisherId::uint16(77));
  ASSERT_TRUE(publisher.add_data_set("d", sent));
  pubsub::Subscriber subscriber(uadp::PublisherId::uint16(77));
  ASSERT_TRUE(subscriber.add_data_set("d", received));
  pubsub::Communication sending(*here, *here);
  pubsub::Communication receiving(*there, *there);
  ASSERT_TRUE(sending.add_publisher(publisher));
  ASSERT_TRUE(receiving.add_subscriber(subscriber));
  sending.enable(sim::LocalTime());
  receiving.enable(sim::LocalTime());

  for (int i = 1; i <= 3; ++i) {
    const sim::LocalTime now = sending.next_time();
    sending.advance(now);
    wait_for(*there);
    receiving.poll(now);
    EXPECT_EQ(received.get(), sent.get());
    EXPECT_EQ(messages, i);
    sent.set({2.5 + i, {i, i, i}, "another"});
  }
  EXPECT_EQ(here->send_failures(), 0u);
  EXPECT_EQ(receiving.verdicts()[uadp::DecodeStatus::ok], 3u);
}

// A turn of the loop takes so many and no more, whatever they are.
TEST(Sockets, EmptyAndLongOnesCount) {
  const auto ports = testing::Reservation::ports();
  const std::uint16_t port = ports.number();
  const auto there = open(port, port);
  const auto stranger = open(static_cast<std::uint16_t>(port + 1), port);
  const std::vector<std::byte> octets(1501, std::byte{0x91});
  for (const std::size_t size : {0, 1501, 7, 0, 1500}) stranger->publish(uadp::Octets(octets).first(size), {});
  std::vector<std::pair<wire::Verdict, std::size_t>> seen;
  while (const auto arrival = there->take()) {
    seen.emplace_back(arrival->verdict, arrival->message.size());
    EXPECT_EQ(to_text(arrival->from), "127.0.0.1:" + std::to_string(port + 1));
  }
  using enum wire::Verdict;
  EXPECT_EQ(seen, (std::vector<std::pair<wire::Verdict, std::size_t>>{
                      {empty, 0}, {too_long, 0}, {taken, 7}, {empty, 0}, {taken, 1500}}));
}

// Whoever sends under ever new names does not fill the memory, and does not displace those of whom something is taken.
TEST(Sources, AreBounded) {
  SourceTable table;
  const auto from = [](std::uint8_t a, std::uint8_t b) {
    return Arrival{wire::Verdict::taken, {}, {SenderAddress::Kind::udp, {10, 0, a, b, 0, 1}}};
  };
  EXPECT_FALSE(table.count(from(0, 0), wire::Verdict::taken, 0));
  int told = 0;
  for (int i = 0; i < 2000; ++i)
    told += table.count(from(static_cast<std::uint8_t>(1 + i / 250), static_cast<std::uint8_t>(i % 250)),
                        wire::Verdict::not_uadp, i)
                ? 1
                : 0;
  ASSERT_EQ(table.all().size(), SourceTable::most_sources + 1);
  EXPECT_EQ(told, 64) << "63 that have a place, and the others";
  EXPECT_EQ(table.all().back().refused(), 2000u - 63);
  table.count(from(99, 99), wire::Verdict::vlan, 20'000'000'000);
  EXPECT_EQ(table.all().front().count(wire::Verdict::taken), 1u);
  EXPECT_EQ(table.all()[1].count(wire::Verdict::vlan), 1u) << "in the place of the one that was silent longest";
  EXPECT_FALSE(table.count(from(99, 99), wire::Verdict::vlan, 20'000'000'001)) << "told once";
}

// Two nodes of one name: both addresses are told while both are there; one that has moved is no second one.
TEST(Sources, TwoNodesOfOneNameAreSeen) {
  SourceTable table;
  const std::vector<std::byte> word = {std::byte{0xb1}, std::byte{0x01}, std::byte{0x03}, std::byte{0}};
  const auto from = [&](std::uint8_t host) {
    return Arrival{wire::Verdict::taken, word, {SenderAddress::Kind::udp, {10, 0, 0, host, 18, 232}}};
  };
  constexpr std::int64_t second = 1'000'000'000;
  table.count(from(7), wire::Verdict::taken, second);
  table.count(from(8), wire::Verdict::other_version, second);
  EXPECT_TRUE(table.twins(second).empty()) << "one that is refused is none";
  table.count(from(8), wire::Verdict::stale, 2 * second);
  const auto twins = table.twins(3 * second);
  ASSERT_EQ(twins.size(), 1u);
  EXPECT_EQ(twins[0].publisher_id, 3u);
  EXPECT_EQ(to_text(twins[0].one), "10.0.0.7:4840");
  EXPECT_EQ(to_text(twins[0].other), "10.0.0.8:4840");
  EXPECT_TRUE(table.twins(11 * second).empty());
}

TEST(Sockets, SayWhatIsInTheWayOfLaunchTimes) {
  const auto ports = testing::Reservation::ports();
  const auto socket = open(ports.number(), ports.number());
  EXPECT_NE(socket->enable_launch_times(ClockName::tai), "") << "no interface is named";
}

}  // namespace
}  // namespace takt::node::sockets_test
