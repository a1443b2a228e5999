// SPDX-License-Identifier: Apache-2.0
#include "dds/message/encoder.hpp"

#include "dds/message/flags.hpp"
#include "dds/message/parameter_list.hpp"
#include "dds/message/wire_values.hpp"

namespace takt::dds {
namespace {

constexpr std::uint16_t data_to_inline_qos = 16;
constexpr std::uint16_t frag_to_inline_qos = 28;

unsigned flag_if(bool present, unsigned flag) { return present ? flag : 0U; }

void put_inline_qos(Writer& writer, const InlineQos& qos) {
  if (qos.is_empty()) return;
  ParameterWriter list(writer);
  if (qos.status_info)
    list.parameter(ParameterId::status_info, [&](Writer& w) { detail::put_big_endian(w, *qos.status_info, 4); });
  if (qos.key_hash) list.parameter(ParameterId::key_hash, [&](Writer& w) { detail::put_octets(w, *qos.key_hash); });
  if (qos.original_writer) {
    list.parameter(ParameterId::original_writer_info, [&](Writer& w) {
      put(w, qos.original_writer->writer);
      put(w, qos.original_writer->number);
    });
  }
  list.finish();
}

std::size_t inline_qos_size(const InlineQos& qos) {
  return qos.is_empty()
             ? 0U
             : 4U + (qos.status_info ? 8U : 0U) + (qos.key_hash ? 20U : 0U) + (qos.original_writer ? 28U : 0U);
}

template <class T>
void put_ids(Writer& writer, const T& submessage) {
  put(writer, submessage.reader);
  put(writer, submessage.writer);
}

void put_locators(Writer& writer, const std::vector<Locator>& locators) {
  writer.put(static_cast<std::uint32_t>(locators.size()));
  for (const Locator& locator : locators) put(writer, locator);
}

/// Of each submessage: its kind, its flags but for the byte order, its content.
struct Pieces {
  SubmessageKind kind = SubmessageKind::pad;
  unsigned flag = 0;
};

Pieces pieces_of(const Pad&) { return {SubmessageKind::pad}; }
void put_content(Writer&, const Pad&) {}

Pieces pieces_of(const Data& data) {
  return {SubmessageKind::data, flag_if(!data.inline_qos.is_empty(), flags::data_inline_qos) |
                                    flag_if(data.payload_kind == PayloadKind::data, flags::data_data) |
                                    flag_if(data.payload_kind == PayloadKind::key, flags::data_key)};
}
void put_content(Writer& writer, const Data& data) {
  writer.put(std::uint16_t{0});
  writer.put(data_to_inline_qos);
  put_ids(writer, data);
  put(writer, data.sequence_number);
  put_inline_qos(writer, data.inline_qos);
  if (data.payload_kind != PayloadKind::none) writer.put_octets(data.payload);
}

Pieces pieces_of(const DataFrag& data) {
  return {SubmessageKind::data_frag, flag_if(!data.inline_qos.is_empty(), flags::frag_inline_qos) |
                                         flag_if(data.payload_kind == PayloadKind::key, flags::frag_key)};
}
void put_content(Writer& writer, const DataFrag& data) {
  writer.put(std::uint16_t{0});
  writer.put(frag_to_inline_qos);
  put_ids(writer, data);
  put(writer, data.sequence_number);
  writer.put(data.first_fragment.value);
  writer.put(data.fragment_count);
  writer.put(data.fragment_size);
  writer.put(data.sample_size);
  put_inline_qos(writer, data.inline_qos);
  writer.put_octets(data.payload);
}

Pieces pieces_of(const Heartbeat& heartbeat) {
  return {SubmessageKind::heartbeat,
          flag_if(heartbeat.is_final, flags::final_) | flag_if(heartbeat.is_liveliness, flags::liveliness)};
}
void put_content(Writer& writer, const Heartbeat& heartbeat) {
  put_ids(writer, heartbeat);
  put(writer, heartbeat.first);
  put(writer, heartbeat.last);
  writer.put(heartbeat.count);
}

Pieces pieces_of(const HeartbeatFrag&) { return {SubmessageKind::heartbeat_frag}; }
void put_content(Writer& writer, const HeartbeatFrag& heartbeat) {
  put_ids(writer, heartbeat);
  put(writer, heartbeat.sequence_number);
  writer.put(heartbeat.last_fragment.value);
  writer.put(heartbeat.count);
}

Pieces pieces_of(const AckNack& ack) { return {SubmessageKind::ack_nack, flag_if(ack.is_final, flags::final_)}; }
void put_content(Writer& writer, const AckNack& ack) {
  put_ids(writer, ack);
  put(writer, ack.missing);
  writer.put(ack.count);
}

Pieces pieces_of(const NackFrag&) { return {SubmessageKind::nack_frag}; }
void put_content(Writer& writer, const NackFrag& nack) {
  put_ids(writer, nack);
  put(writer, nack.sequence_number);
  put(writer, nack.missing);
  writer.put(nack.count);
}

Pieces pieces_of(const Gap&) { return {SubmessageKind::gap}; }
void put_content(Writer& writer, const Gap& gap) {
  put_ids(writer, gap);
  put(writer, gap.start);
  put(writer, gap.list);
}

Pieces pieces_of(const InfoTimestamp& info) {
  return {SubmessageKind::info_timestamp, flag_if(!info.time, flags::timestamp_invalid)};
}
void put_content(Writer& writer, const InfoTimestamp& info) {
  if (info.time) put(writer, *info.time);
}

Pieces pieces_of(const InfoSource&) { return {SubmessageKind::info_source}; }
void put_content(Writer& writer, const InfoSource& info) {
  writer.put(std::uint32_t{0});
  put(writer, info.version);
  put(writer, info.vendor);
  put(writer, info.prefix);
}

Pieces pieces_of(const InfoDestination&) { return {SubmessageKind::info_destination}; }
void put_content(Writer& writer, const InfoDestination& info) { put(writer, info.prefix); }

Pieces pieces_of(const InfoReply& info) {
  return {SubmessageKind::info_reply, flag_if(info.multicast.has_value(), flags::multicast_reply)};
}
void put_content(Writer& writer, const InfoReply& info) {
  put_locators(writer, info.unicast);
  if (info.multicast) put_locators(writer, *info.multicast);
}

// Octets of each content, in the order of the table of 9.4.5.
std::size_t content_size(const Pad&) { return 0; }
std::size_t content_size(const Data& data) {
  return 20 + inline_qos_size(data.inline_qos) +
         (data.payload_kind == PayloadKind::none ? 0 : rounded_up(data.payload.size(), 4));
}
std::size_t content_size(const DataFrag& data) {
  return 32 + inline_qos_size(data.inline_qos) + rounded_up(data.payload.size(), 4);
}
std::size_t content_size(const Heartbeat&) { return 28; }
std::size_t content_size(const HeartbeatFrag&) { return 24; }
std::size_t content_size(const AckNack& ack) { return 24 + 4 * ack.missing.word_count(); }
std::size_t content_size(const NackFrag& nack) { return 28 + 4 * nack.missing.word_count(); }
std::size_t content_size(const Gap& gap) { return 28 + 4 * gap.list.word_count(); }
std::size_t content_size(const InfoTimestamp& info) { return info.time ? 8 : 0; }
std::size_t content_size(const InfoSource&) { return 20; }
std::size_t content_size(const InfoDestination&) { return 12; }
std::size_t content_size(const InfoReply& info) {
  return 4 + locator_size * info.unicast.size() + (info.multicast ? 4 + locator_size * info.multicast->size() : 0);
}

}  // namespace

std::size_t size_of(const Data& data) { return 4 + content_size(data); }
std::size_t size_of(const DataFrag& data) { return 4 + content_size(data); }
std::size_t size_of(const Submessage& submessage) {
  return std::visit([](const auto& each) { return 4 + content_size(each); }, submessage);
}

MessageEncoder::MessageEncoder(std::span<std::byte> target, const MessageHeader& header, ByteOrder order)
    : writer_(target, order) {
  for (const char letter : {'R', 'T', 'P', 'S'}) writer_.put(static_cast<std::uint8_t>(letter));
  put(writer_, header.version);
  put(writer_, header.vendor);
  put(writer_, header.prefix);
  is_sound_ = !writer_.overflowed();
}

bool MessageEncoder::add(const Submessage& submessage) {
  if (!is_sound_) return false;
  const std::size_t begin = writer_.position();
  const Pieces pieces = std::visit([](const auto& each) { return pieces_of(each); }, submessage);
  writer_.put(static_cast<std::uint8_t>(pieces.kind));
  writer_.put(
      static_cast<std::uint8_t>(pieces.flag | flag_if(writer_.order() == ByteOrder::little, flags::little_endian)));
  const std::size_t length_at = writer_.position();
  writer_.put(std::uint16_t{0});
  const std::size_t content_at = writer_.position();
  std::visit([&](const auto& each) { put_content(writer_, each); }, submessage);
  writer_.align(4);
  const std::size_t length = writer_.position() - content_at;
  if (writer_.overflowed() || length > 0xFFFF) {
    writer_.rewind_to(begin);
    return false;
  }
  writer_.patch(length_at, static_cast<std::uint16_t>(length));
  return true;
}

}  // namespace takt::dds
