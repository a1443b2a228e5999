// SPDX-License-Identifier: Apache-2.0
#include "node/applications/describe_topics.hpp"

#include <algorithm>

#include "application/opc_ua_topic.hpp"
#include "sim/check.hpp"

namespace takt::node {
namespace {

using application::OpcUaAddress;
using application::TopicShape;

struct Published final : pubsub::PublishedData {
  void publish(uadp::Octets message, const pubsub::Destination&) override {
    octets.assign(message.begin(), message.end());
  }
  std::vector<std::byte> octets;
};

constexpr const char* id_types[] = {"Byte", "UInt16", "UInt32", "UInt64", "String"};

/// As a message says it: offsets are read off one, so they are where the codec puts what they tell of.
void measure(const TopicShape& shape, const OpcUaAddress& address, DescribedTopic& topic) {
  Published published;
  application::OpcUaPublication publication(shape, address, published, sim::LocalTime());
  publication.publish(shape.longest(), sim::LocalTime());
  uadp::NetworkMessage network;
  uadp::DataSetMessage message;
  const bool is_read = decode(published.octets, network) == uadp::DecodeStatus::ok &&
                       decode(network.data_set_message(0), message) == uadp::DecodeStatus::ok;
  TAKT_CHECK(is_read, "what is published can be read");
  topic.octets = static_cast<std::int64_t>(published.octets.size());
  topic.data_set_offset = static_cast<std::int64_t>(network.payload_offset);
  if (message.header.encoding != uadp::FieldEncoding::RawData) return;
  const auto layout = raw_layout_of(gateway::FieldValues(shape.fields));
  TAKT_CHECK(layout.has_value(), "RawData has a layout");
  for (std::size_t i = 0; i < topic.fields.size(); ++i)
    topic.fields[i].offset =
        static_cast<std::int64_t>(network.payload_offset + message.body_offset + layout->offset(i));
}

DescribedTopic describe_topic(const std::string& name, const TopicShape& shape, std::uint16_t number) {
  const OpcUaAddress address{number, 1};
  DescribedTopic topic;
  topic.name = name;
  if (const auto id = publisher_of(shape, address)) {
    topic.publisher_id_type = id_types[static_cast<std::size_t>(id->type)];
    topic.publisher_id = id->type == uadp::PublisherIdType::String ? std::string(id->text) : std::to_string(id->number);
  }
  const pubsub::WriterGroupSettings group = group_settings(shape, address);
  const pubsub::DataSetWriterSettings writer = writer_settings(shape);
  topic.data_set_writer_id = writer.data_set_writer_id;
  topic.network_message_content_mask = group.network_message_content_mask;
  topic.data_set_message_content_mask = writer.data_set_message_content_mask;
  topic.data_set_field_content_mask = writer.field_encoding == uadp::FieldEncoding::RawData
                                          ? pubsub::data_set_field_content::RawData
                                          : writer.data_set_field_content_mask;
  topic.key_frame_count = writer.key_frame_count;
  topic.group_version = group.group_version;
  topic.major_version = writer.major_version;
  topic.minor_version = writer.minor_version;
  if (shape.layout.configured_size) topic.configured_size = *shape.layout.configured_size;
  for (const gateway::DataSetField& field : shape.fields) {
    DescribedField& made = topic.fields.emplace_back();
    made.name = field.name;
    made.type = uadp::name_of(field.type.type);
    if (field.type.is_array) made.array_length = field.type.array_length;
    if (field.type.max_string_length != 0) made.max_string_length = field.type.max_string_length;
  }
  measure(shape, address, topic);
  return topic;
}

}  // namespace

NodeDescription description_of(const LoadedApplications& loaded) {
  const ApplicationsConfig& config = loaded.config;
  NodeDescription made = config.transport ? description_of(config.node, *config.transport)
                                          : NodeDescription{.node = config.node, .transport = "none"};
  made.security = security_text(loaded.config.security);
  for (std::size_t i = 0; i < config.topics.size(); ++i) {
    if (config.topics[i].protocol != Protocol::opc_ua) continue;
    const std::string& name = config.topics[i].name;
    DescribedTopic topic = describe_topic(name, loaded.topics[i].shape, loaded.topics[i].publisher_id);
    for (const LoadedPublication& each : loaded.publications)
      if (each.topic == name)
        topic.publications.push_back({each.application, each.thread, each.on == config.node,
                                      group_settings(loaded.topics[i].shape, {1, each.number}).writer_group_id,
                                      each.every});
    for (const plant::Application& each : config.applications)
      topic.is_heard = topic.is_heard || std::any_of(each.threads.begin(), each.threads.end(),
                                                     [&](const Thread& thread) { return thread.subscribe == name; });
    topic.is_heard = topic.is_heard || std::any_of(config.gateways.begin(), config.gateways.end(),
                                                   [&](const plant::Gateway& each) { return each.from == name; });
    const bool is_published = std::any_of(topic.publications.begin(), topic.publications.end(),
                                          [](const DescribedPublication& each) { return each.is_own; });
    if (topic.is_heard || is_published) made.topics.push_back(std::move(topic));
  }
  return made;
}

}  // namespace takt::node
