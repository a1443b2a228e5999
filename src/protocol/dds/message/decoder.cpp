// SPDX-License-Identifier: Apache-2.0
#include "dds/message/decoder.hpp"

#include <algorithm>

#include "dds/message/flags.hpp"
#include "dds/message/fragments.hpp"
#include "dds/message/octets.hpp"
#include "dds/message/parameter_list.hpp"
#include "dds/message/wire_values.hpp"

namespace takt::dds {
namespace {

constexpr std::array<std::byte, 4> magic{std::byte{'R'}, std::byte{'T'}, std::byte{'P'}, std::byte{'S'}};
constexpr std::size_t header_size = 20;

bool has(unsigned octet, unsigned flag) { return (octet & flag) != 0; }
/// What the reader met so far.
MessageStatus verdict_of(const Reader& reader) {
  return reader.failed() ? MessageStatus::truncated : MessageStatus::ok;
}
bool is_number(SequenceNumber number) { return number >= first_sequence_number && number <= greatest_sequence_number; }

/// Inline QoS; what is not known is passed over, unless it must be understood.
MessageStatus get_inline_qos(Reader& reader, InlineQos& qos) {
  ParameterReader list(reader);
  MessageStatus verdict = MessageStatus::ok;
  while (const auto parameter = list.next()) {
    if (parameter->is(ParameterId::status_info) && parameter->value.size() >= 4) {
      qos.status_info = load<std::uint32_t>(parameter->value.data(), ByteOrder::big);
    } else if (parameter->is(ParameterId::key_hash) && parameter->value.size() >= 16) {
      Reader hash = parameter->reader();
      detail::get_octets(hash, qos.key_hash.emplace());
    } else if (parameter->is(ParameterId::original_writer_info) && parameter->value.size() >= 24) {
      Reader info = parameter->reader();
      const Guid writer = get_guid(info);
      const SequenceNumber number = get_sequence_number(info);
      if (is_number(number)) qos.original_writer = {writer, number};
    } else if (parameter->must_be_understood()) {
      verdict = MessageStatus::unknown;
    }
  }
  return reader.failed() ? MessageStatus::malformed : verdict;
}

/// Begins DATA and DATA_FRAG: what stands before the inline QoS.
template <class Sample>
std::size_t get_sample_header(Reader& reader, Sample& sample) {
  reader.get<std::uint16_t>();  // extra flags
  const std::size_t to_inline_qos = reader.get<std::uint16_t>();
  const std::size_t counted_from = reader.position();
  sample.reader = get_entity_id(reader);
  sample.writer = get_entity_id(reader);
  sample.sequence_number = get_sequence_number(reader);
  return counted_from + to_inline_qos;
}

/// A later minor version may put more before the inline QoS.
MessageStatus pass_to(Reader& reader, std::size_t position) {
  if (reader.failed()) return MessageStatus::truncated;
  if (position < reader.position()) return MessageStatus::malformed;
  reader.take(position - reader.position());
  return verdict_of(reader);
}

MessageStatus get_data(Reader& reader, unsigned flag, Data& data) {
  const std::size_t inline_qos_at = get_sample_header(reader, data);
  if (const MessageStatus verdict = pass_to(reader, inline_qos_at); verdict != MessageStatus::ok) return verdict;
  if (!is_number(data.sequence_number) || (has(flag, flags::data_data) && has(flag, flags::data_key)))
    return MessageStatus::malformed;
  if (has(flag, flags::data_inline_qos)) {
    if (const MessageStatus verdict = get_inline_qos(reader, data.inline_qos); verdict != MessageStatus::ok)
      return verdict;
  }
  if (has(flag, flags::data_not_standard)) return MessageStatus::unknown;
  data.payload_kind = has(flag, flags::data_data)  ? PayloadKind::data
                      : has(flag, flags::data_key) ? PayloadKind::key
                                                   : PayloadKind::none;
  if (data.payload_kind == PayloadKind::none) return MessageStatus::ok;
  data.payload = reader.rest();
  return data.payload.size() < 4 ? MessageStatus::malformed : MessageStatus::ok;
}

MessageStatus get_data_frag(Reader& reader, unsigned flag, DataFrag& data) {
  const std::size_t inline_qos_at = get_sample_header(reader, data);
  data.first_fragment = {reader.get<std::uint32_t>()};
  data.fragment_count = reader.get<std::uint16_t>();
  data.fragment_size = reader.get<std::uint16_t>();
  data.sample_size = reader.get<std::uint32_t>();
  if (const MessageStatus verdict = pass_to(reader, inline_qos_at); verdict != MessageStatus::ok) return verdict;
  if (!is_number(data.sequence_number) || data.first_fragment.value == 0 || data.fragment_count == 0 ||
      data.fragment_size == 0)
    return MessageStatus::malformed;
  const std::uint64_t last = std::uint64_t{data.first_fragment.value} + data.fragment_count - 1;
  if (last > fragment_count(data.sample_size, data.fragment_size)) return MessageStatus::malformed;
  if (has(flag, flags::frag_inline_qos)) {
    if (const MessageStatus verdict = get_inline_qos(reader, data.inline_qos); verdict != MessageStatus::ok)
      return verdict;
  }
  if (has(flag, flags::frag_not_standard)) return MessageStatus::unknown;
  data.payload_kind = has(flag, flags::frag_key) ? PayloadKind::key : PayloadKind::data;
  data.payload =
      reader.take(range_of(data.first_fragment, data.fragment_count, data.fragment_size, data.sample_size).size);
  return verdict_of(reader);
}

MessageStatus get_heartbeat(Reader& reader, unsigned flag, Heartbeat& heartbeat) {
  heartbeat.reader = get_entity_id(reader);
  heartbeat.writer = get_entity_id(reader);
  heartbeat.first = get_sequence_number(reader);
  heartbeat.last = get_sequence_number(reader);
  heartbeat.count = reader.get<std::uint32_t>();
  heartbeat.is_final = has(flag, flags::final_);
  heartbeat.is_liveliness = has(flag, flags::liveliness);
  if (reader.failed()) return MessageStatus::truncated;
  const bool is_sound = is_number(heartbeat.first) && heartbeat.last <= greatest_sequence_number &&
                        heartbeat.last >= heartbeat.first.previous();
  return is_sound ? MessageStatus::ok : MessageStatus::malformed;
}

MessageStatus get_heartbeat_frag(Reader& reader, unsigned, HeartbeatFrag& heartbeat) {
  heartbeat.reader = get_entity_id(reader);
  heartbeat.writer = get_entity_id(reader);
  heartbeat.sequence_number = get_sequence_number(reader);
  heartbeat.last_fragment = {reader.get<std::uint32_t>()};
  heartbeat.count = reader.get<std::uint32_t>();
  if (reader.failed()) return MessageStatus::truncated;
  return is_number(heartbeat.sequence_number) && heartbeat.last_fragment.value != 0 ? MessageStatus::ok
                                                                                    : MessageStatus::malformed;
}

/// numBits and the bitmap behind a base.
template <class N>
MessageStatus get_set(Reader& reader, N base, NumberSet<N>& set) {
  const auto bits = reader.get<std::uint32_t>();
  if (reader.failed()) return MessageStatus::truncated;
  if (bits > NumberSet<N>::most_bits) return MessageStatus::malformed;
  std::array<std::uint32_t, 8> words{};
  for (std::size_t i = 0; i < (bits + 31) / 32; ++i) words[i] = reader.get<std::uint32_t>();
  set = NumberSet<N>(base, bits, words);
  return verdict_of(reader);
}

MessageStatus get_sequence_number_set(Reader& reader, SequenceNumberSet& set) {
  const SequenceNumber base = get_sequence_number(reader);
  if (const MessageStatus verdict = get_set(reader, base, set); verdict != MessageStatus::ok) return verdict;
  // Base 0 without bits is how some say "I have nothing".
  return is_number(base) || (base.value == 0 && set.bit_count() == 0) ? MessageStatus::ok : MessageStatus::malformed;
}

MessageStatus get_ack_nack(Reader& reader, unsigned flag, AckNack& ack) {
  ack.reader = get_entity_id(reader);
  ack.writer = get_entity_id(reader);
  if (const MessageStatus verdict = get_sequence_number_set(reader, ack.missing); verdict != MessageStatus::ok)
    return verdict;
  ack.count = reader.get<std::uint32_t>();
  ack.is_final = has(flag, flags::final_);
  return verdict_of(reader);
}

MessageStatus get_nack_frag(Reader& reader, unsigned, NackFrag& nack) {
  nack.reader = get_entity_id(reader);
  nack.writer = get_entity_id(reader);
  nack.sequence_number = get_sequence_number(reader);
  const FragmentNumber base{reader.get<std::uint32_t>()};
  if (const MessageStatus verdict = get_set(reader, base, nack.missing); verdict != MessageStatus::ok) return verdict;
  nack.count = reader.get<std::uint32_t>();
  if (reader.failed()) return MessageStatus::truncated;
  const bool is_sound =
      is_number(nack.sequence_number) && base.value != 0 && base.value <= 0xFFFF'FFFFU - FragmentNumberSet::most_bits;
  return is_sound ? MessageStatus::ok : MessageStatus::malformed;
}

MessageStatus get_gap(Reader& reader, unsigned, Gap& gap) {
  gap.reader = get_entity_id(reader);
  gap.writer = get_entity_id(reader);
  gap.start = get_sequence_number(reader);
  if (const MessageStatus verdict = get_sequence_number_set(reader, gap.list); verdict != MessageStatus::ok)
    return verdict;
  return is_number(gap.start) && gap.list.base() >= gap.start ? MessageStatus::ok : MessageStatus::malformed;
}

MessageStatus get_info_timestamp(Reader& reader, unsigned flag, InfoTimestamp& info) {
  if (!has(flag, flags::timestamp_invalid)) info.time = get_time(reader);
  return verdict_of(reader);
}

MessageStatus get_info_source(Reader& reader, unsigned, InfoSource& info) {
  reader.get<std::uint32_t>();  // unused
  info.version = get_protocol_version(reader);
  info.vendor = get_vendor_id(reader);
  info.prefix = get_guid_prefix(reader);
  return verdict_of(reader);
}

MessageStatus get_info_destination(Reader& reader, unsigned, InfoDestination& info) {
  info.prefix = get_guid_prefix(reader);
  return verdict_of(reader);
}

MessageStatus get_locators(Reader& reader, std::vector<Locator>& locators) {
  const auto count = reader.get<std::uint32_t>();
  if (reader.failed() || count > reader.left() / locator_size) return MessageStatus::truncated;
  for (std::uint32_t i = 0; i < count; ++i) locators.push_back(get_locator(reader));
  return MessageStatus::ok;
}

MessageStatus get_info_reply(Reader& reader, unsigned flag, InfoReply& info) {
  if (const MessageStatus verdict = get_locators(reader, info.unicast); verdict != MessageStatus::ok) return verdict;
  return has(flag, flags::multicast_reply) ? get_locators(reader, info.multicast.emplace()) : MessageStatus::ok;
}

/// The older form for UDP over IPv4 (8.3.7.8): told as the newer one.
MessageStatus get_info_reply_ip4(Reader& reader, unsigned flag, InfoReply& info) {
  const auto get = [&] {
    const auto ip = reader.get<std::uint32_t>();
    return Locator::udp_v4(ip, reader.get<std::uint32_t>());
  };
  info.unicast.push_back(get());
  if (has(flag, flags::multicast_reply)) info.multicast.emplace().push_back(get());
  return verdict_of(reader);
}

MessageStatus get_pad(Reader&, unsigned, Pad&) { return MessageStatus::ok; }

template <class T, MessageStatus (*Get)(Reader&, unsigned, T&)>
MessageStatus get_as(Reader& reader, unsigned flag, Submessage& submessage) {
  return Get(reader, flag, submessage.emplace<T>());
}

struct Kind {
  SubmessageKind kind;
  std::string_view name;
  MessageStatus (*get)(Reader&, unsigned, Submessage&);
};

constexpr std::array<Kind, 13> kinds{{
    {SubmessageKind::pad, "PAD", get_as<Pad, get_pad>},
    {SubmessageKind::ack_nack, "ACKNACK", get_as<AckNack, get_ack_nack>},
    {SubmessageKind::heartbeat, "HEARTBEAT", get_as<Heartbeat, get_heartbeat>},
    {SubmessageKind::gap, "GAP", get_as<Gap, get_gap>},
    {SubmessageKind::info_timestamp, "INFO_TS", get_as<InfoTimestamp, get_info_timestamp>},
    {SubmessageKind::info_source, "INFO_SRC", get_as<InfoSource, get_info_source>},
    {SubmessageKind::info_reply_ip4, "INFO_REPLY_IP4", get_as<InfoReply, get_info_reply_ip4>},
    {SubmessageKind::info_destination, "INFO_DST", get_as<InfoDestination, get_info_destination>},
    {SubmessageKind::info_reply, "INFO_REPLY", get_as<InfoReply, get_info_reply>},
    {SubmessageKind::nack_frag, "NACK_FRAG", get_as<NackFrag, get_nack_frag>},
    {SubmessageKind::heartbeat_frag, "HEARTBEAT_FRAG", get_as<HeartbeatFrag, get_heartbeat_frag>},
    {SubmessageKind::data, "DATA", get_as<Data, get_data>},
    {SubmessageKind::data_frag, "DATA_FRAG", get_as<DataFrag, get_data_frag>},
}};

const Kind* find_kind(unsigned id) {
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&](const Kind& kind) { return static_cast<unsigned>(kind.kind) == id; });
  return found == kinds.end() ? nullptr : &*found;
}

/// SEC_BODY to SRTPS_POSTFIX of DDS Security.
bool is_security(unsigned id) { return id >= 0x30 && id <= 0x34; }
/// Only these may say 0 and mean it (8.3.3.2.3); of all others 0 means "to the end".
bool may_be_empty(unsigned id) {
  return id == static_cast<unsigned>(SubmessageKind::pad) ||
         id == static_cast<unsigned>(SubmessageKind::info_timestamp);
}

}  // namespace

MessageDecoder::MessageDecoder(Octets message) {
  if (message.size() < magic.size() || !std::equal(magic.begin(), magic.end(), message.begin())) {
    verdict_ = message.size() < magic.size() ? MessageStatus::truncated : MessageStatus::not_rtps;
    return;
  }
  if (message.size() < header_size) {
    verdict_ = MessageStatus::truncated;
    return;
  }
  Reader reader(message.subspan(magic.size()), ByteOrder::big);
  header_.version = get_protocol_version(reader);
  header_.vendor = get_vendor_id(reader);
  header_.prefix = get_guid_prefix(reader);
  if (header_.version.major != 2) {
    verdict_ = MessageStatus::version;
    return;
  }
  interpretation_ = {header_.version, header_.vendor, header_.prefix, {}, {}, {}};
  rest_ = reader.rest();
}

bool MessageDecoder::stop(MessageStatus verdict) {
  verdict_ = verdict;
  rest_ = {};
  return false;
}

bool MessageDecoder::next() {
  while (!rest_.empty()) {
    if (rest_.size() < 4) return stop(MessageStatus::truncated);
    const auto id = std::to_integer<unsigned>(rest_[0]);
    const auto flag = std::to_integer<unsigned>(rest_[1]);
    const ByteOrder order = has(flag, flags::little_endian) ? ByteOrder::little : ByteOrder::big;
    std::size_t length = load<std::uint16_t>(rest_.data() + 2, order);
    if (is_security(id)) return stop(MessageStatus::secured);
    if (length == 0 && !may_be_empty(id)) length = rest_.size() - 4;
    if (length > rest_.size() - 4) return stop(MessageStatus::truncated);
    const Octets content = rest_.subspan(4, length);
    size_ = 4 + length;
    rest_ = rest_.subspan(size_);
    if (size_ % 4 != 0 && !rest_.empty()) return stop(MessageStatus::malformed);
    const Kind* const kind = find_kind(id);
    if (kind == nullptr) {
      ++skipped_;
      continue;
    }
    Reader reader(content, order);
    const MessageStatus verdict = kind->get(reader, flag, submessage_);
    if (verdict == MessageStatus::unknown) {
      ++skipped_;
      continue;
    }
    if (verdict != MessageStatus::ok) return stop(verdict);
    kind_ = kind->kind;
    interpret();
    return true;
  }
  return false;
}

void MessageDecoder::interpret() {
  if (const auto* const timestamp = std::get_if<InfoTimestamp>(&submessage_)) {
    interpretation_.timestamp = timestamp->time;
  } else if (const auto* const destination = std::get_if<InfoDestination>(&submessage_)) {
    interpretation_.destination = destination->prefix;
  } else if (const auto* const source = std::get_if<InfoSource>(&submessage_)) {
    // What was said for the former source does not hold for this one (8.3.7.9.5).
    interpretation_ = {source->version, source->vendor, source->prefix, interpretation_.destination, {}, {}};
  } else if (const auto* const reply = std::get_if<InfoReply>(&submessage_)) {
    interpretation_.reply = *reply;
  }
}

std::string_view name_of(SubmessageKind kind) {
  const Kind* const found = find_kind(static_cast<unsigned>(kind));
  return found == nullptr ? "unknown" : found->name;
}

}  // namespace takt::dds
