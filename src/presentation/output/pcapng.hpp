// SPDX-License-Identifier: Apache-2.0
// Blocks of a pcapng capture (draft-ietf-opsawg-pcapng), little-endian, appended to octets in memory: who writes these
// into a file is a matter of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace takt::output::pcapng {

/// Times are nanoseconds, an if_tsresol of 10^-9: with 10^-12 Wireshark 4.0 multiplies beyond 64 bits, and its times
/// begin anew every 18.4 ms.
inline constexpr std::uint8_t time_resolution = 9;

struct Interface {
  std::string name;
  std::uint64_t bits_per_second = 0;
};

/// Begins a section, whose interfaces are numbered from 0 in the order in which they are added.
void add_section_header(std::string& to, std::string_view application);

/// One interface of Ethernet whose frames are captured whole and without FCS. It may come anywhere before its first
/// packet.
void add_interface(std::string& to, const Interface& interface);

/// An Enhanced Packet Block with the flag "outbound". Precondition: time_ns >= 0.
void add_outbound_packet(std::string& to, std::uint32_t interface, std::int64_t time_ns,
                         std::span<const std::byte> octets);

}  // namespace takt::output::pcapng
