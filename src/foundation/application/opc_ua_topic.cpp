// SPDX-License-Identifier: Apache-2.0
#include "application/opc_ua_topic.hpp"

#include "plant/topic_check.hpp"
#include "sim/check.hpp"
#include "uadp/network_message.hpp"

namespace takt::application {
namespace {

using namespace sim::literals;  // NOLINT
using plant::NetworkMessagePart;

// Threads say when something is published, by setting the DataSet. A PublishingInterval would say it again when it is
// over.
constexpr sim::Duration seldom = 90 * 24 * 3600_s;

/// Parts of messages are numbered as the bits of the masks.
template <class Part>
std::uint32_t mask_of(const std::vector<Part>& parts) {
  std::uint32_t mask = 0;
  for (const Part part : parts) mask |= 1U << static_cast<unsigned>(part);
  return mask;
}
static_assert(1U << static_cast<unsigned>(NetworkMessagePart::pico_seconds) ==
              pubsub::network_message_content::PicoSeconds);
static_assert(1U << static_cast<unsigned>(NetworkMessagePart::payload_header) ==
              pubsub::network_message_content::PayloadHeader);
static_assert(1U << static_cast<unsigned>(plant::DataSetMessagePart::sequence_number) ==
              pubsub::data_set_message_content::SequenceNumber);
static_assert(1U << static_cast<unsigned>(plant::DataSetMessagePart::status) ==
              pubsub::data_set_message_content::Status);
static_assert(1U << static_cast<unsigned>(plant::DataValuePart::server_pico_seconds) ==
              pubsub::data_set_field_content::ServerPicoSeconds);
static_assert(1U << static_cast<unsigned>(plant::DataValuePart::source_timestamp) ==
              pubsub::data_set_field_content::SourceTimestamp);

constexpr uadp::FieldEncoding encodings[] = {uadp::FieldEncoding::Variant, uadp::FieldEncoding::RawData,
                                             uadp::FieldEncoding::DataValue};

struct Longest final : pubsub::PublishedData {
  void publish(uadp::Octets message, const pubsub::Destination&) override {
    octets = message.size();
    uadp::NetworkMessage decoded;
    if (uadp::decode(message, decoded) == uadp::DecodeStatus::ok)
      data_set_octets = decoded.payload.size();  // of the only DataSetMessage
  }
  std::size_t octets = 0;
  std::size_t data_set_octets = 0;
};

Longest longest_of(const TopicShape& topic, const OpcUaAddress& address) {
  Longest longest;
  OpcUaPublication publication(topic, address, longest, sim::LocalTime());
  const bool are_fields = publication.publish(topic.longest(), sim::LocalTime());
  TAKT_CHECK(are_fields, "the longest values are values of the topic");
  return longest;
}

/// Of the PublisherId that is off any stands for none: it is not sent.
uadp::PublisherId sent_id(const TopicShape& topic, const OpcUaAddress& address) {
  return publisher_of(topic, address).value_or(uadp::PublisherId::uint16(address.publisher_id));
}

pubsub::DataSetReaderSettings reader_settings(const TopicShape& topic) {
  pubsub::DataSetReaderSettings settings;
  settings.data_set_writer_id = topic.layout.data_set_writer_id;
  if (topic.layout.major_version != 0) settings.major_version = topic.layout.major_version;
  settings.needs_key_after_gap = true;
  settings.configured_size = topic.layout.configured_size.value_or(0);
  return settings;
}

}  // namespace

std::optional<uadp::PublisherId> publisher_of(const TopicShape& topic, const OpcUaAddress& address) {
  if (!has(topic.layout, NetworkMessagePart::publisher_id)) return std::nullopt;
  const std::optional<plant::UadpPublisher>& own = topic.layout.publisher;
  if (!own) return uadp::PublisherId::uint16(address.publisher_id);
  if (own->byte) return uadp::PublisherId::byte(*own->byte);
  if (own->uint32) return uadp::PublisherId::uint32(*own->uint32);
  if (own->uint64) return uadp::PublisherId::uint64(*own->uint64);
  return uadp::PublisherId::string(*own->string);
}

pubsub::WriterGroupSettings group_settings(const TopicShape& topic, const OpcUaAddress& address, uadp::DateTime epoch) {
  pubsub::WriterGroupSettings settings;
  settings.writer_group_id = static_cast<std::uint16_t>(topic.layout.writer_group_id + address.writer_group_id - 1);
  settings.publishing_interval = seldom;
  settings.publish_on_change = true;
  settings.network_message_content_mask = mask_of(topic.layout.network_message);
  settings.group_version = topic.layout.group_version;
  settings.epoch = epoch;
  return settings;
}

pubsub::DataSetWriterSettings writer_settings(const TopicShape& topic) {
  pubsub::DataSetWriterSettings settings;
  settings.data_set_writer_id = topic.layout.data_set_writer_id;
  settings.data_set_message_content_mask = mask_of(topic.layout.data_set_message);
  settings.field_encoding = encodings[static_cast<std::size_t>(topic.layout.encoding)];
  if (topic.layout.encoding == plant::UadpEncoding::data_value)
    settings.data_set_field_content_mask =
        mask_of(topic.layout.data_value.value_or(std::vector{plant::DataValuePart::status_code}));
  settings.key_frame_count = topic.layout.key_frame_count;
  settings.major_version = topic.layout.major_version;
  settings.minor_version = topic.layout.minor_version;
  settings.configured_size = topic.layout.configured_size.value_or(0);
  return settings;
}

std::size_t longest_message(const TopicShape& topic, const OpcUaAddress& address) {
  return longest_of(topic, address).octets;
}

std::size_t longest_data_set_message(const TopicShape& topic) {
  TopicShape as_long_as_it_is = topic;
  as_long_as_it_is.layout.configured_size.reset();
  return longest_of(as_long_as_it_is, {1, 1}).data_set_octets;
}

void check_configured_size(const plant::Topic& topic, const TopicShape& shape, json::Diagnostics& diagnostics) {
  if (!shape.layout.configured_size) return;
  const std::size_t needed = longest_data_set_message(shape);
  if (needed <= *shape.layout.configured_size) return;
  diagnostics.error(topic.uadp->where.at("configured_size"), "a DataSetMessage longer than its ConfiguredSize",
                    {std::to_string(*shape.layout.configured_size) + " octets",
                     "at least " + std::to_string(needed) + ", which the longest values of the fields take"});
}

OpcUaPublication::OpcUaPublication(const TopicShape& topic, const OpcUaAddress& address, pubsub::PublishedData& stack,
                                   sim::LocalTime now, uadp::DateTime epoch)
    : values_(topic.fields), publisher_(sent_id(topic, address)), communication_(stack, input_) {
  const std::uint16_t group = publisher_.add_writer_group(group_settings(topic, address, epoch));
  const bool added = publisher_.add_data_set("values", values_, writer_settings(topic), group);
  TAKT_CHECK(added, "a writer that is alone in its group");
  communication_.add_publisher(publisher_);
  communication_.enable(now);
}

bool OpcUaPublication::publish(uadp::Octets fields, sim::LocalTime now) {
  if (!values_.assign(fields)) return false;
  communication_.advance(now);
  return true;
}

OpcUaSubscription::OpcUaSubscription(const TopicShape& topic, std::span<const OpcUaAddress> heard, sim::LocalTime now)
    : subscriber_(heard.empty() ? std::nullopt : publisher_of(topic, heard.front())), communication_(output_, input_) {
  subscriber_.require_publisher_id();
  const bool are_told_apart = has(topic.layout, NetworkMessagePart::writer_group_id);
  for (const OpcUaAddress& each : heard) {
    TAKT_CHECK(each.publisher_id == heard.front().publisher_id, "a topic has one Publisher");
    const pubsub::WriterGroupSettings publication = group_settings(topic, each);
    readers_.push_back("values of " + std::to_string(publication.writer_group_id));
    gateway::FieldValues& values = values_.emplace_back(topic.fields);
    values.on_received([this, &values] { come_ = &values; });
    const std::size_t group = subscriber_.add_reader_group(
        are_told_apart ? publication.writer_group_id : std::uint16_t{0}, std::nullopt, publication.group_version);
    subscriber_.add_data_set(readers_.back(), values, reader_settings(topic), group);
  }
  communication_.add_subscriber(subscriber_);
  communication_.enable(now);
}

std::optional<uadp::Octets> OpcUaSubscription::receive(uadp::Octets message, sim::LocalTime now) {
  come_ = nullptr;
  communication_.received(message, now);
  return come_ != nullptr ? std::optional(come_->octets()) : std::nullopt;
}

std::uint64_t OpcUaSubscription::lost() const {
  std::uint64_t sum = 0;
  for (const std::string& name : readers_) sum += subscriber_.reader(name)->missed();
  return sum;
}

}  // namespace takt::application
