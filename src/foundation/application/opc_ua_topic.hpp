// SPDX-License-Identifier: Apache-2.0
// A topic over OPC UA PubSub, between a thread and whatever carries NetworkMessages. A Publisher for each topic, and a
// WriterGroup with one DataSetWriter for each thread that publishes to it.
#pragma once

#include <deque>
#include <span>

#include "application/topic_shape.hpp"
#include "gateway/field_values.hpp"
#include "pubsub/communication.hpp"

namespace takt::application {

/// Who publishes: the topic's number, its PublisherId where it has no other one, and the publication's among those of
/// the topic, from 1 on.
struct OpcUaAddress {
  std::uint16_t publisher_id = 0;
  std::uint16_t writer_group_id = 0;
};

/// What messages say of who publishes: the PublisherId, nothing if it is off. A String is the shape's.
std::optional<uadp::PublisherId> publisher_of(const TopicShape& topic, const OpcUaAddress& address);
/// With WriterGroupId and content mask.
pubsub::WriterGroupSettings group_settings(const TopicShape& topic, const OpcUaAddress& address,
                                           uadp::DateTime epoch = {});
pubsub::DataSetWriterSettings writer_settings(const TopicShape& topic);

/// Octets of the longest NetworkMessage of the topic; 0 if a sample may be too long for one.
std::size_t longest_message(const TopicShape& topic, const OpcUaAddress& address);

/// Octets of its longest DataSetMessage, without what a ConfiguredSize adds.
std::size_t longest_data_set_message(const TopicShape& topic);
/// Each DataSetMessage has room in the ConfiguredSize of the topic, if it has one.
void check_configured_size(const plant::Topic& topic, const TopicShape& shape, json::Diagnostics& diagnostics);

/// Calls the stack once for each value, and with delta frames not if nothing has changed; neither moves while it lives.
class OpcUaPublication {
 public:
  /// `epoch`: the UTC time at local time 0, for time stamps.
  OpcUaPublication(const TopicShape& topic, const OpcUaAddress& address, pubsub::PublishedData& stack,
                   sim::LocalTime now, uadp::DateTime epoch = {});
  OpcUaPublication(const OpcUaPublication&) = delete;
  OpcUaPublication& operator=(const OpcUaPublication&) = delete;

  /// False, and nothing is said, if these are not the fields of the topic.
  bool publish(uadp::Octets fields, sim::LocalTime now);

 private:
  struct NoInput final : pubsub::SubscribedData {
    uadp::Octets next() override { return {}; }
  };
  NoInput input_;
  gateway::FieldValues values_;
  pubsub::Publisher publisher_;
  pubsub::Communication communication_;
};

class OpcUaSubscription {
 public:
  /// Hears these, which are all of one Publisher.
  OpcUaSubscription(const TopicShape& topic, std::span<const OpcUaAddress> heard, sim::LocalTime now);
  OpcUaSubscription(const OpcUaSubscription&) = delete;
  OpcUaSubscription& operator=(const OpcUaSubscription&) = delete;

  /// All fields after the message, valid until the next call; nothing if it is not for this subscription. Of each
  /// publication samples are what was published: behind a loss delta frames are not taken until the next key frame.
  std::optional<uadp::Octets> receive(uadp::Octets message, sim::LocalTime now);
  /// Messages that were sent, as their numbers show, and did not come or were not taken.
  std::uint64_t lost() const;

 private:
  struct NoInput final : pubsub::SubscribedData {
    uadp::Octets next() override { return {}; }
  };
  struct NoOutput final : pubsub::PublishedData {
    void publish(uadp::Octets, const pubsub::Destination&) override {}
  };
  NoInput input_;
  NoOutput output_;
  std::deque<gateway::FieldValues>
      values_;  // one for each WriterGroup: delta frames say what has changed since its own
  pubsub::Subscriber subscriber_;
  std::vector<std::string> readers_;  // the same
  pubsub::Communication communication_;
  const gateway::FieldValues* come_ = nullptr;  // of the present message
};

}  // namespace takt::application
