// SPDX-License-Identifier: Apache-2.0
// The octets of gPTP messages, IEEE 802.1AS-2020 clauses 10.6 and 11.4: what follows the EtherType 0x88F7 in a frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "models/gptp/message.hpp"

namespace takt::models::gptp {

constexpr std::uint16_t ether_type = 0x88F7;
constexpr std::uint64_t destination_mac = 0x0180'C200'000E;  // individual LAN scope: no bridge forwards it
constexpr std::size_t longest_message = 68 + 8 * Announce::longest_path_trace;

/// messageLength: octets from the first of the header on. An Ethernet frame pads to 46.
std::size_t encoded_length(const Message& message);

/// The message in octets. Precondition: a path trace no longer than longest_path_trace.
void encode(const Message& message, std::vector<std::byte>& octets);

/// The message that `octets` begin with; what follows messageLength is padding. Nothing if it is no well-formed message
/// of a type that is known here: too short, another version or sdoId, nanoseconds of 10^9 and more, a TLV that passes
/// the end or a mandatory one missing. Unknown TLVs after the known contents are skipped. Safe on any octets.
std::optional<Message> decode(std::span<const std::byte> octets);

}  // namespace takt::models::gptp
