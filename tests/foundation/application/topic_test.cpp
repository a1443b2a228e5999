// SPDX-License-Identifier: Apache-2.0
// What threads publish and take, by hand: over both protocols, and from one end of OPC UA to the other.
#include <gtest/gtest.h>

#include <optional>

#include "application/activation_grid.hpp"
#include "application/opc_ua_topic.hpp"
#include "application/topic_values.hpp"

namespace takt::application::topic_test {
namespace {

plant::Topic topic_of(plant::Protocol protocol) {
  plant::Topic topic;
  topic.name = "x";
  topic.protocol = protocol;
  topic.fields = {{"part", {plant::TopicType::uint16, 1}},
                  {"level", {plant::TopicType::uint32, 1}},
                  {"axes", {plant::TopicType::float64, 2}}};
  return topic;
}

std::vector<std::byte> octets(std::initializer_list<int> values) {
  std::vector<std::byte> all;
  for (const int each : values) all.push_back(static_cast<std::byte>(each));
  return all;
}

std::vector<std::byte> copy_of(uadp::Octets octets) { return {octets.begin(), octets.end()}; }

TEST(ActivationGrid, CountsFromItsOffset) {
  const ActivationGrid grid{10, 3};
  EXPECT_EQ(grid.due(2), 23);
  EXPECT_EQ(grid.latest_at(2), -1);
  EXPECT_EQ(grid.latest_at(3), 0);
  EXPECT_EQ(grid.latest_at(12), 0);
  EXPECT_EQ(grid.latest_at(13), 1);
}

// UInt16 is type 5, UInt32 7, Double 11 with the flag of an array; the second instance of two, and the second value.
TEST(Publication, PutsPatternAndInstanceAmongTheVariants) {
  const TopicShape shape = shape_of(topic_of(plant::Protocol::opc_ua), {"part"});
  plant::Payload payload;
  payload.instance = 40;
  payload.instances = 2;
  Publication publication(shape, payload);
  publication.next();
  const auto expected =
      octets({5, 41, 0, 7, 2, 0, 0, 0, 11 + 128, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(copy_of(publication.next()), expected);
  EXPECT_FALSE(shape.is_zero(expected));
  EXPECT_TRUE(shape.is_zero(shape.zeros()));
  EXPECT_EQ(shape.octets(), 22u);
  publication.restart();
  EXPECT_EQ(copy_of(publication.next())[4], std::byte{1});
}

// Plain CDR, little-endian: the UInt32 begins at a multiple of 4, the Doubles of 8.
TEST(Publication, OverDdsIsCdr) {
  const TopicShape shape = shape_of(topic_of(plant::Protocol::dds), {});
  Publication publication(shape, {});
  const auto carried = copy_of(publication.next());
  EXPECT_EQ(carried, octets({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
  Subscription subscription(shape);
  const auto fields = subscription.take(carried);
  ASSERT_TRUE(fields);
  EXPECT_EQ(copy_of(*fields)[1], std::byte{1});
  EXPECT_EQ(copy_of(*publication.copy(*fields)), carried);
  EXPECT_FALSE(subscription.take(std::span(carried).first(9))) << "of another length";
}

// A publisher of OPC UA may say that a field is bad; DDS has no word for it.
TEST(Publication, AFieldWithoutAValueIsNoneOfDds) {
  const TopicShape shape = shape_of(topic_of(plant::Protocol::dds), {});
  std::vector<std::byte> fields = octets({19, 0, 0, 0, 0x80});
  const auto zeros = shape.zeros();
  fields.insert(fields.end(), zeros.begin() + 3, zeros.end());
  EXPECT_FALSE(Publication(shape, {}).copy(fields));
}

// A Bad field is a Variant of a StatusCode, of 5 octets: what is behind it stands elsewhere, and there may be nothing.
TEST(TopicShape, ABadFieldIsShorterThanItsValue) {
  const TopicShape shape = shape_of(topic_of(plant::Protocol::opc_ua), {"part"});
  EXPECT_FALSE(
      shape.is_zero(octets({19, 0, 0, 0, 0x80, 7, 2, 0, 0, 0})));  // the UInt32 that counts is behind the Bad part
  EXPECT_TRUE(shape.is_zero(octets({19, 0, 0, 0, 0x80, 7, 0, 0, 0, 0})));
  EXPECT_TRUE(shape.is_zero(octets({5, 41, 0, 19, 0, 0, 0, 0x80})));  // it has no value itself
  EXPECT_TRUE(shape.is_zero(octets({5, 41, 0})));
  EXPECT_TRUE(shape.is_zero({}));
}

struct Wire final : pubsub::PublishedData {
  void publish(uadp::Octets message, const pubsub::Destination&) override {
    messages.emplace_back(message.begin(), message.end());
  }
  std::vector<std::vector<std::byte>> messages;
};

TEST(OpcUaTopic, FromOneEndToTheOther) {
  const TopicShape shape = shape_of(topic_of(plant::Protocol::opc_ua), {});
  Wire wire;
  OpcUaPublication first(shape, {7, 1}, wire, sim::LocalTime());
  OpcUaPublication second(shape, {7, 2}, wire, sim::LocalTime());
  OpcUaPublication other(shape, {8, 1}, wire, sim::LocalTime());
  const OpcUaAddress heard[] = {{7, 1}, {7, 2}};
  OpcUaSubscription subscription(shape, heard, sim::LocalTime());
  Publication values(shape, {});
  for (OpcUaPublication* const each : {&first, &second, &other, &first, &first}) {
    const bool published = each->publish(values.next(), sim::LocalTime());
    EXPECT_TRUE(published);
  }
  ASSERT_EQ(wire.messages.size(), 5u);
  EXPECT_FALSE(first.publish(octets({1, 2, 3}), sim::LocalTime())) << "not its fields";
  std::vector<int> came;
  for (const std::size_t m : {0u, 1u, 2u, 4u})
    if (const auto value = subscription.receive(wire.messages[m], sim::LocalTime()))
      came.push_back(std::to_integer<int>((*value)[1]));
  EXPECT_EQ(came, (std::vector<int>{1, 2, 5})) << "not what the other Publisher says";
  EXPECT_EQ(subscription.lost(), 1u) << "the message between";
  EXPECT_FALSE(subscription.receive(octets({1, 2, 3}), sim::LocalTime())) << "no message";
}

}  // namespace
}  // namespace takt::application::topic_test
