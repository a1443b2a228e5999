// SPDX-License-Identifier: Apache-2.0
// A frame in flight, and the names by which the network knows streams, addresses and payloads.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::models {

using sim::Octets;

/// A dense index that does not mix with other indices.
template <class Tag>
struct Index {
  std::uint32_t value = 0xFFFF'FFFF;
  constexpr auto operator<=>(const Index&) const = default;
  constexpr bool is_none() const { return value == 0xFFFF'FFFF; }
};

using NodeIndex = Index<struct NodeTag>;        ///< a host or a bridge
using StreamIndex = Index<struct StreamTag>;    ///< frames that are counted together
using AddressIndex = Index<struct AddressTag>;  ///< a MAC address: one for each host, one for each group
using PayloadIndex = Index<struct PayloadTag>;  ///< the octets of an MSDU in the payload pool
using FrameIndex = Index<struct FrameTag>;      ///< a frame in the frame pool

/// IEEE 802.1Q priority (PCP), 0 to 7.
using Priority = std::uint8_t;
/// VLAN identifier, 0 (priority-tagged) to 4094.
using VlanId = std::uint16_t;
/// Traffic class, 0 to 7; 7 is the most urgent.
using TrafficClass = std::uint8_t;
inline constexpr int traffic_class_count = 8;

/// A frame. Copies of a multicast share one record; a node that changes a frame first makes a separate record
/// (Traffic::own).
struct alignas(64) Frame {
  sim::TrueTime produced;      ///< when the application handed it over
  std::uint64_t sequence = 0;  ///< number within its stream, from 0
  /// If marked: not to be sent before, by the clock of the node where the frame is (launch time; ATS eligibility time
  /// and the bridge's forwarding delay after it).
  sim::LocalTime eligible;
  AddressIndex destination;
  AddressIndex source;
  StreamIndex stream;
  PayloadIndex payload;          ///< none: only its length counts
  std::uint32_t references = 0;  ///< copies under way
  std::uint16_t length = 0;      ///< octets from DA to FCS as they are on the wire
  std::uint16_t msdu = 0;        ///< octets after the EtherType, R-TAG and padding not counted
  VlanId vlan = 0;
  std::uint16_t r_tag_sequence = 0;
  Priority priority = 0;
  std::uint8_t hop = 0;  ///< how many bridges it has passed: see Routes
  Priority queue_priority =
      0;  ///< what decides about the queue: the priority, or the internal priority value of a stream gate
  bool tagged : 1 = false;
  bool r_tagged : 1 = false;       ///< carries an R-TAG with r_tag_sequence (IEEE 802.1CB 7.8)
  bool bad_fcs : 1 = false;        ///< damaged on its way
  bool drop_eligible : 1 = false;  ///< DEI
  bool link_local : 1 = false;     ///< ends at the next node, see link_local.hpp
  bool on_route : 1 = false;       ///< VLAN and destination are those of its stream: see Routes
  bool marked : 1 = false;  ///< eligible and queue_priority belong to the node where the frame is and end with it
};
static_assert(sizeof(Frame) == 64);

/// Why a frame ended before its destination.
enum class DropReason : std::uint8_t {
  queue_frames,        ///< the queue held its greatest number of frames
  queue_octets,        ///< the queue held its greatest number of octets
  no_filtering_entry,  ///< the filtering database knows no port for its address
  queue_max_sdu,       ///< longer than its queue allows (IEEE 802.1Q 8.6.8.4)
  stream_max_sdu,      ///< longer than its stream filter allows, or its stream is blocked because an earlier one was
                       ///< (8.6.5.3)
  stream_gate,         ///< came while its stream gate was closed, or beyond the gate's octets (8.6.5.4)
  flow_meter,          ///< the flow meter gave it the colour red, or yellow where that is dropped (8.6.5.5)
  residence_time,      ///< its ATS scheduler would have kept it longer than the maximum residence time (8.6.11)
  duplicate,           ///< a sequence recovery function has passed a copy of it already (IEEE 802.1CB 7.4.3)
  bad_fcs,             ///< damaged on the way, and found so where it was stored
  link_loss,           ///< lost on a link by chance
  link_down,           ///< its link was down, or went down while it was on it
  node_down,           ///< came to, or waited in, a node that had crashed
  late_launch,         ///< handed over after its launch time
  host_overload,       ///< too many frames waited for the processor of a host
  count
};
constexpr const char* name_of(DropReason reason) {
  constexpr const char* names[] = {"queue_frames",   "queue_octets", "no_filtering_entry", "queue_max_sdu",
                                   "stream_max_sdu", "stream_gate",  "flow_meter",         "residence_time",
                                   "duplicate",      "bad_fcs",      "link_loss",          "link_down",
                                   "node_down",      "late_launch",  "host_overload"};
  static_assert(std::size(names) == static_cast<std::size_t>(DropReason::count));
  return reason < DropReason::count ? names[static_cast<std::size_t>(reason)] : "?";
}

}  // namespace takt::models
