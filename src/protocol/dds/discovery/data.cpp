// SPDX-License-Identifier: Apache-2.0
#include "dds/discovery/data.hpp"

#include <array>

#include "dds/discovery/qos_parameters.hpp"
#include "dds/message/cdr_reader.hpp"
#include "dds/message/cdr_writer.hpp"
#include "dds/message/wire_values.hpp"

namespace takt::dds {
namespace {

constexpr std::array<std::string_view, 6> verdict_texts{"ok",        "representation", "truncated",
                                                        "malformed", "incomplete",     "not_understood"};
static_assert(static_cast<std::size_t>(DataVerdict::not_understood) + 1 == verdict_texts.size());

/// Writes a payload: the encapsulation, the parameters that `put_all` puts, the sentinel.
template <class PutAll>
Octets encode_list(std::span<std::byte> target, PutAll put_all) {
  Writer writer(target, ByteOrder::little);
  detail::put_big_endian(writer, static_cast<std::uint32_t>(Encapsulation::pl_cdr_le) << 16, 4);
  ParameterWriter list(writer);
  put_all(list);
  return list.finish() ? writer.finished() : Octets();
}

template <class T>
void add(ParameterWriter& list, ParameterId id, const T& value) {
  list.parameter(id, [&](Writer& writer) {
    if constexpr (std::is_convertible_v<T, std::string_view>) {
      put_string(writer, value);
    } else if constexpr (Number<T>) {
      writer.put(value);
    } else {
      put(writer, value);
    }
  });
}
void add_locators(ParameterWriter& list, ParameterId id, const std::vector<Locator>& locators) {
  for (const Locator& locator : locators) add(list, id, locator);
}
void add_flag(ParameterWriter& list, ParameterId id, bool flag) {
  if (flag) add(list, id, std::uint8_t{1});
}

/// A string that is "" is as if it were not there.
void add_text(ParameterWriter& list, ParameterId id, const std::string& text) {
  if (!text.empty()) add(list, id, text);
}

void add_endpoint(ParameterWriter& list, const EndpointData& data) {
  add(list, ParameterId::topic_name, data.topic_name);
  add(list, ParameterId::type_name, data.type_name);
}

void add_rest_of_endpoint(ParameterWriter& list, const EndpointData& data) {
  if (!data.representations.empty()) {
    list.parameter(ParameterId::data_representation, [&](Writer& writer) {
      writer.put(static_cast<std::uint32_t>(data.representations.size()));
      for (const DataRepresentation each : data.representations) writer.put(static_cast<std::int16_t>(each));
    });
  }
  add_locators(list, ParameterId::unicast_locator, data.unicast);
  add_locators(list, ParameterId::multicast_locator, data.multicast);
  if (data.type_max_size) add(list, ParameterId::type_max_size_serialized, *data.type_max_size);
  if (!data.persistence_guid.is_unknown()) add(list, ParameterId::persistence_guid, data.persistence_guid);
  if (!data.participant.is_unknown()) add(list, ParameterId::participant_guid, data.participant);
  add_text(list, ParameterId::entity_name, data.entity_name);
  add(list, ParameterId::protocol_version, ProtocolVersion{});
  add(list, ParameterId::vendor_id, takt_vendor);
  add(list, ParameterId::endpoint_guid, data.guid);
}

constexpr std::string_view sql = "DDSSQL";

void add_content_filter(ParameterWriter& list, const ContentFilterProperty& filter) {
  list.parameter(ParameterId::content_filter_property, [&](Writer& writer) {
    const std::size_t begin = writer.position();
    for (const std::string_view text : {std::string_view(filter.topic_name), std::string_view(filter.related_topic),
                                        sql, std::string_view(filter.expression)}) {
      writer.align(4, begin);
      put_string(writer, text);
    }
    writer.align(4, begin);
    writer.put(std::uint32_t{0});  // parameters
  });
}

/// Reads a payload; `take` says of each parameter whether it is known and sound.
template <class Take>
DataVerdict decode_list(Octets payload, Take take) {
  const Encapsulated opened = open_encapsulation(payload);
  if (opened.representation == Representation::truncated) return DataVerdict::truncated;
  if (opened.representation != Representation::pl_cdr) return DataVerdict::representation;
  Reader reader(opened.content, opened.order);
  ParameterReader list(reader);
  while (const auto parameter = list.next()) {
    const Taken taken = take(*parameter);
    if (taken == Taken::malformed) return DataVerdict::malformed;
    if (taken == Taken::no && parameter->must_be_understood()) return DataVerdict::not_understood;
  }
  return reader.failed() ? DataVerdict::truncated : DataVerdict::ok;
}

Taken taken(const Reader& reader) { return reader.failed() ? Taken::malformed : Taken::yes; }

template <class T, class Get>
Taken decode_value(const Parameter& parameter, T& value, Get get) {
  Reader reader = parameter.reader();
  value = get(reader);
  return taken(reader);
}
template <Number T>
T get_number(Reader& reader) {
  return reader.get<T>();
}
bool get_flag(Reader& reader) { return reader.get<std::uint8_t>() != 0; }

Taken decode_locator(const Parameter& parameter, std::vector<Locator>& locators) {
  Reader reader = parameter.reader();
  locators.push_back(get_locator(reader));
  return taken(reader);
}

Taken decode_representations(const Parameter& parameter, std::vector<DataRepresentation>& list) {
  Reader reader = parameter.reader();
  const auto count = reader.get<std::uint32_t>();
  if (count > reader.left() / 2) return Taken::malformed;
  list.clear();
  for (std::uint32_t i = 0; i < count; ++i) list.push_back(static_cast<DataRepresentation>(reader.get<std::int16_t>()));
  return taken(reader);
}

/// What is filtered by other classes, or with parameters, is read and forgotten: it is the reader who filters.
Taken decode_content_filter(const Parameter& parameter, std::optional<ContentFilterProperty>& filter) {
  Reader reader = parameter.reader();
  std::array<std::string, 4> texts;
  for (std::string& text : texts) {
    reader.align(4);
    text = get_string(reader);
  }
  reader.align(4);
  const auto parameters = reader.get<std::uint32_t>();
  if (!reader.failed() && texts[2] == sql && parameters == 0) filter = {texts[0], texts[1], texts[3]};
  return taken(reader);
}

Taken decode_participant(const Parameter& parameter, ParticipantData& data) {
  switch (parameter.known()) {
    case ParameterId::protocol_version:
      return decode_value(parameter, data.version, get_protocol_version);
    case ParameterId::vendor_id:
      return decode_value(parameter, data.vendor, get_vendor_id);
    case ParameterId::participant_guid:
      return decode_value(parameter, data.guid, get_guid);
    case ParameterId::domain_id:
      return decode_value(parameter, data.domain, get_number<std::uint32_t>);
    case ParameterId::participant_lease_duration:
      return decode_value(parameter, data.lease_duration, [](Reader& r) { return get_duration(r).to_sim(); });
    case ParameterId::builtin_endpoint_set:
      return decode_value(parameter, data.builtin_endpoints, get_number<std::uint32_t>);
    case ParameterId::metatraffic_unicast_locator:
      return decode_locator(parameter, data.metatraffic_unicast);
    case ParameterId::metatraffic_multicast_locator:
      return decode_locator(parameter, data.metatraffic_multicast);
    case ParameterId::default_unicast_locator:
      return decode_locator(parameter, data.default_unicast);
    case ParameterId::default_multicast_locator:
      return decode_locator(parameter, data.default_multicast);
    case ParameterId::participant_manual_liveliness_count:
      return decode_value(parameter, data.manual_liveliness_count, get_number<std::uint32_t>);
    case ParameterId::expects_inline_qos:
      return decode_value(parameter, data.expects_inline_qos, get_flag);
    case ParameterId::entity_name:
      return decode_value(parameter, data.entity_name, get_string);
    case ParameterId::user_data: {
      Reader reader = parameter.reader();
      get_opaque(reader, data.user_data);
      return taken(reader);
    }
    default:
      return Taken::no;
  }
}

Taken decode_endpoint(const Parameter& parameter, EndpointData& data) {
  switch (parameter.known()) {
    case ParameterId::endpoint_guid:
      return decode_value(parameter, data.guid, get_guid);
    case ParameterId::participant_guid:
      return decode_value(parameter, data.participant, get_guid);
    case ParameterId::topic_name:
      return decode_value(parameter, data.topic_name, get_string);
    case ParameterId::type_name:
      return decode_value(parameter, data.type_name, get_string);
    case ParameterId::unicast_locator:
      return decode_locator(parameter, data.unicast);
    case ParameterId::multicast_locator:
      return decode_locator(parameter, data.multicast);
    case ParameterId::data_representation:
      return decode_representations(parameter, data.representations);
    case ParameterId::type_max_size_serialized:
      return decode_value(parameter, data.type_max_size, get_number<std::uint32_t>);
    case ParameterId::persistence_guid:
      return decode_value(parameter, data.persistence_guid, get_guid);
    case ParameterId::entity_name:
      return decode_value(parameter, data.entity_name, get_string);
    case ParameterId::protocol_version:
    case ParameterId::vendor_id:
      return Taken::yes;
    default:
      return Taken::no;
  }
}

DataVerdict completeness(const EndpointData& data) {
  return data.guid.is_unknown() || data.topic_name.empty() || data.type_name.empty() ? DataVerdict::incomplete
                                                                                     : DataVerdict::ok;
}

/// A QoS policy, or a parameter of endpoints.
template <class Data>
Taken decode_either(const Parameter& parameter, Data& data) {
  const Taken as_qos = decode_qos(parameter, data.qos);
  return as_qos == Taken::no ? decode_endpoint(parameter, data.endpoint) : as_qos;
}

}  // namespace

std::string_view name_of(DataVerdict verdict) { return verdict_texts[static_cast<std::size_t>(verdict)]; }

Matching match(const PublicationData& publication, const SubscriptionData& subscription) {
  const EndpointData& writer = publication.endpoint;
  const EndpointData& reader = subscription.endpoint;
  return match(WriterDescription{writer.topic_name, writer.type_name, &publication.qos, &writer.representations},
               ReaderDescription{reader.topic_name, reader.type_name, &subscription.qos, &reader.representations});
}

Octets encode(std::span<std::byte> target, const ParticipantData& data) {
  return encode_list(target, [&](ParameterWriter& list) {
    add(list, ParameterId::protocol_version, data.version);
    add(list, ParameterId::vendor_id, data.vendor);
    add(list, ParameterId::participant_lease_duration, Duration::from(data.lease_duration));
    add(list, ParameterId::participant_guid, data.guid);
    add(list, ParameterId::builtin_endpoint_set, data.builtin_endpoints);
    if (data.domain) add(list, ParameterId::domain_id, *data.domain);
    add_locators(list, ParameterId::default_unicast_locator, data.default_unicast);
    add_locators(list, ParameterId::default_multicast_locator, data.default_multicast);
    add_locators(list, ParameterId::metatraffic_unicast_locator, data.metatraffic_unicast);
    add_locators(list, ParameterId::metatraffic_multicast_locator, data.metatraffic_multicast);
    if (data.manual_liveliness_count != 0)
      add(list, ParameterId::participant_manual_liveliness_count, data.manual_liveliness_count);
    add_flag(list, ParameterId::expects_inline_qos, data.expects_inline_qos);
    add_text(list, ParameterId::entity_name, data.entity_name);
    if (!data.user_data.octets.empty())
      list.parameter(ParameterId::user_data, [&](Writer& writer) { put_opaque(writer, data.user_data); });
  });
}

Octets encode(std::span<std::byte> target, const PublicationData& data) {
  return encode_list(target, [&](ParameterWriter& list) {
    add_endpoint(list, data.endpoint);
    put_qos(list, data.qos);
    add_rest_of_endpoint(list, data.endpoint);
  });
}

Octets encode(std::span<std::byte> target, const SubscriptionData& data) {
  return encode_list(target, [&](ParameterWriter& list) {
    add_endpoint(list, data.endpoint);
    put_qos(list, data.qos);
    add_flag(list, ParameterId::expects_inline_qos, data.expects_inline_qos);
    if (data.content_filter) add_content_filter(list, *data.content_filter);
    add_rest_of_endpoint(list, data.endpoint);
  });
}

Octets encode(std::span<std::byte> target, const ParticipantMessageData& data) {
  CdrWriter writer(target);
  writer.put_array(std::span<const std::uint8_t>(data.prefix.octets));
  // The kind is four octets in their order, not a number (9.6.3.1).
  const auto kind = static_cast<std::uint32_t>(data.kind);
  for (const unsigned shift : {24U, 16U, 8U, 0U}) writer.put(static_cast<std::uint8_t>(kind >> shift));
  writer.begin_sequence(data.data.size());
  for (const std::byte octet : data.data) writer.put(std::to_integer<std::uint8_t>(octet));
  return writer.finish();
}

Octets encode_key(std::span<std::byte> target, const Guid& guid) {
  const bool is_participant = guid.entity == entity_id::participant;
  return encode_list(target, [&](ParameterWriter& list) {
    add(list, is_participant ? ParameterId::participant_guid : ParameterId::endpoint_guid, guid);
  });
}

DataVerdict decode(Octets payload, ParticipantData& data) {
  data = {};
  data.builtin_endpoints = 0;
  const DataVerdict verdict =
      decode_list(payload, [&](const Parameter& parameter) { return decode_participant(parameter, data); });
  if (verdict != DataVerdict::ok) return verdict;
  return data.guid.is_unknown() ? DataVerdict::incomplete : DataVerdict::ok;
}

DataVerdict decode(Octets payload, PublicationData& data) {
  data = {};
  const DataVerdict verdict =
      decode_list(payload, [&](const Parameter& parameter) { return decode_either(parameter, data); });
  return verdict != DataVerdict::ok ? verdict : completeness(data.endpoint);
}

DataVerdict decode(Octets payload, SubscriptionData& data) {
  data = {};
  const DataVerdict verdict = decode_list(payload, [&](const Parameter& parameter) {
    if (parameter.is(ParameterId::expects_inline_qos))
      return decode_value(parameter, data.expects_inline_qos, get_flag);
    if (parameter.is(ParameterId::content_filter_property))
      return decode_content_filter(parameter, data.content_filter);
    return decode_either(parameter, data);
  });
  return verdict != DataVerdict::ok ? verdict : completeness(data.endpoint);
}

DataVerdict decode(Octets payload, ParticipantMessageData& data) {
  data = {};
  CdrReader reader(payload);
  if (reader.representation() == Representation::truncated) return DataVerdict::truncated;
  if (reader.representation() != Representation::cdr) return DataVerdict::representation;
  reader.get_array(std::span<std::uint8_t>(data.prefix.octets));
  std::uint32_t kind = 0;
  for (int i = 0; i < 4; ++i) kind = kind << 8 | reader.get<std::uint8_t>();
  data.kind = static_cast<ParticipantMessageData::Kind>(kind);
  const std::size_t size = reader.begin_sequence(1);
  for (std::size_t i = 0; i < size; ++i) data.data.push_back(static_cast<std::byte>(reader.get<std::uint8_t>()));
  return reader.failed() ? DataVerdict::truncated : DataVerdict::ok;
}

DataVerdict decode_key(Octets payload, Guid& guid) {
  guid = {};
  const DataVerdict verdict = decode_list(payload, [&](const Parameter& parameter) {
    const bool is_guid = parameter.is(ParameterId::participant_guid) || parameter.is(ParameterId::endpoint_guid);
    // The endpoint's own GUID counts more than its participant's.
    if (!is_guid || (parameter.is(ParameterId::participant_guid) && !guid.is_unknown()))
      return is_guid ? Taken::yes : Taken::no;
    return decode_value(parameter, guid, get_guid);
  });
  return verdict == DataVerdict::ok && guid.is_unknown() ? DataVerdict::incomplete : verdict;
}

KeyHash key_hash_of(const Guid& guid) {
  KeyHash hash{};
  for (std::size_t i = 0; i < 12; ++i) hash[i] = guid.prefix.octets[i];
  for (std::size_t i = 0; i < 4; ++i) hash[12 + i] = static_cast<std::uint8_t>(guid.entity.value >> (8 * (3 - i)));
  return hash;
}

Guid guid_of(const KeyHash& hash) {
  Guid guid;
  for (std::size_t i = 0; i < 12; ++i) guid.prefix.octets[i] = hash[i];
  for (std::size_t i = 0; i < 4; ++i) guid.entity.value = guid.entity.value << 8 | hash[12 + i];
  return guid;
}

}  // namespace takt::dds
