// The communication component over real sockets: the third stack behind PublishedData and SubscribedData, besides memory and the
// simulated network.
#include <gtest/gtest.h>
#include <poll.h>

#include "node/socket.hpp"
#include "pubsub/communication.hpp"
#include "pubsub/data_set.hpp"
#include "support/reservation.hpp"

namespace takt::node {
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

TEST(Sockets, SayWhatIsInTheWayOfLaunchTimes) {
  const auto ports = testing::Reservation::ports();
  const auto socket = open(ports.number(), ports.number());
  EXPECT_NE(socket->enable_launch_times(ClockName::tai), "") << "no interface is named";
}

}  // namespace
}  // namespace takt::node
