#include "application/opc_ua_topic.hpp"

#include "sim/check.hpp"

namespace takt::application {
namespace {

using namespace sim::literals;  // NOLINT

// Threads say when something is published, by setting the DataSet. A PublishingInterval would say it again when it is over.
constexpr sim::Duration seldom = 90 * 24 * 3600_s;

constexpr std::uint16_t data_set_writer = 1;  // alone in its group

pubsub::WriterGroupSettings group_settings(std::uint16_t writer_group) {
  pubsub::WriterGroupSettings settings;
  settings.writer_group_id = writer_group;
  settings.publishing_interval = seldom;
  settings.publish_on_change = true;
  return settings;
}

}  // namespace

OpcUaPublication::OpcUaPublication(const TopicShape& topic, const OpcUaAddress& address, pubsub::PublishedData& stack, sim::LocalTime now)
    : values_(topic.fields), publisher_(uadp::PublisherId::uint16(address.publisher_id)), communication_(stack, input_) {
  const std::uint16_t group = publisher_.add_writer_group(group_settings(address.writer_group_id));
  const bool added = publisher_.add_data_set("values", values_, {.data_set_writer_id = data_set_writer}, group);
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
    : values_(topic.fields), subscriber_(uadp::PublisherId::uint16(heard.empty() ? 1 : heard.front().publisher_id)), communication_(output_, input_) {
  for (const OpcUaAddress& each : heard) {
    TAKT_CHECK(each.publisher_id == heard.front().publisher_id, "a topic has one Publisher");
    readers_.push_back("values of " + std::to_string(each.writer_group_id));
    const std::size_t group = subscriber_.add_reader_group(each.writer_group_id);
    subscriber_.add_data_set(readers_.back(), values_, {.data_set_writer_id = data_set_writer}, group);
  }
  values_.on_received([this] { has_come_ = true; });
  communication_.add_subscriber(subscriber_);
  communication_.enable(now);
}

std::optional<uadp::Octets> OpcUaSubscription::receive(uadp::Octets message, sim::LocalTime now) {
  has_come_ = false;
  communication_.received(message, now);
  return has_come_ ? std::optional(values_.octets()) : std::nullopt;
}

std::uint64_t OpcUaSubscription::lost() const {
  std::uint64_t sum = 0;
  for (const std::string& name : readers_) sum += subscriber_.reader(name)->missed();
  return sum;
}

}  // namespace takt::application
