// SPDX-License-Identifier: Apache-2.0
// The octets of a frame as a capture shows them: from the destination address to the last octet before the FCS.
//
//   DA 6 | SA 6 | [0x8100, PCP DEI VID] | [R-TAG 6] | EtherType 2 | [IPv4 20 | UDP 8] | payload | padding
//
// A stream with 28 octets of headers is UDP over IPv4 (EtherType 0x0800): lengths and checksums are right. Others are
// 0x88B5, "local experimental" of IEEE 802. The model counts lengths of payloads it does not hold; such a payload is
// shown as "TAKT", the stream's index (4 octets), the sequence number (8) and counting octets, and it fills the frame,
// padding included.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "models/ethernet/mac_address.hpp"
#include "models/ethernet/sizes.hpp"
#include "models/frer/r_tag.hpp"
#include "models/network.hpp"

namespace takt::output {

inline constexpr std::uint16_t local_experimental_ether_type = 0x88B5;
inline constexpr std::uint16_t first_udp_port =
    49152;  ///< the dynamic ports: stream n uses 49152 + n mod 16384 at both ends

/// What a frame does not say itself.
struct FrameEncoding {
  std::uint32_t first_group = 0;                      ///< addresses from this index on are groups: the number of nodes
  models::Octets headers{0};                          ///< of the stream, see models::Stream; other than 28: zeros
  std::optional<std::span<const std::byte>> payload;  ///< if the model holds the octets
  std::optional<models::SequenceNumber> r_tag;
  bool drop_eligible = false;
  std::uint16_t ether_type = local_experimental_ether_type;  ///< of frames without IPv4
  std::uint16_t udp_port = 0;                                ///< of the receivers; 0: as above
  std::uint16_t udp_source_port = 0;                         ///< of the sender; 0: as above
  std::uint32_t ip_group = 0;  ///< IPv4 multicast address to which it goes; 0: see ipv4_address_of
};

/// Room for the longest jumbo frame with all its tags.
using FrameBuffer = std::array<std::byte, models::frame_length(models::largest_msdu, true, true).count>;

/// 10.x.y.z for a node, 239.x.y.z for a group; x.y.z is the index of the address, plus one for a node so that it is
/// not 10.0.0.0.
std::uint32_t ipv4_address_of(models::AddressIndex address, std::uint32_t first_group);

/// Writes the frame, frame.length - 4 octets, to the front of the buffer.
std::span<const std::byte> encode_frame(const models::Frame& frame, const FrameEncoding& encoding, FrameBuffer& buffer);

/// The same for a frame that is under way in a network.
std::span<const std::byte> encode_frame(const models::Network& network, models::FrameIndex frame, FrameBuffer& buffer);
/// The same for a frame that was; `payload`: its octets, if the model held them.
std::span<const std::byte> encode_frame(const models::Network& network, const models::Frame& frame,
                                        std::span<const std::byte> payload, FrameBuffer& buffer);

}  // namespace takt::output
