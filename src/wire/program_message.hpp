// What participants of a Program send each other: their word, or process data.
//
// A fixed layout of takt's own. It stands where the UADP encoding of OPC UA Part 14 goes: callers know only these values
// and the lengths, so the encoding can be exchanged without touching them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "handshake/word.hpp"

namespace takt::wire {

/// A participant's published word.
struct StateMessage {
  std::uint8_t sender = 0;        ///< participant: 0 the master, 1..n the slaves
  std::uint16_t sequence = 0;     ///< of the sender's state messages; wraps
  handshake::Word word;
  bool operator==(const StateMessage&) const = default;
};

/// The head of a message of process data; the fields follow it.
struct ProcessDataMessage {
  std::uint8_t sender = 0;
  std::uint8_t data_set = 0;      ///< index of the data set in the Program
  std::uint16_t sequence = 0;     ///< of this data set; wraps
  std::uint32_t run = 0;          ///< in which the sender is Running
  bool operator==(const ProcessDataMessage&) const = default;
};

using ProgramMessage = std::variant<StateMessage, ProcessDataMessage>;

inline constexpr std::size_t state_message_length = 28;
inline constexpr std::size_t process_data_header_length = 10;

/// Writes the message and returns what was written; empty if `target` is too small.
std::span<const std::byte> encode(const StateMessage& message, std::span<std::byte> target);
/// Writes the head and `field_octets` zeros for the fields.
std::span<const std::byte> encode(const ProcessDataMessage& message, std::size_t field_octets, std::span<std::byte> target);

/// Nothing if the octets are no such message.
std::optional<ProgramMessage> decode(std::span<const std::byte> octets);

}  // namespace takt::wire
