// SPDX-License-Identifier: Apache-2.0
#include "uadp/network_message.hpp"

#include "uadp/flags.hpp"
#include "uadp/variant.hpp"

namespace takt::uadp {
namespace {

bool has(unsigned octet, unsigned flag) { return (octet & flag) != 0; }

PublisherId get_publisher_id(Reader& reader, PublisherIdType type) {
  switch (type) {
    case PublisherIdType::Byte:
      return PublisherId::byte(reader.get<std::uint8_t>());
    case PublisherIdType::UInt16:
      return PublisherId::uint16(reader.get<std::uint16_t>());
    case PublisherIdType::UInt32:
      return PublisherId::uint32(reader.get<std::uint32_t>());
    case PublisherIdType::UInt64:
      return PublisherId::uint64(reader.get<std::uint64_t>());
    case PublisherIdType::String:
      break;
  }
  return PublisherId::string(get_value<std::string_view>(reader));
}

DecodeStatus get_group_header(Reader& reader, GroupHeader& group) {
  const unsigned octet = reader.get<std::uint8_t>();
  if (has(octet, flags::group_reserved)) return DecodeStatus::reserved;
  if (has(octet, flags::writer_group_id)) group.writer_group_id = reader.get<std::uint16_t>();
  if (has(octet, flags::group_version)) group.group_version = reader.get<std::uint32_t>();
  if (has(octet, flags::network_message_number)) group.network_message_number = reader.get<std::uint16_t>();
  if (has(octet, flags::group_sequence_number)) group.sequence_number = reader.get<std::uint16_t>();
  return DecodeStatus::ok;
}

SecurityHeader get_security_header(Reader& reader) {
  SecurityHeader security;
  security.flags = reader.get<std::uint8_t>();
  security.token_id = reader.get<std::uint32_t>();
  security.nonce = reader.take(reader.get<std::uint8_t>());
  if (has(security.flags, 0x04)) security.footer_size = reader.get<std::uint16_t>();
  return security;
}

DecodeStatus get_promoted_fields(Reader& reader, std::optional<Octets>& fields) {
  fields = reader.take(reader.get<std::uint16_t>());
  Reader inside(*fields);
  while (inside.left() != 0) get_variant(inside);
  return inside.failed() ? DecodeStatus::malformed : DecodeStatus::ok;
}

/// Sizes of DataSetMessages, which must be within the payload (OPC 10000-14, 7.2.4.5.3).
DecodeStatus get_payload(Reader& reader, NetworkMessage& message) {
  if (message.count() > 1) message.sizes = reader.take(2 * message.count());
  if (reader.failed()) return DecodeStatus::truncated;
  message.payload_offset = reader.position();
  message.payload = reader.rest();
  std::size_t sum = 0;
  for (std::size_t i = 0; i < message.sizes.size(); i += 2)
    sum += load_little_endian<std::uint16_t>(message.sizes.data() + i);
  return sum > message.payload.size() ? DecodeStatus::truncated : DecodeStatus::ok;
}

struct FlagOctets {
  unsigned first = 0;
  unsigned extended_1 = 0;
  unsigned extended_2 = 0;
};

DecodeStatus get_flags(Reader& reader, FlagOctets& octets) {
  octets.first = reader.get<std::uint8_t>();
  if (!reader.failed() && (octets.first & flags::version_mask) != flags::version) return DecodeStatus::version;
  if (has(octets.first, flags::extended_1)) octets.extended_1 = reader.get<std::uint8_t>();
  if (has(octets.extended_1, flags::extended_2)) octets.extended_2 = reader.get<std::uint8_t>();
  if (reader.failed()) return DecodeStatus::truncated;
  // Without a PublisherId its type says nothing; open62541 1.5 leaves that of the configured one there.
  const unsigned id_type = octets.extended_1 & flags::publisher_id_type_mask;
  if (has(octets.first, flags::publisher_id) && id_type > static_cast<unsigned>(PublisherIdType::String))
    return DecodeStatus::reserved;
  if (has(octets.extended_2, flags::extended_2_reserved)) return DecodeStatus::reserved;
  const unsigned type = octets.extended_2 >> flags::message_type_shift & flags::message_type_mask;
  return type > static_cast<unsigned>(NetworkMessageType::DiscoveryAnnouncement) ? DecodeStatus::reserved
                                                                                 : DecodeStatus::ok;
}

/// Refusals of whole kinds of messages; asked once the PublisherId is known.
DecodeStatus kind_of(const FlagOctets& octets, NetworkMessageType type) {
  if (type != NetworkMessageType::DataSetMessages) return DecodeStatus::discovery;
  if (has(octets.extended_2, flags::action_header)) return DecodeStatus::action;
  return has(octets.extended_2, flags::chunk) ? DecodeStatus::chunked : DecodeStatus::ok;
}

}  // namespace

DecodeStatus decode(Octets octets, NetworkMessage& message) {
  message = {};
  Reader reader(octets);
  FlagOctets flag;
  if (const DecodeStatus verdict = get_flags(reader, flag); verdict != DecodeStatus::ok) return verdict;
  message.type =
      static_cast<NetworkMessageType>(flag.extended_2 >> flags::message_type_shift & flags::message_type_mask);
  NetworkMessageHeader& header = message.header;
  if (has(flag.first, flags::publisher_id)) {
    const unsigned type = flag.extended_1 & flags::publisher_id_type_mask;
    header.publisher_id = get_publisher_id(reader, static_cast<PublisherIdType>(type));
  }
  if (reader.failed()) return DecodeStatus::truncated;
  if (const DecodeStatus verdict = kind_of(flag, message.type); verdict != DecodeStatus::ok) return verdict;
  if (has(flag.extended_1, flags::data_set_class_id)) header.data_set_class_id = get_value<Guid>(reader);
  if (has(flag.first, flags::group_header)) {
    const DecodeStatus verdict = get_group_header(reader, header.group.emplace());
    if (verdict != DecodeStatus::ok) return verdict;
  }
  if (has(flag.first, flags::payload_header)) {
    const std::size_t count = reader.get<std::uint8_t>();
    if (!reader.failed() && count == 0) return DecodeStatus::malformed;
    message.writer_ids = reader.take(2 * count);
  }
  if (has(flag.extended_1, flags::timestamp)) header.timestamp = get_value<DateTime>(reader);
  if (has(flag.extended_1, flags::picoseconds)) header.picoseconds = reader.get<std::uint16_t>();
  if (has(flag.extended_2, flags::promoted_fields) && !reader.failed()) {
    const DecodeStatus verdict = get_promoted_fields(reader, header.promoted_fields);
    if (verdict != DecodeStatus::ok) return verdict;
  }
  if (has(flag.extended_1, flags::security)) message.security = get_security_header(reader);
  if (reader.failed()) return DecodeStatus::truncated;
  if (message.security) {
    message.payload_offset = reader.position();
    message.payload = reader.rest();
    return DecodeStatus::secured;
  }
  return get_payload(reader, message);
}

Octets NetworkMessage::data_set_message(std::size_t index) const {
  TAKT_CHECK(index < count(), "a NetworkMessage has as many DataSetMessages as it says");
  if (sizes.empty()) return payload;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < index; ++i) begin += load_little_endian<std::uint16_t>(sizes.data() + 2 * i);
  return payload.subspan(begin, load_little_endian<std::uint16_t>(sizes.data() + 2 * index));
}

}  // namespace takt::uadp
