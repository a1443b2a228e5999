// A topic over OPC UA PubSub, between a thread and whatever carries NetworkMessages. A Publisher for each topic, and a WriterGroup with one DataSetWriter for
// each thread that publishes to it.
#pragma once

#include <span>

#include "application/topic_shape.hpp"
#include "gateway/field_values.hpp"
#include "pubsub/communication.hpp"

namespace takt::application {

/// Who publishes.
struct OpcUaAddress {
  std::uint16_t publisher_id = 0;
  std::uint16_t writer_group_id = 0;
};

/// Calls the stack once for each value; neither moves while it lives.
class OpcUaPublication {
 public:
  OpcUaPublication(const TopicShape& topic, const OpcUaAddress& address, pubsub::PublishedData& stack, sim::LocalTime now);
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

  /// The fields that the message brings, valid until the next call; nothing if it is not for this subscription.
  std::optional<uadp::Octets> receive(uadp::Octets message, sim::LocalTime now);
  /// Messages that were sent, as their numbers show, and did not come.
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
  gateway::FieldValues values_;
  pubsub::Subscriber subscriber_;
  std::vector<std::string> readers_;   // one for each WriterGroup
  pubsub::Communication communication_;
  bool has_come_ = false;
};

}  // namespace takt::application
