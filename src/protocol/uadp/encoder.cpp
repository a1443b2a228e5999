// SPDX-License-Identifier: Apache-2.0
#include "uadp/encoder.hpp"

#include "uadp/flags.hpp"

namespace takt::uadp {
namespace {

constexpr std::size_t most_messages = 255;

unsigned flag_if(bool present, unsigned flag) { return present ? flag : 0U; }

void put_publisher_id(Writer& writer, const PublisherId& id) {
  switch (id.type) {
    case PublisherIdType::Byte:
      return writer.put(static_cast<std::uint8_t>(id.number));
    case PublisherIdType::UInt16:
      return writer.put(static_cast<std::uint16_t>(id.number));
    case PublisherIdType::UInt32:
      return writer.put(static_cast<std::uint32_t>(id.number));
    case PublisherIdType::UInt64:
      return writer.put(id.number);
    case PublisherIdType::String:
      return put_value(writer, id.text);
  }
}

void put_group_header(Writer& writer, const GroupHeader& group) {
  writer.put(
      static_cast<std::uint8_t>(flag_if(group.writer_group_id.has_value(), flags::writer_group_id) |
                                flag_if(group.group_version.has_value(), flags::group_version) |
                                flag_if(group.network_message_number.has_value(), flags::network_message_number) |
                                flag_if(group.sequence_number.has_value(), flags::group_sequence_number)));
  if (group.writer_group_id) writer.put(*group.writer_group_id);
  if (group.group_version) writer.put(*group.group_version);
  if (group.network_message_number) writer.put(*group.network_message_number);
  if (group.sequence_number) writer.put(*group.sequence_number);
}

}  // namespace

NetworkMessageEncoder::NetworkMessageEncoder(std::span<std::byte> target, const NetworkMessageHeader& header,
                                             std::span<const std::uint16_t> writer_ids)
    : writer_(target), message_(writer_), expected_(writer_ids.size()) {
  TAKT_CHECK(!writer_ids.empty() && writer_ids.size() <= most_messages,
             "a PayloadHeader names 1 to 255 DataSetWriters");
  put_header(header, true, writer_ids);
}

NetworkMessageEncoder::NetworkMessageEncoder(std::span<std::byte> target, const NetworkMessageHeader& header)
    : writer_(target), message_(writer_), expected_(0) {
  put_header(header, false, {});
}

void NetworkMessageEncoder::put_header(const NetworkMessageHeader& header, bool has_payload_header,
                                       std::span<const std::uint16_t> writer_ids) {
  const unsigned extended_2 = flag_if(header.promoted_fields.has_value(), flags::promoted_fields);
  const unsigned extended_1 = (header.publisher_id ? static_cast<unsigned>(header.publisher_id->type) : 0U) |
                              flag_if(header.data_set_class_id.has_value(), flags::data_set_class_id) |
                              flag_if(header.timestamp.has_value(), flags::timestamp) |
                              flag_if(header.picoseconds.has_value(), flags::picoseconds) |
                              flag_if(extended_2 != 0, flags::extended_2);
  const unsigned first = flags::version | flag_if(header.publisher_id.has_value(), flags::publisher_id) |
                         flag_if(header.group.has_value(), flags::group_header) |
                         flag_if(has_payload_header, flags::payload_header) |
                         flag_if(extended_1 != 0, flags::extended_1);
  writer_.put(static_cast<std::uint8_t>(first));
  if (extended_1 != 0) writer_.put(static_cast<std::uint8_t>(extended_1));
  if (extended_2 != 0) writer_.put(static_cast<std::uint8_t>(extended_2));
  if (header.publisher_id) put_publisher_id(writer_, *header.publisher_id);
  if (header.data_set_class_id) put_value(writer_, *header.data_set_class_id);
  if (header.group) put_group_header(writer_, *header.group);
  if (has_payload_header) {
    writer_.put(static_cast<std::uint8_t>(writer_ids.size()));
    for (const std::uint16_t id : writer_ids) writer_.put(id);
  }
  if (header.timestamp) put_value(writer_, *header.timestamp);
  if (header.picoseconds) writer_.put(*header.picoseconds);
  if (header.promoted_fields) {
    writer_.put(static_cast<std::uint16_t>(header.promoted_fields->size()));
    writer_.put_octets(*header.promoted_fields);
  }
  has_sizes_ = has_payload_header && writer_ids.size() > 1;
  sizes_at_ = writer_.position();
  if (has_sizes_) writer_.put_zeros(2 * writer_ids.size());
}

void NetworkMessageEncoder::append(Octets data_set_message) {
  writer_.put_octets(data_set_message);
  note(data_set_message.size());
}

void NetworkMessageEncoder::note(std::size_t size) {
  ++ended_;
  TAKT_CHECK(expected_ == 0 || ended_ <= expected_, "as many DataSetMessages as there are DataSetWriterIds");
  if (!has_sizes_ || writer_.overflowed()) return;
  is_too_long_ = is_too_long_ || size > 0xFFFF;
  writer_.patch(sizes_at_ + 2 * (ended_ - 1), static_cast<std::uint16_t>(size));
}

Octets NetworkMessageEncoder::finish() {
  TAKT_CHECK(expected_ == 0 || ended_ == expected_, "as many DataSetMessages as there are DataSetWriterIds");
  return is_too_long_ || !message_.is_sound() ? Octets() : writer_.finished();
}

}  // namespace takt::uadp
