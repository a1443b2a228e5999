// SPDX-License-Identifier: Apache-2.0
#include "plant/topic_check.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "json/suggest.hpp"
#include "plant/field_text.hpp"

namespace takt::plant {
namespace {

constexpr std::uint32_t largest_id = 65'535;

const UadpLayout& layout_of(const Topic& topic) {
  static const UadpLayout usual;
  return topic.uadp ? *topic.uadp : usual;
}

void check_fields(const Topic& topic, json::Diagnostics& diagnostics) {
  for (const auto& [name, field] : topic.fields) {
    const json::Place place = field.where.is_known() ? field.where.place() : topic.where.at("fields");
    if (topic.protocol == Protocol::dds && !is_number(field.type))
      diagnostics.error(place, "not of DDS",
                        {json::quote(name) + ", which is no number", "a topic with \"protocol\": \"opc-ua\""});
    if (has_length(field.type) != field.max_length.has_value())
      diagnostics.error(field.max_length ? field.where.at("max_length") : place,
                        field.max_length ? "a length of what always has the same" : "a text without a greatest length",
                        {json::quote(name), field.max_length ? "\"max_length\" of String and ByteString only"
                                                             : "\"max_length\", the most octets that it may have"});
  }
}

/// Parts that rest on others.
void check_parts(const UadpLayout& layout, json::Diagnostics& diagnostics) {
  const auto needs = [&](auto part, auto other, const char* key, const char* text) {
    if (has(layout, part) && !has(layout, other))
      diagnostics.error(layout.where.at(key), "a part without what it belongs to", {text});
  };
  using Network = NetworkMessagePart;
  needs(Network::writer_group_id, Network::group_header, "network_message",
        "\"WriterGroupId\" without \"GroupHeader\"");
  needs(Network::group_version, Network::group_header, "network_message", "\"GroupVersion\" without \"GroupHeader\"");
  needs(Network::network_message_number, Network::group_header, "network_message",
        "\"NetworkMessageNumber\" without \"GroupHeader\"");
  needs(Network::sequence_number, Network::group_header, "network_message",
        "\"SequenceNumber\" without \"GroupHeader\"");
  needs(Network::pico_seconds, Network::timestamp, "network_message", "\"PicoSeconds\" without \"Timestamp\"");
  needs(DataSetMessagePart::pico_seconds, DataSetMessagePart::timestamp, "data_set_message",
        "\"PicoSeconds\" without \"Timestamp\"");
  needs(DataValuePart::source_pico_seconds, DataValuePart::source_timestamp, "data_value",
        "\"SourcePicoSeconds\" without \"SourceTimestamp\"");
  needs(DataValuePart::server_pico_seconds, DataValuePart::server_timestamp, "data_value",
        "\"ServerPicoSeconds\" without \"ServerTimestamp\"");
}

/// Keys that nothing would come of.
void check_use(const Topic& topic, const UadpLayout& layout, json::Diagnostics& diagnostics) {
  const json::Source& where = layout.where;
  if (layout.data_value && layout.encoding != UadpEncoding::data_value)
    diagnostics.error(where.at("data_value"), "parts of DataValues without them",
                      {"\"data_value\"", "\"encoding\": \"DataValue\""});
  const bool has_publisher = has(layout, NetworkMessagePart::publisher_id);
  if (layout.publisher && !has_publisher)
    diagnostics.error(where.at("publisher"), "a PublisherId that is not sent",
                      {"\"publisher\"", "\"PublisherId\" in \"network_message\""});
  if (topic.publisher_id && (layout.publisher || !has_publisher))
    diagnostics.error(
        topic.where.at("publisher_id"), "a PublisherId that is not sent",
        {std::to_string(*topic.publisher_id),
         layout.publisher ? "either \"publisher_id\" or \"publisher\"" : "\"PublisherId\" in \"network_message\""});
  if (layout.key_frame_count == 1) return;
  const json::Place place = where.at("key_frame_count");
  if (layout.encoding == UadpEncoding::raw_data)
    diagnostics.error(place, "no delta frames",
                      {"\"RawData\", which has key frames only", "1, or another \"encoding\""});
  if (!has(layout, NetworkMessagePart::payload_header))
    diagnostics.error(place, "no delta frames",
                      {"no \"PayloadHeader\", so that every message has all fields",
                       "1, or \"PayloadHeader\" in \"network_message\""});
  if (topic.fields.size() == 1) diagnostics.error(place, "no delta frames", {"a single field", "1, or more fields"});
}

/// The PublisherId, as it is told apart; empty if messages have none.
std::string publisher_text(const UadpPublisher& id) {
  if (id.byte) return "Byte " + std::to_string(*id.byte);
  if (id.uint32) return "UInt32 " + std::to_string(*id.uint32);
  if (id.uint64) return "UInt64 " + std::to_string(*id.uint64);
  return "String " + json::quote(id.string.value_or(""));
}

/// Of two topics without PublisherIds: whether some id that both carry differs always.
bool differ(const UadpLayout& one, std::size_t ones, const UadpLayout& other, std::size_t others) {
  const auto both = [&](NetworkMessagePart part) { return has(one, part) && has(other, part); };
  const bool groups_differ =
      one.writer_group_id + ones <= other.writer_group_id || other.writer_group_id + others <= one.writer_group_id;
  return (both(NetworkMessagePart::writer_group_id) && groups_differ) ||
         (both(NetworkMessagePart::payload_header) && one.data_set_writer_id != other.data_set_writer_id);
}

}  // namespace

bool has_uint16_publisher(const Topic& topic) {
  const UadpLayout& layout = layout_of(topic);
  return topic.protocol == Protocol::opc_ua && !layout.publisher && has(layout, NetworkMessagePart::publisher_id);
}

void check_fields_and_layout(const Topic& topic, json::Diagnostics& diagnostics) {
  check_fields(topic, diagnostics);
  if (!topic.uadp) return;
  if (topic.protocol == Protocol::dds) {
    diagnostics.error(topic.where.at("uadp"), "not of DDS", {"\"uadp\"", "a topic with \"protocol\": \"opc-ua\""});
    return;
  }
  check_parts(*topic.uadp, diagnostics);
  check_use(topic, *topic.uadp, diagnostics);
}

void check_publishers(std::span<const Topic> topics, std::span<const std::size_t> publications,
                      json::Diagnostics& diagnostics) {
  std::set<std::string> ids;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    const Topic& topic = topics[i];
    if (topic.protocol != Protocol::opc_ua || !topic.uadp) continue;
    const UadpLayout& layout = *topic.uadp;
    const std::size_t count = std::max<std::size_t>(1, publications[i]);
    if (layout.writer_group_id + count - 1 > largest_id)
      diagnostics.error(layout.where.at("writer_group_id"), "more publications than ids",
                        {std::to_string(count) + " from " + std::to_string(layout.writer_group_id) + " on",
                         "ids up to " + std::to_string(largest_id)});
    if (count > 1 && !has(layout, NetworkMessagePart::writer_group_id))
      diagnostics.error(layout.where.at("network_message"), "publications that look alike",
                        {std::to_string(count) + " of " + json::quote(topic.name),
                         "\"GroupHeader\" and \"WriterGroupId\", or one publication"});
    if (layout.publisher && !ids.insert(publisher_text(*layout.publisher)).second)
      diagnostics.error(layout.publisher->where.place(), "a PublisherId twice",
                        {publisher_text(*layout.publisher), "one of its own for each topic"});
    if (has(layout, NetworkMessagePart::publisher_id)) continue;
    for (std::size_t k = 0; k < i; ++k) {
      const bool is_anonymous = topics[k].protocol == Protocol::opc_ua && topics[k].uadp &&
                                !has(*topics[k].uadp, NetworkMessagePart::publisher_id);
      if (is_anonymous && !differ(*topics[k].uadp, std::max<std::size_t>(1, publications[k]), layout, count))
        diagnostics.error(
            layout.where.place(), "topics that look alike",
            {json::quote(topic.name) + " and " + json::quote(topics[k].name) + ", both without PublisherId",
             "another \"writer_group_id\" or \"data_set_writer_id\", sent by both"});
    }
  }
}

void check_payload(const Payload& payload, const Topic& topic, const json::Place& thread,
                   json::Diagnostics& diagnostics) {
  const bool has_number = std::any_of(topic.fields.begin(), topic.fields.end(),
                                      [](const auto& each) { return is_number(each.second.type); });
  if (!payload.copy_of && !has_number)
    diagnostics.error(
        thread, "no field for the pattern",
        {json::quote(topic.name) + ", which has no number", "a topic with a field that is one, or \"copy_of\""});
  if (payload.copy_of && !payload.values.empty())
    diagnostics.error(payload.where.at("values"), "values of a copy", {"\"values\"", "a \"pattern\""});
  for (const auto& [name, text] : payload.values) {
    const json::Place place = payload.where.at("values");
    const auto found = std::find_if(topic.fields.begin(), topic.fields.end(),
                                    [&, &name = name](const auto& each) { return each.first == name; });
    if (found == topic.fields.end()) {
      std::vector<std::string_view> names;
      for (const auto& [each, field] : topic.fields) names.push_back(each);
      diagnostics.error(
          place, "a value of no field",
          {json::quote(name), "the name of a field of " + json::quote(topic.name), json::suggest(name, names)});
      continue;
    }
    const TopicField& field = found->second;
    if (is_number(field.type) || field.count != 1) {
      diagnostics.error(place, "a value of another type",
                        {json::quote(name), "a single String, DateTime, Guid or ByteString"});
      continue;
    }
    const auto octets = octets_of_text(field.type, text);
    if (!octets)
      diagnostics.error(place, "not a value of its type",
                        {json::quote(text) + " for " + json::quote(name), std::string(spelling_of(field.type))});
    else if (field.max_length && octets->size() > 4U + *field.max_length)
      diagnostics.error(place, "a value too long",
                        {std::to_string(octets->size() - 4) + " octets for " + json::quote(name),
                         "at most " + std::to_string(*field.max_length)});
  }
}

}  // namespace takt::plant
