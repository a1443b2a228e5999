// SPDX-License-Identifier: Apache-2.0
// Every combination of optional parts survives encoding and decoding, and is encoded to the same octets again.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "uadp/encoder.hpp"
#include "uadp/network_message.hpp"

namespace takt::uadp {
namespace {

const std::array<std::optional<PublisherId>, 6> publisher_ids = {std::nullopt,
                                                                 PublisherId::byte(200),
                                                                 PublisherId::uint16(0xFEDC),
                                                                 PublisherId::uint32(0xFEDCBA98),
                                                                 PublisherId::uint64(0xFEDCBA9876543210),
                                                                 PublisherId::string("plant/cell 7")};

template <class T>
std::optional<T> given(unsigned bits, unsigned bit, T value) {
  return (bits >> bit & 1) != 0 ? std::optional<T>(value) : std::nullopt;
}

/// GroupFlags 0 to 15, and 16 for no GroupHeader.
std::optional<GroupHeader> group(unsigned flags) {
  if (flags == 16) return std::nullopt;
  return GroupHeader{given(flags, 0, std::uint16_t{0x1234}), given(flags, 1, 0x56789ABCU),
                     given(flags, 2, std::uint16_t{3}), given(flags, 3, std::uint16_t{65535})};
}

/// Six bits: which optional parts a DataSetMessage has.
DataSetMessageHeader data_set_header(FieldEncoding encoding, DataSetMessageType type, unsigned parts) {
  DataSetMessageHeader header;
  header.encoding = encoding;
  header.type = type;
  header.sequence_number = given(parts, 0, std::uint16_t{0xFFFE});
  header.timestamp = given(parts, 1, DateTime{133500000000000001});
  header.picoseconds = given(parts, 2, std::uint16_t{9999});
  header.status = given(parts, 3, std::uint16_t{0x80AF});
  header.major_version = given(parts, 4, 0x2F0E1A00U);
  header.minor_version = given(parts, 5, 0x2F0E1A01U);
  return header;
}

/// Three fields: a scalar, a string, an array.
void put_fields(NetworkMessageEncoder& encoder, DataSetMessageType type) {
  const std::array<double, 3> values{1.5, -2.5, 1e300};
  if (type == DataSetMessageType::KeepAlive) return;
  if (type == DataSetMessageType::DeltaFrame) {
    encoder.delta_field(7, std::int32_t{-5});
    encoder.delta_field(2, std::string_view("text"));
    encoder.delta_field(300, std::span<const double>(values));
  } else {
    encoder.field(std::int32_t{-5});
    encoder.field(std::string_view("text"));
    encoder.field(std::span<const double>(values));
  }
}

/// What the fields of a decoded message are: indices and values, as far as they tell themselves.
void expect_fields(const DataSetMessage& message) {
  if (message.header.type == DataSetMessageType::KeepAlive || message.header.encoding == FieldEncoding::RawData) return;
  FieldReader reader(message);
  const bool is_delta = message.header.type == DataSetMessageType::DeltaFrame;
  const auto first = reader.next();
  const auto second = reader.next();
  const auto third = reader.next();
  ASSERT_TRUE(first && second && third);
  EXPECT_EQ(first->index, is_delta ? 7 : 0);
  EXPECT_EQ(third->index, is_delta ? 300 : 2);
  EXPECT_EQ(first->value.value->get<std::int32_t>(), -5);
  EXPECT_EQ(second->value.value->get<std::string_view>(), "text");
  EXPECT_EQ(third->value.value->at<double>(2), 1e300);
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.failed());
}

std::vector<std::byte> copy(Octets octets) { return {octets.begin(), octets.end()}; }

/// Decoded messages, put together again.
std::vector<std::byte> again(const NetworkMessage& message) {
  std::vector<std::byte> buffer(2048);
  std::vector<std::uint16_t> ids;
  for (std::size_t i = 0; message.writer_ids && i < message.count(); ++i) ids.push_back(*message.writer_id(i));
  NetworkMessageEncoder encoder = message.writer_ids ? NetworkMessageEncoder(buffer, message.header, ids)
                                                     : NetworkMessageEncoder(buffer, message.header);
  for (std::size_t i = 0; i < message.count(); ++i) {
    DataSetMessage each;
    EXPECT_EQ(decode(message.data_set_message(i), each), DecodeStatus::ok);
    encoder.begin(each.header);
    if (each.header.encoding == FieldEncoding::RawData) {
      encoder.body(each.body);
    } else {
      FieldReader fields(each);
      while (const auto field = fields.next()) {
        if (each.header.type == DataSetMessageType::DeltaFrame)
          encoder.delta_field(field->index, field->value);
        else
          encoder.field(field->value);
      }
    }
    encoder.end();
  }
  return copy(encoder.finish());
}

TEST(RoundTrip, OfEveryNetworkMessageHeader) {
  std::array<std::byte, 8> promoted_octets;
  Writer promoted(promoted_octets);
  put_variant(promoted, std::uint16_t{5});
  std::vector<std::byte> buffer(2048);
  std::size_t seen = 0;
  for (const auto& publisher_id : publisher_ids) {
    for (unsigned flags = 0; flags <= 16; ++flags) {
      for (unsigned parts = 0; parts < 16; ++parts) {
        for (std::size_t messages = 0; messages <= 3; ++messages) {
          NetworkMessageHeader header;
          header.publisher_id = publisher_id;
          header.group = group(flags);
          header.timestamp = given(parts, 0, DateTime{133500000000000001});
          header.picoseconds = given(parts, 1, std::uint16_t{1});
          header.data_set_class_id = given(parts, 2, Guid{{std::byte{1}, std::byte{2}}});
          if (messages == 1) header.promoted_fields = given(parts, 3, promoted.finished());
          const std::array<std::uint16_t, 3> ids{1, 0x8000, 65535};
          // 0: one message without a PayloadHeader.
          NetworkMessageEncoder encoder = messages == 0
                                              ? NetworkMessageEncoder(buffer, header)
                                              : NetworkMessageEncoder(buffer, header, std::span(ids).first(messages));
          for (std::size_t i = 0; i < std::max<std::size_t>(messages, 1); ++i) {
            encoder.begin({});
            put_fields(encoder, DataSetMessageType::KeyFrame);
            encoder.end();
          }
          const std::vector<std::byte> octets = copy(encoder.finish());
          ASSERT_FALSE(octets.empty());
          NetworkMessage decoded;
          ASSERT_EQ(decode(octets, decoded), DecodeStatus::ok) << flags << " " << parts << " " << messages;
          EXPECT_EQ(decoded.header.publisher_id, header.publisher_id);
          EXPECT_EQ(decoded.header.group, header.group);
          EXPECT_EQ(decoded.header.timestamp, header.timestamp);
          EXPECT_EQ(decoded.header.picoseconds, header.picoseconds);
          EXPECT_EQ(decoded.header.data_set_class_id, header.data_set_class_id);
          EXPECT_EQ(decoded.header.promoted_fields.has_value(), header.promoted_fields.has_value());
          EXPECT_EQ(decoded.writer_ids.has_value(), messages != 0);
          ASSERT_EQ(decoded.count(), std::max<std::size_t>(messages, 1));
          for (std::size_t i = 0; i < decoded.count(); ++i) {
            DataSetMessage each;
            ASSERT_EQ(decode(decoded.data_set_message(i), each), DecodeStatus::ok);
            expect_fields(each);
          }
          EXPECT_EQ(again(decoded), octets);
          ++seen;
        }
      }
    }
  }
  EXPECT_EQ(seen, 6u * 17u * 16u * 4u);
}

TEST(RoundTrip, OfEveryDataSetMessage) {
  std::vector<std::byte> buffer(2048);
  NetworkMessageHeader header;
  header.publisher_id = PublisherId::uint16(1);
  for (const FieldEncoding encoding : {FieldEncoding::Variant, FieldEncoding::RawData, FieldEncoding::DataValue}) {
    for (const DataSetMessageType type : {DataSetMessageType::KeyFrame, DataSetMessageType::DeltaFrame,
                                          DataSetMessageType::Event, DataSetMessageType::KeepAlive}) {
      // RawData has key frames only, events have Variants only.
      if (encoding == FieldEncoding::RawData && type != DataSetMessageType::KeyFrame) continue;
      if (encoding != FieldEncoding::Variant && type == DataSetMessageType::Event) continue;
      for (unsigned parts = 0; parts < 64; ++parts) {
        const DataSetMessageHeader wanted = data_set_header(encoding, type, parts);
        NetworkMessageEncoder encoder(buffer, header, std::array<std::uint16_t, 1>{9});
        encoder.begin(wanted);
        put_fields(encoder, type);
        encoder.end();
        const std::vector<std::byte> octets = copy(encoder.finish());
        ASSERT_FALSE(octets.empty());
        NetworkMessage decoded;
        ASSERT_EQ(decode(octets, decoded), DecodeStatus::ok);
        DataSetMessage message;
        ASSERT_EQ(decode(decoded.data_set_message(0), message), DecodeStatus::ok);
        EXPECT_EQ(message.header, wanted);
        expect_fields(message);
        EXPECT_EQ(again(decoded), octets);
      }
    }
  }
}

}  // namespace
}  // namespace takt::uadp
