// SPDX-License-Identifier: Apache-2.0
// Messages by hand: the layouts of OPC 10000-14, Annex A, every type of DataSetMessage, ConfiguredSize, several
// messages.
#include <gtest/gtest.h>

#include "uadp/encoder.hpp"
#include "uadp/message_json.hpp"
#include "uadp/periodic_fixed.hpp"

namespace takt::uadp {
namespace {

/// Hexadecimal text without its spaces.
std::string packed(std::string text) {
  std::erase(text, ' ');
  return text;
}

PeriodicFixedLayout example_layout(std::vector<std::size_t> configured_sizes = {}) {
  const RawLayout fields({{BuiltInType::Int32}, {BuiltInType::Double}, {BuiltInType::Boolean}});
  return PeriodicFixedLayout({PublisherId::uint16(100), 1, 0x2F0E1A00, 1, {fields}, std::move(configured_sizes)});
}

// Header: flags 2, PublisherId 2, group header 1+2+4+2+2 = 15. DataSetMessage: 1+2+2 = 5; fields 4+8+1 = 13. Sum 33.
const std::string example = packed("b1 01 6400 0f 0100 001a0e2f 0100 1000  1b 1000 0000  fbffffff 000000000000f83f 01");

TEST(PeriodicFixed, EveryOctetIsWhereAnnexASays) {
  const PeriodicFixedLayout layout = example_layout();
  ASSERT_EQ(layout.size(), 33u);
  EXPECT_EQ(layout.data_set_offset(0), 15u);
  EXPECT_EQ(layout.field_offset(0, 0), 20u);
  EXPECT_EQ(layout.field_offset(0, 1), 24u);
  EXPECT_EQ(layout.field_offset(0, 2), 32u);
  std::vector<std::byte> octets(33);
  layout.start(octets, 16);
  layout.set_header(octets, 0, 16);
  store_value(octets.data() + layout.field_offset(0, 0), std::int32_t{-5});
  store_value(octets.data() + layout.field_offset(0, 1), 1.5);
  store_value(octets.data() + layout.field_offset(0, 2), true);
  EXPECT_EQ(hex_of(octets), example);
  EXPECT_TRUE(layout.matches(octets));
  EXPECT_EQ(layout.group_sequence_number(octets), 16);
  EXPECT_EQ(layout.sequence_number(octets, 0), 16);
  EXPECT_EQ(layout.status(octets, 0), 0);
}

TEST(PeriodicFixed, IsWhatTheGeneralEncoderWrites) {
  std::vector<std::byte> octets(64);
  NetworkMessageHeader header;
  header.publisher_id = PublisherId::uint16(100);
  header.group = GroupHeader{std::uint16_t{1}, 0x2F0E1A00U, std::uint16_t{1}, std::uint16_t{16}};
  NetworkMessageEncoder encoder(octets, header);
  DataSetMessageHeader message;
  message.encoding = FieldEncoding::RawData;
  message.sequence_number = std::uint16_t{16};
  message.status = std::uint16_t{0};
  encoder.begin(message);
  encoder.field(std::int32_t{-5});
  encoder.field(1.5);
  encoder.field(true);
  encoder.end();
  EXPECT_EQ(hex_of(encoder.finish()), example);
}

TEST(PeriodicFixed, OnlyItsOwnMessagesMatch) {
  const PeriodicFixedLayout layout = example_layout();
  const std::vector<std::byte> good = octets_of(example);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::vector<std::byte> octets = good;
    octets[i] ^= std::byte{1};
    const bool varies = i == 13 || i == 14 || i > 15;  // sequence number of the group; all behind DataSetFlags1
    EXPECT_EQ(layout.matches(octets), varies) << "octet " << i;
  }
  EXPECT_FALSE(layout.matches(Octets(good).first(32)));
  std::vector<std::byte> padded = good;
  padded.resize(46);  // by Ethernet
  EXPECT_TRUE(layout.matches(padded));
}

/// `values` are between two Bytes of other fields, once stored as one and once one by one.
template <class T, std::size_t Count>
void expect_the_same_as_one_by_one(const std::array<T, Count>& values) {
  SCOPED_TRACE(name_of(BuiltIn<T>::type));
  std::vector<RawField> fields = {{BuiltInType::Byte}};
  fields.insert(fields.end(), Count, {BuiltIn<T>::type});
  fields.push_back({BuiltInType::XmlElement, false, 0, 3});
  const PeriodicFixedLayout layout({PublisherId::uint16(100), 1, 0x2F0E1A00, 1, {RawLayout(fields)}});
  std::vector<std::byte> singly(layout.size());
  layout.start(singly, 16);
  std::vector<std::byte> together = singly;
  for (std::size_t i = 0; i < Count; ++i) store_value(singly.data() + layout.field_offset(0, 1 + i), values[i]);
  layout.store_values(together, 0, 1, std::span(values));
  EXPECT_EQ(hex_of(together), hex_of(singly));
  std::array<T, Count> loaded{};
  layout.load_values(together, 0, 1, std::span(loaded));
  EXPECT_EQ(loaded, values);
  // Not the first ones, and as many as are known only when the program runs.
  std::vector<T> last(Count - 1);
  layout.load_values(together, 0, 2, std::span(last.begin(), last.end()));
  EXPECT_TRUE(std::equal(last.begin(), last.end(), values.begin() + 1));
}

TEST(PeriodicFixed, FieldsOfOneTypeAreStoredAndLoadedAsOne) {
  expect_the_same_as_one_by_one(std::array<double, 4>{1.5, -0.0, 1e300, 4.0});
  expect_the_same_as_one_by_one(std::array<float, 3>{1.5F, -2.25F, 4.0F});
  expect_the_same_as_one_by_one(std::array<std::int16_t, 3>{-2, 3, 0x1234});
  expect_the_same_as_one_by_one(std::array<std::uint8_t, 3>{1, 2, 255});
  expect_the_same_as_one_by_one(std::array{DateTime{133500000000000000}, DateTime{-7}});
  expect_the_same_as_one_by_one(std::array{Status{0x80010000}, Status{3}});
  expect_the_same_as_one_by_one(std::array{Guid{{std::byte{1}, std::byte{2}}}, Guid{{std::byte{3}}}});
}

// Bool is not copied: any octet but 0 is true.
TEST(PeriodicFixed, BooleansAreStoredAndLoadedAsOne) {
  const PeriodicFixedLayout layout(
      {PublisherId::uint16(100),
       1,
       0,
       1,
       {RawLayout({{BuiltInType::Boolean}, {BuiltInType::Boolean}, {BuiltInType::Boolean}})}});
  std::vector<std::byte> octets(layout.size());
  const std::array values{true, false, true};
  layout.store_values(octets, 0, 0, std::span(values));
  EXPECT_EQ(hex_of(std::span(octets).last(3)), "010001");
  octets.back() = std::byte{2};
  std::array<bool, 3> loaded{};
  layout.load_values(octets, 0, 0, std::span(loaded));
  EXPECT_EQ(loaded, values);
}

TEST(PeriodicFixed, OtherFieldsAreNotTakenForARun) {
  const RawLayout fields({{BuiltInType::Int32},
                          {BuiltInType::Double},
                          {BuiltInType::Double},
                          {BuiltInType::Double, true, 1},
                          {BuiltInType::Double}});
  const PeriodicFixedLayout layout({PublisherId::uint16(100), 1, 0, 1, {fields}});
  std::vector<std::byte> octets(layout.size());
  std::vector<double> values(2);
  const std::array<std::int64_t, 2> integers{};
  EXPECT_NO_THROW(layout.load_values(octets, 0, 1, std::span(values)));
  EXPECT_THROW(layout.load_values(octets, 0, 0, std::span(values)), sim::InvariantBroken);  // an Int32
  EXPECT_THROW(layout.load_values(octets, 0, 2, std::span(values)), sim::InvariantBroken);  // the second is an array
  EXPECT_THROW(layout.load_values(octets, 0, 3, std::span(values).first(1)), sim::InvariantBroken);  // an array
  EXPECT_THROW(layout.load_values(octets, 0, 4, std::span(values)), sim::InvariantBroken);           // behind the last
  EXPECT_THROW(layout.load_values(octets, 0, 5, std::span(values).first(1)), sim::InvariantBroken);
  EXPECT_THROW(layout.load_values(Octets(octets).first(octets.size() - 1), 0, 1, std::span(values)),
               sim::InvariantBroken);
  EXPECT_THROW(layout.store_values(std::span(octets), 0, 1, std::span(integers)), sim::InvariantBroken);
  EXPECT_THROW(layout.store_values(std::span(octets).first(20), 0, 1, std::span<const double>(values)),
               sim::InvariantBroken);
}

// An UInt64 PublisherId makes the header 21 octets; a ConfiguredSize of 32 moves the second DataSetMessage to 53.
TEST(PeriodicFixed, ConfiguredSizesPad) {
  const RawLayout fields({{BuiltInType::Int32}});
  const PeriodicFixedLayout layout({PublisherId::uint64(1), 1, 0, 1, {fields, fields}, {32}});
  EXPECT_EQ(layout.data_set_offset(0), 21u);
  EXPECT_EQ(layout.data_set_offset(1), 53u);
  EXPECT_EQ(layout.size(), 53u + 9u);
}

// UADP-Dynamic with two writers: a key frame and a keep-alive; sizes 27 and 18.
TEST(Dynamic, TwoDataSetMessages) {
  std::vector<std::byte> octets(64);
  NetworkMessageHeader header;
  header.publisher_id = PublisherId::uint64(0x0000AABBCCDDEEFF);
  NetworkMessageEncoder encoder(octets, header, std::array<std::uint16_t, 2>{11, 12});
  DataSetMessageHeader message;
  message.sequence_number = std::uint16_t{3};
  message.timestamp = DateTime{133500000000000000};
  message.status = std::uint16_t{0};
  message.minor_version = 0x2F0E1A00U;
  encoder.begin(message);
  encoder.field(std::int32_t{7});
  encoder.field(true);
  encoder.end();
  message.type = DataSetMessageType::KeepAlive;
  message.sequence_number = std::uint16_t{9};
  encoder.begin(message);
  encoder.end();
  EXPECT_EQ(hex_of(encoder.finish()), packed("d1 03 ffeeddccbbaa0000 02 0b00 0c00 1b00 1200"
                                             "d9 10 0300 00c083ed8a49da01 0000 001a0e2f 0200 06 07000000 01 01"
                                             "d9 13 0900 00c083ed8a49da01 0000 001a0e2f"));
}

TEST(DeltaFrame, NamesTheFieldsThatChanged) {
  std::vector<std::byte> octets(64);
  NetworkMessageHeader header;
  header.publisher_id = PublisherId::byte(7);
  NetworkMessageEncoder encoder(octets, header, std::array<std::uint16_t, 1>{33});
  DataSetMessageHeader message;
  message.type = DataSetMessageType::DeltaFrame;
  message.sequence_number = std::uint16_t{4};
  encoder.begin(message);
  encoder.delta_field(1, 2.5);
  encoder.end();
  const Octets written = encoder.finish();
  EXPECT_EQ(hex_of(written), packed("51 07 01 2100 89 01 0400 0100 0100 0b 0000000000000440"));

  NetworkMessage decoded;
  ASSERT_EQ(decode(written, decoded), DecodeStatus::ok);
  DataSetMessage delta;
  ASSERT_EQ(decode(decoded.data_set_message(0), delta), DecodeStatus::ok);
  FieldReader fields(delta);
  const auto field = fields.next();
  ASSERT_TRUE(field);
  EXPECT_EQ(field->index, 1);
  EXPECT_EQ(field->value.value->get<double>(), 2.5);
  EXPECT_FALSE(fields.next());
  EXPECT_FALSE(fields.failed());
}

/// One DataSetMessage with writer 1 and PublisherId Byte 1: 5 octets, then the message.
template <class Fill>
std::string one_message(const DataSetMessageHeader& header, std::size_t configured_size, Fill fill) {
  std::vector<std::byte> octets(128);
  NetworkMessageHeader network;
  network.publisher_id = PublisherId::byte(1);
  NetworkMessageEncoder encoder(octets, network, std::array<std::uint16_t, 1>{1});
  encoder.begin(header);
  fill(encoder);
  encoder.end(configured_size);
  return hex_of(encoder.finish()).substr(10);
}

TEST(DataSetMessages, EveryType) {
  DataSetMessageHeader header;
  EXPECT_EQ(one_message(header, 0, [](auto&) {}), "01") << "a heartbeat has no FieldCount";
  header.type = DataSetMessageType::KeepAlive;
  EXPECT_EQ(one_message(header, 0, [](auto&) {}), "8103");
  header.type = DataSetMessageType::Event;
  EXPECT_EQ(one_message(header, 0, [](auto& encoder) { encoder.field(std::string_view("x")); }),
            packed("81 02 0100 0c 01000000 78"));
  header.type = DataSetMessageType::DeltaFrame;
  EXPECT_EQ(one_message(header, 0, [](auto&) {}), packed("81 01 0000")) << "nothing changed";
  header.type = DataSetMessageType::KeyFrame;
  header.encoding = FieldEncoding::DataValue;
  EXPECT_EQ(one_message(header, 0, [](auto& encoder) { encoder.field(std::int16_t{-1}); }),
            packed("05 0100 01 04 ffff"));
  header.encoding = FieldEncoding::RawData;
  const std::array<std::uint16_t, 2> values{1, 2};
  EXPECT_EQ(one_message(header, 0, [&](auto& encoder) { encoder.field(std::span<const std::uint16_t>(values)); }),
            packed("03 02000000 0100 0200"));
}

TEST(DataSetMessages, AConfiguredSizeIsKept) {
  DataSetMessageHeader header;
  header.encoding = FieldEncoding::RawData;
  const auto fill = [](auto& encoder) { encoder.field(std::uint32_t{0x01020304}); };
  EXPECT_EQ(one_message(header, 8, fill), packed("03 04030201 000000"));
  EXPECT_EQ(one_message(header, 5, fill), packed("03 04030201"));
  EXPECT_EQ(one_message(header, 4, fill), packed("00 000000")) << "too long: a header that is not valid";
}

TEST(DataSetMessages, PromotedFieldsAndClassId) {
  std::vector<std::byte> promoted(16);
  Writer writer(promoted);
  put_variant(writer, std::uint16_t{5});
  NetworkMessageHeader header;
  header.promoted_fields = writer.finished();
  header.data_set_class_id = Guid{};
  header.picoseconds = std::uint16_t{7};
  std::vector<std::byte> octets(64);
  NetworkMessageEncoder encoder(octets, header, std::array<std::uint16_t, 1>{1});
  encoder.begin({});
  encoder.field(true);
  encoder.end();
  const Octets written = encoder.finish();
  EXPECT_EQ(hex_of(written),
            packed("c1 c8 02 00000000000000000000000000000000 01 0100 0700 0300 05 0500 01 0100 01 01"));
  NetworkMessage decoded;
  ASSERT_EQ(decode(written, decoded), DecodeStatus::ok);
  Reader fields(decoded.header.promoted_fields.value());
  EXPECT_EQ(get_variant(fields).get<std::uint16_t>(), 5);
}

TEST(NetworkMessages, AMessageThatASizeCannotSayIsNotSent) {
  std::vector<std::byte> octets(70000);
  NetworkMessageEncoder encoder(octets, {}, std::array<std::uint16_t, 2>{1, 2});
  const std::vector<std::byte> body(65536);
  encoder.begin({});
  encoder.body(body);
  encoder.count_fields(1);
  encoder.end();
  encoder.begin({});
  encoder.end();
  EXPECT_TRUE(encoder.finish().empty());
}

}  // namespace
}  // namespace takt::uadp
