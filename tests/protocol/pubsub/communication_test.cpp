// SPDX-License-Identifier: Apache-2.0
// The communication component as the paper describes it (section IV): a master publishes, a slave subscribes.
#include "tests/protocol/pubsub/support.hpp"

namespace takt::pubsub {
namespace {

TEST(Communications, ADoubleFromAMasterToASlave) {
  Pair pair;
  DataSet<double> sent(1.25);
  Publisher publisher(PublisherId::uint16(1));
  ASSERT_TRUE(publisher.add_data_set("speed", sent));
  ASSERT_TRUE(pair.master.add_publisher(publisher));
  DataSet<double> taken;
  std::vector<double> heard;
  taken.on_received([&](double value) { heard.push_back(value); });
  Subscriber subscriber(PublisherId::uint16(1));
  ASSERT_TRUE(subscriber.add_data_set("speed", taken));
  ASSERT_TRUE(pair.slave.add_subscriber(subscriber));
  EXPECT_EQ(publisher.groups().size(), 1u) << "the default WriterGroup";
  EXPECT_EQ(subscriber.groups().size(), 1u);
  EXPECT_EQ(subscriber.reader("speed")->state(), PubSubState::Paused) << "the Communication is Disabled";
  pair.run_until(at(2_ms));
  EXPECT_TRUE(heard.empty());

  pair.enable(pair.now);
  EXPECT_EQ(subscriber.reader("speed")->state(), PubSubState::PreOperational);
  pair.run_until(at(4_ms + 1_us));  // publishes at 3 ms and 4 ms
  EXPECT_EQ(heard, (std::vector<double>{1.25, 1.25}));
  EXPECT_EQ(subscriber.reader("speed")->state(), PubSubState::Operational);
  sent.set(2.5);
  pair.run_until(at(5_ms + 1_us));
  EXPECT_EQ(taken.get(), 2.5);
  EXPECT_EQ(pair.slave.verdicts()[uadp::DecodeStatus::ok], 3u);
}

TEST(Communications, TwoDataSetsOfADefaultGroupShareAMessage) {
  Pair pair;
  DataSet<std::int32_t> state(13), taken_state;
  DataSet<std::array<double, 3>> axes({1, 2, 3}), taken_axes;
  Publisher publisher(PublisherId::string("arm"));
  publisher.add_data_set("state", state);
  publisher.add_data_set("axes", axes);
  pair.master.add_publisher(publisher);
  Subscriber subscriber(PublisherId::string("arm"));
  subscriber.add_data_set("state", taken_state);
  subscriber.add_data_set("axes", taken_axes);
  pair.slave.add_subscriber(subscriber);
  pair.enable();
  pair.run_until(at(1_ms + 1_us));
  EXPECT_EQ(taken_state.get(), 13);
  EXPECT_EQ(taken_axes.get(), (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(pair.slave.verdicts()[uadp::DecodeStatus::ok], 1u) << "one NetworkMessage";
}

TEST(Communications, SeveralGroupsHaveTheirOwnRhythmAndOrder) {
  RecordingStack stack;
  Communication master(stack, stack);
  DataSet<std::int32_t> slow, fast;
  Publisher publisher(PublisherId::uint16(1));
  publisher.add_data_set("slow", slow);  // the default group: 1 ms, priority 0
  WriterGroupSettings settings;
  settings.publishing_interval = 250_us;
  settings.publishing_offset = 50_us;
  settings.priority = 5;
  const std::uint16_t group = publisher.add_writer_group(settings);
  EXPECT_EQ(group, 2);
  EXPECT_TRUE(publisher.add_data_set("fast", fast, {}, group));
  EXPECT_FALSE(publisher.add_data_set("fast", fast, {}, group)) << "the name is taken";
  EXPECT_FALSE(publisher.add_data_set("other", fast, {}, 9)) << "no such group";
  EXPECT_EQ(publisher.writer("fast")->id(), 2);
  EXPECT_TRUE(master.add_publisher(publisher));
  EXPECT_FALSE(master.add_publisher(publisher));
  EXPECT_EQ(master.next_time(), LocalTime::never());
  EXPECT_EQ(master.enable(LocalTime()), StatusCode::Good);
  EXPECT_EQ(master.enable(LocalTime()), StatusCode::BadInvalidState);
  // The fast group at 50, 300, 550, 800, 1050 us; the slow one at 1000 us.
  std::vector<sim::Duration> times;
  while (master.next_time() < at(1100_us)) {
    times.push_back(master.next_time().since_start());
    master.advance(master.next_time());
  }
  EXPECT_EQ(times, (std::vector<sim::Duration>{50_us, 300_us, 550_us, 800_us, 1000_us, 1050_us}));
  EXPECT_EQ(stack.destinations[3], (Destination{2, 5}));
  EXPECT_EQ(stack.destinations[4], (Destination{1, 0}));
  stack.destinations.clear();
  master.advance(at(3_ms));  // late: both once, the urgent one first
  EXPECT_EQ(stack.destinations, (std::vector<Destination>{{2, 5}, {1, 0}}));
  // Due at 1300, 1550, 1800, 2050, 2300, 2550, 2800 us and published once: six were missed.
  EXPECT_EQ(publisher.groups()[0]->missed_intervals(), 6u);
}

TEST(Communications, PublishOnChange) {
  RecordingStack stack;
  Communication master(stack, stack);
  DataSet<std::int32_t> state(11);
  WriterGroupSettings settings;
  settings.publishing_interval = 10_ms;
  settings.publish_on_change = true;
  Publisher publisher(PublisherId::uint16(1), settings);
  publisher.add_data_set("state", state);
  master.add_publisher(publisher);
  master.enable(LocalTime());
  master.advance(at(1_ms));
  EXPECT_EQ(stack.messages.size(), 0u);
  state.set(12);
  master.advance(at(2_ms));
  EXPECT_EQ(stack.messages.size(), 1u);
  master.advance(at(3_ms));
  EXPECT_EQ(stack.messages.size(), 1u) << "nothing new";
  master.advance(at(10_ms));
  EXPECT_EQ(stack.messages.size(), 2u) << "the rhythm goes on";
}

TEST(Communications, ForeignAndDamagedMessagesAreCounted) {
  Pair pair;
  DataSet<double> taken(7.0);
  Subscriber subscriber(PublisherId::uint16(1));
  subscriber.add_data_set("speed", taken);
  pair.slave.add_subscriber(subscriber);
  pair.enable();
  RecordingStack stack;
  Communication other(stack, stack);
  DataSet<double> sent(1.0);
  Publisher publisher(PublisherId::uint16(2));
  publisher.add_data_set("speed", sent);
  other.add_publisher(publisher);
  other.enable(LocalTime());
  other.advance(at(1_ms));
  pair.slave.received(stack.messages.at(0), at(1_ms));
  EXPECT_EQ(pair.slave.unwanted(), 1u);
  pair.slave.received(uadp::Octets(stack.messages.at(0)).first(3), at(1_ms));
  EXPECT_EQ(pair.slave.verdicts()[uadp::DecodeStatus::truncated], 1u);
  EXPECT_EQ(taken.get(), 7.0);
}

// UADP-Periodic-Fixed: one Int32 and 20 doubles. 15 + 5 + 4 + 160 = 184 octets; the second DataSetMessage of one
// Boolean has 6 more.
TEST(Communications, PeriodicFixed) {
  using Axes = std::tuple<std::int32_t, double, double, double>;
  Pair pair;
  DataSet<Axes> sent({7, 1.0, 2.0, 3.0}), taken;
  DataSet<bool> sent_flag(true), taken_flag;
  Publisher publisher(PublisherId::uint16(9), periodic_fixed_group(500_us));
  ASSERT_TRUE(publisher.add_data_set("axes", sent, periodic_fixed_writer()));
  ASSERT_TRUE(publisher.add_data_set("flag", sent_flag, periodic_fixed_writer()));
  DataSet<std::string> text;
  EXPECT_FALSE(publisher.add_data_set("text", text, periodic_fixed_writer())) << "no fixed length";
  pair.master.add_publisher(publisher);
  Subscriber subscriber(PublisherId::uint16(9));
  subscriber.add_data_set("axes", taken);
  subscriber.add_data_set("flag", taken_flag);
  pair.slave.add_subscriber(subscriber);
  MemoryPort listener(pair.medium);
  pair.enable();
  pair.run_until(at(600_us));
  EXPECT_EQ(taken.get(), sent.get());
  EXPECT_TRUE(taken_flag.get());
  const uadp::Octets octets = listener.next();
  ASSERT_EQ(octets.size(), 15u + 5 + 4 + 24 + 5 + 1);
  EXPECT_EQ(octets[0], std::byte{0xB1});
  EXPECT_EQ(octets[4], std::byte{0x0F});
  EXPECT_EQ(octets[15], std::byte{0x1B});
}

TEST(Communications, MoreThanOneMessageHolds) {
  RecordingStack stack;
  Communication master(stack, stack);
  std::array<DataSet<std::array<double, 10>>, 5> data;  // each 1 + 2 + 2 + (1 + 4 + 80) = 90 octets
  WriterGroupSettings settings;
  settings.max_network_message_size = 250;
  settings.network_message_content_mask |= network_message_content::NetworkMessageNumber;
  Publisher publisher(PublisherId::uint16(1), settings);
  for (std::size_t i = 0; i < data.size(); ++i) publisher.add_data_set("d" + std::to_string(i), data[i]);
  DataSet<std::array<double, 40>> big;  // 320 octets: never fits
  publisher.add_data_set("big", big);
  master.add_publisher(publisher);
  master.enable(LocalTime());
  master.advance(at(1_ms));
  ASSERT_EQ(stack.messages.size(), 3u) << "2 + 2 + 1";
  std::uint16_t number = 0;
  for (const auto& octets : stack.messages) {
    EXPECT_LE(octets.size(), 250u);
    uadp::NetworkMessage message;
    ASSERT_EQ(decode(octets, message), uadp::DecodeStatus::ok);
    EXPECT_EQ(message.header.group->network_message_number, ++number);
  }
  EXPECT_EQ(publisher.groups()[0]->too_long(), 1u);
}

}  // namespace
}  // namespace takt::pubsub
