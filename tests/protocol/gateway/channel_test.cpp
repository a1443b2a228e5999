// SPDX-License-Identifier: Apache-2.0
// A gateway between two real endpoints of protocol code: UADP NetworkMessages in, CDR out, and the way back.
#include "gateway/channel.hpp"

#include <gtest/gtest.h>

#include "gateway/field_values.hpp"
#include "pubsub/communication.hpp"
#include "pubsub/memory_stack.hpp"

namespace takt::gateway::channel_test {
namespace {

using namespace sim::literals;  // NOLINT
using uadp::BuiltInType;

const std::vector<DataSetField> fields = {
    {"number", {BuiltInType::UInt32}}, {"speed", {BuiltInType::Double}}, {"name", {BuiltInType::String, false, 0, 16}}};
const IdlStruct type = {
    "Sample",
    {{"number", IdlKind::uint32}, {"speed", IdlKind::float64}, {"name", IdlKind::string, IdlCollection::none, 0, 16}}};
using Values = std::tuple<std::uint32_t, double, std::string>;

TypeMapping mapping(Direction direction) {
  std::vector<std::string> problems;
  return TypeMapping::make(direction, fields, type, {}, problems).value();
}

sim::LocalTime at(std::int64_t ms) { return sim::LocalTime::from_ps(ms * 1'000'000'000); }

/// A publisher of a typed DataSet, its octets, and a subscriber to FieldValues, or the other way round.
struct Wire {
  pubsub::MemoryMedium medium;
  pubsub::MemoryPort from{medium};
  pubsub::MemoryPort to{medium};
  pubsub::Publisher publisher{uadp::PublisherId::uint16(7), {.publishing_interval = 1_ms}};
  pubsub::Subscriber subscriber{uadp::PublisherId::uint16(7)};
  pubsub::Communication sending{from, from};
  pubsub::Communication receiving{to, to};

  Wire(pubsub::AnyDataSet& given, pubsub::AnyDataSet& taken) {
    EXPECT_TRUE(publisher.add_data_set("values", given));
    EXPECT_TRUE(subscriber.add_data_set("values", taken));
    EXPECT_TRUE(sending.add_publisher(publisher));
    EXPECT_TRUE(receiving.add_subscriber(subscriber));
    sending.enable(at(0));
    receiving.enable(at(0));
  }
  void carry(std::int64_t ms) {
    sending.advance(at(ms));
    receiving.poll(at(ms));
  }
};

TEST(Channel, WhatAPublisherSendsBecomesCdrAndComesBackAsTheSameValues) {
  Channel to_dds(mapping(Direction::to_dds), {.capacity = 4});
  Channel to_opc_ua(mapping(Direction::to_opc_ua), {.capacity = 4});

  pubsub::DataSet<Values> given;
  FieldValues entered(fields);
  std::int64_t now = 0;
  entered.on_received([&] { EXPECT_EQ(to_dds.receive(entered.octets(), at(now)), MappingError::none); });
  Wire in(given, entered);

  FieldValues left(fields);
  pubsub::DataSet<Values> taken;
  std::vector<Values> seen;
  taken.on_received([&](const Values& values) { seen.push_back(values); });
  Wire out(left, taken);

  std::vector<Values> sent;
  for (now = 1; now <= 5; ++now) {
    sent.emplace_back(static_cast<std::uint32_t>(now), 0.5 * static_cast<double>(now), "value " + std::to_string(now));
    given.set(sent.back());
    in.carry(now);
    const auto sample = to_dds.pull(at(now));
    ASSERT_TRUE(sample) << now;
    EXPECT_EQ(to_opc_ua.receive(sample->octets, at(now)), MappingError::none);
    const auto value = to_opc_ua.pull(at(now));
    ASSERT_TRUE(value) << now;
    EXPECT_TRUE(left.assign(value->octets));
    out.carry(now);
  }
  EXPECT_EQ(seen, sent);
  EXPECT_EQ(to_dds.figures().buffer, (BufferFigures{.received = 5, .forwarded = 5}));
  EXPECT_EQ(to_dds.figures().age.greatest, 0_ms);
}

// A receiver at 1 ms and a sender at 4 ms: by hand, of 20 values with one place 5 go, 15 are overwritten.
TEST(Channel, RatesAreIndependent) {
  Channel channel(mapping(Direction::to_dds), {.capacity = 1});
  FieldValues values(fields);
  int sent = 0;
  for (int ms = 0; ms < 20; ++ms) {
    channel.receive(values.octets(), at(ms));
    if (ms % 4 == 3 && channel.pull(at(ms))) ++sent;
  }
  EXPECT_EQ(sent, 5);
  EXPECT_EQ(channel.figures().buffer, (BufferFigures{.received = 20, .forwarded = 5, .overwritten = 15}));
  // The other way round: a sender at 1 ms finds something every fourth time.
  Channel slow(mapping(Direction::to_dds), {.capacity = 1});
  sent = 0;
  for (int ms = 0; ms < 20; ++ms) {
    if (ms % 4 == 0) slow.receive(values.octets(), at(ms));
    if (slow.pull(at(ms))) ++sent;
  }
  EXPECT_EQ(sent, 5);
}

// CDR has no status: a sample with a field that has no value stays outside, one whose field is Uncertain passes.
TEST(Channel, ABadFieldKeepsASampleOutside) {
  Channel channel(mapping(Direction::to_dds), {.capacity = 4});
  FieldValues values(fields);
  values.set_status(1, uadp::Status{0x40900000});
  EXPECT_EQ(channel.receive(values.octets(), at(0)), MappingError::none);
  values.set_status(1, uadp::Status{0x80310000});
  EXPECT_EQ(channel.receive(values.octets(), at(1)), MappingError::bad_status);
  values.set_status(1, uadp::Status{});
  EXPECT_EQ(channel.receive(values.octets(), at(2)), MappingError::none);
  EXPECT_EQ(channel.figures().mapping_errors[static_cast<std::size_t>(MappingError::bad_status)], 1u);
  EXPECT_EQ(channel.figures().buffer.received, 2u);
}

TEST(Channel, WhatCannotBeMappedIsCountedAndDoesNotEnter) {
  Channel channel(mapping(Direction::to_opc_ua), {.capacity = 2});
  const std::byte nonsense[] = {std::byte{0}, std::byte{3}, std::byte{0}, std::byte{0}};
  EXPECT_EQ(channel.receive(nonsense, at(0)), MappingError::encapsulation);
  EXPECT_EQ(channel.receive(Octets(nonsense).first(2), at(0)), MappingError::encapsulation);
  EXPECT_EQ(channel.waiting(), 0u);
  EXPECT_EQ(channel.figures().mapping_error_total(), 2u);
  EXPECT_EQ(channel.figures().received(), 2u);
  EXPECT_EQ(channel.figures().buffer.received, 0u);
}

TEST(FieldValues, BeginAsZerosThatTheirMappingTakes) {
  const std::vector<DataSetField> all = {{"a", {BuiltInType::Int16, true, 3}},
                                         {"b", {BuiltInType::String, true, 2, 4}},
                                         {"c", {BuiltInType::Guid}},
                                         {"d", {BuiltInType::ByteString}}};
  FieldValues values(all);
  IdlStruct members{"Zeros", {}};
  std::string problem;
  for (const DataSetField& each : all) members.members.push_back(idl_member_of(each, problem).value());
  std::vector<std::string> problems;
  auto made = TypeMapping::make(Direction::to_dds, all, members, {}, problems);
  ASSERT_TRUE(made) << problems.front();
  std::vector<std::byte> payload;
  EXPECT_EQ(made->to_cdr(values.octets(), payload), MappingError::none);
  EXPECT_FALSE(values.assign(Octets(payload)));
  EXPECT_TRUE(values.assign(std::vector<std::byte>(values.octets().begin(), values.octets().end())));
}

}  // namespace
}  // namespace takt::gateway::channel_test
