// SPDX-License-Identifier: Apache-2.0
// Any octets at a subscriber of a topic: what it takes can be asked for the value that an output follows, whatever is
// Bad, short or of another type in it.
//
// The first octet chooses what they are: an even one, the fields themselves, which nothing has checked; an odd one,
// NetworkMessages to one of four subscribers. The first of these takes all as one message, the others messages that
// each have their length in front, so that delta frames follow key frames.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "application/opc_ua_topic.hpp"

namespace {

using namespace takt;
using namespace takt::application;
using plant::NetworkMessagePart;
using plant::TopicType;

TopicShape numbers() {
  plant::Topic topic;
  topic.name = "x";
  topic.protocol = plant::Protocol::opc_ua;
  topic.fields = {
      {"part", {TopicType::uint16, 1}}, {"level", {TopicType::uint32, 1}}, {"axes", {TopicType::float64, 2}}};
  return shape_of(topic, {"part"});
}

/// All that is no number, and how messages say whose they are.
TopicShape mixed(std::vector<NetworkMessagePart> parts) {
  plant::Topic topic;
  topic.name = "y";
  topic.protocol = plant::Protocol::opc_ua;
  topic.fields = {{"s", {TopicType::string, 1, std::uint16_t{5}}},
                  {"n", {TopicType::uint16}},
                  {"g", {TopicType::guid}},
                  {"t", {TopicType::date_time}},
                  {"b", {TopicType::byte_string, 2, std::uint16_t{3}}}};
  topic.uadp.emplace().network_message = std::move(parts);
  topic.uadp->major_version = 5;
  return shape_of(topic, {});
}

/// What was taken are values of the topic: they can be published again.
void use(const TopicShape& topic, uadp::Octets fields) {
  static_cast<void>(topic.is_zero(fields));
  struct Nobody final : pubsub::PublishedData {
    void publish(uadp::Octets message, const pubsub::Destination&) override {
      longest = std::max(longest, message.size());
    }
    std::size_t longest = 0;
  } nobody;
  OpcUaPublication again(topic, {7, 1}, nobody, sim::LocalTime());
  if (again.publish(fields, sim::LocalTime()) && nobody.longest > longest_message(topic, {7, 1})) std::abort();
}

void hear(const TopicShape& topic, uadp::Octets octets, bool is_one) {
  const OpcUaAddress heard[] = {{7, 1}, {7, 2}};
  OpcUaSubscription subscription(topic, heard, sim::LocalTime());
  while (!octets.empty()) {
    const std::size_t length =
        is_one ? octets.size() : std::min(octets.size() - 1, std::to_integer<std::size_t>(octets[0]));
    const uadp::Octets message = is_one ? octets : octets.subspan(1, length);
    if (const std::optional<uadp::Octets> fields = subscription.receive(message, sim::LocalTime())) use(topic, *fields);
    octets = octets.subspan(is_one ? length : 1 + length);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const TopicShape topics[] = {numbers(),
                                      mixed({NetworkMessagePart::publisher_id, NetworkMessagePart::group_header,
                                             NetworkMessagePart::writer_group_id, NetworkMessagePart::payload_header}),
                                      mixed({NetworkMessagePart::group_header, NetworkMessagePart::writer_group_id,
                                             NetworkMessagePart::payload_header}),
                                      mixed({})};
  const uadp::Octets octets(reinterpret_cast<const std::byte*>(data + 1), size - 1);
  const std::size_t which = data[0] / 2 % 4;
  if (data[0] % 2 == 0)
    static_cast<void>(topics[which].is_zero(octets));
  else
    hear(topics[which], octets, which == 0);
  return 0;
}
