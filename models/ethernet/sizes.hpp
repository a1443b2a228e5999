// SPDX-License-Identifier: Apache-2.0
// What a frame occupies on the wire (IEEE 802.3 clauses 3 and 4, IEEE 802.1Q clause 9).
#pragma once

#include <algorithm>

#include "models/ethernet/frame.hpp"

namespace takt::models {

inline constexpr Octets preamble_and_sfd{8};
inline constexpr Octets inter_packet_gap{12};
inline constexpr Octets mac_header{14};  // DA 6, SA 6, EtherType 2
inline constexpr Octets vlan_tag{4};     // TPID 0x8100, PCP 3, DEI 1, VID 12
inline constexpr Octets r_tag{6};        // IEEE 802.1CB clause 7.8
inline constexpr Octets frame_check_sequence{4};
inline constexpr Octets mcrc{4};             // at the end of a fragment that is not the last (IEEE 802.3 clause 99)
inline constexpr Octets minimum_frame{64};   // DA to FCS, the tag included
inline constexpr Octets maximum_msdu{1500};  // the octets after the EtherType
inline constexpr Octets largest_msdu{9000};  // of jumbo frames, which no standard knows
inline constexpr Octets ipv4_and_udp_headers{28};

/// The length from DA to FCS of a frame with an MSDU of that many octets; padded to the minimum.
constexpr Octets frame_length(Octets msdu, bool tagged, bool r_tagged = false) {
  const Octets length =
      mac_header + (tagged ? vlan_tag : Octets{0}) + (r_tagged ? r_tag : Octets{0}) + msdu + frame_check_sequence;
  return std::max(length, minimum_frame);
}

/// What the frame occupies of the medium before the next one may start: preamble, frame and inter-packet gap.
constexpr Octets wire_length(Octets frame) { return preamble_and_sfd + frame + inter_packet_gap; }
/// What one more fragment costs on the medium: its mCRC, the gap behind it and the preamble of the next.
inline constexpr Octets overhead_of_a_cut = mcrc + inter_packet_gap + preamble_and_sfd;

}  // namespace takt::models
