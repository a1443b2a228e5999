// SPDX-License-Identifier: Apache-2.0
// Any octets as a NetworkMessage: neither crash nor hang; what is understood survives a round trip.
#include <vector>

#include "pubsub/communication.hpp"
#include "pubsub/memory_stack.hpp"
#include "uadp/encoder.hpp"

namespace {

using namespace takt;

void put_again(uadp::NetworkMessageEncoder& encoder, const uadp::DataSetMessage& message) {
  encoder.begin(message.header);
  if (!message.header.valid || message.header.encoding == uadp::FieldEncoding::RawData) {
    encoder.body(message.body);
  } else {
    uadp::FieldReader fields(message);
    while (const auto field = fields.next()) {
      if (message.header.type == uadp::DataSetMessageType::DeltaFrame)
        encoder.delta_field(field->index, field->value);
      else
        encoder.field(field->value);
    }
  }
  encoder.end();
}

bool is_sound(const uadp::NetworkMessage& message) {
  for (std::size_t i = 0; i < message.count(); ++i) {
    uadp::DataSetMessage each;
    if (decode(message.data_set_message(i), each) != uadp::DecodeStatus::ok || !is_well_formed(each)) return false;
  }
  return true;
}

/// The canonical form of a sound message; nothing if it is too long.
std::vector<std::byte> canonical(const uadp::NetworkMessage& message) {
  std::vector<std::byte> buffer(1U << 17);
  std::vector<std::uint16_t> ids;
  for (std::size_t i = 0; message.writer_ids && i < message.count(); ++i) ids.push_back(*message.writer_id(i));
  uadp::NetworkMessageEncoder encoder = message.writer_ids ? uadp::NetworkMessageEncoder(buffer, message.header, ids)
                                                           : uadp::NetworkMessageEncoder(buffer, message.header);
  for (std::size_t i = 0; i < message.count(); ++i) {
    uadp::DataSetMessage each;
    decode(message.data_set_message(i), each);
    put_again(encoder, each);
  }
  const uadp::Octets octets = encoder.finish();
  return {octets.begin(), octets.end()};
}

void feed_subscriber(uadp::Octets octets) {
  pubsub::MemoryMedium medium;
  pubsub::MemoryPort port(medium, 1, 8);
  pubsub::Communication communication(port, port);
  pubsub::DataSet<std::tuple<std::int32_t, double, std::array<std::int16_t, 3>>> numbers;
  pubsub::DataSet<std::tuple<std::string, std::vector<double>, pubsub::BoundedString<4>>> texts;
  pubsub::Subscriber subscriber(uadp::PublisherId::uint16(2234));
  subscriber.add_data_set("numbers", numbers, {1, sim::Duration::from_ps(1000)});
  subscriber.add_data_set("texts", texts, {2});
  communication.add_subscriber(subscriber);
  communication.enable(sim::LocalTime());
  communication.received(octets, sim::LocalTime());
  communication.received(octets, sim::LocalTime::from_ps(1));
  communication.advance(sim::LocalTime::from_ps(5000));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const uadp::Octets octets = std::as_bytes(std::span(data, size));
  feed_subscriber(octets);
  uadp::NetworkMessage message;
  if (decode(octets, message) != uadp::DecodeStatus::ok || !is_sound(message)) return 0;
  const std::vector<std::byte> once = canonical(message);
  if (once.empty()) return 0;
  uadp::NetworkMessage again;
  TAKT_CHECK(decode(once, again) == uadp::DecodeStatus::ok && is_sound(again),
             "what was understood is sound when written again");
  TAKT_CHECK(canonical(again) == once, "the canonical form is its own canonical form");
  return 0;
}
