#include "wire/program_message.hpp"

#include "wire/octet_reader.hpp"
#include "wire/octet_writer.hpp"

namespace takt::wire {
namespace {

constexpr std::uint8_t layout_version = 1;
enum class Kind : std::uint8_t { state = 1, process_data = 2 };

void put_head(OctetWriter& writer, Kind kind, std::uint8_t sender) {
  writer.put(layout_version);
  writer.put(static_cast<std::uint8_t>(kind));
  writer.put(sender);
}

std::span<const std::byte> finished(const OctetWriter& writer) {
  return writer.overflowed() ? std::span<const std::byte>() : writer.written();
}

std::optional<ProgramMessage> decode_state(std::uint8_t sender, OctetReader& reader) {
  StateMessage message;
  message.sender = sender;
  reader.get<std::uint8_t>();  // reserved
  message.sequence = reader.get<std::uint16_t>();
  message.word.incarnation = reader.get<std::uint32_t>();
  const auto state = handshake::published_state_from_number(reader.get<std::uint8_t>());
  const auto kind = reader.get<std::uint8_t>();
  message.word.intent.origin = reader.get<std::uint8_t>();
  reader.get<std::uint8_t>();  // reserved
  message.word.intent.number = reader.get<std::uint32_t>();
  message.word.intent.run = reader.get<std::uint32_t>();
  message.word.run = reader.get<std::uint32_t>();
  reader.get<std::uint16_t>();  // reserved
  if (reader.failed() || !state || kind >= handshake::intent_kind_count) return std::nullopt;
  message.word.state = *state;
  message.word.intent.kind = static_cast<handshake::IntentKind>(kind);
  return message;
}

}  // namespace

std::span<const std::byte> encode(const StateMessage& message, std::span<std::byte> target) {
  OctetWriter writer(target);
  put_head(writer, Kind::state, message.sender);
  writer.put(std::uint8_t{0});
  writer.put(message.sequence);
  writer.put(message.word.incarnation);
  writer.put(static_cast<std::uint8_t>(message.word.state));
  writer.put(static_cast<std::uint8_t>(message.word.intent.kind));
  writer.put(message.word.intent.origin);
  writer.put(std::uint8_t{0});
  writer.put(message.word.intent.number);
  writer.put(message.word.intent.run);
  writer.put(message.word.run);
  writer.put(std::uint16_t{0});
  return finished(writer);
}

std::span<const std::byte> encode(const ProcessDataMessage& message, std::size_t field_octets, std::span<std::byte> target) {
  OctetWriter writer(target);
  put_head(writer, Kind::process_data, message.sender);
  writer.put(message.data_set);
  writer.put(message.sequence);
  writer.put(message.run);
  writer.put_zeros(field_octets);
  return finished(writer);
}

std::optional<ProgramMessage> decode(std::span<const std::byte> octets) {
  OctetReader reader(octets);
  if (reader.get<std::uint8_t>() != layout_version) return std::nullopt;
  const auto kind = reader.get<std::uint8_t>();
  const auto sender = reader.get<std::uint8_t>();
  if (kind == static_cast<std::uint8_t>(Kind::state)) return decode_state(sender, reader);
  if (kind != static_cast<std::uint8_t>(Kind::process_data)) return std::nullopt;
  ProcessDataMessage message;
  message.sender = sender;
  message.data_set = reader.get<std::uint8_t>();
  message.sequence = reader.get<std::uint16_t>();
  message.run = reader.get<std::uint32_t>();
  if (reader.failed()) return std::nullopt;
  return message;
}

}  // namespace takt::wire
