// Any octets at a subscriber of a topic: what it takes can be asked for the value that an output follows, whatever is Bad, short or of another type in it.
//
// The first octet chooses between a NetworkMessage to the subscriber and the fields themselves, which nothing has checked.
#include <cstdint>
#include <optional>

#include "application/opc_ua_topic.hpp"

namespace {

using namespace takt;
using namespace takt::application;

TopicShape shape() {
  plant::Topic topic;
  topic.name = "x";
  topic.protocol = plant::Protocol::opc_ua;
  topic.fields = {{"part", {plant::TopicType::uint16, 1}}, {"level", {plant::TopicType::uint32, 1}}, {"axes", {plant::TopicType::float64, 2}}};
  return shape_of(topic, {"part"});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const TopicShape topic = shape();
  const uadp::Octets octets(reinterpret_cast<const std::byte*>(data + 1), size - 1);
  if (data[0] % 2 == 0) {
    static_cast<void>(topic.is_zero(octets));
    return 0;
  }
  const OpcUaAddress heard[] = {{7, 1}};
  OpcUaSubscription subscription(topic, heard, sim::LocalTime());
  if (const std::optional<uadp::Octets> fields = subscription.receive(octets, sim::LocalTime())) static_cast<void>(topic.is_zero(*fields));
  return 0;
}
