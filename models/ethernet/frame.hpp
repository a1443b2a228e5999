// A frame in flight, and the names by which the network knows streams, addresses and payloads.
#pragma once

#include <compare>
#include <cstdint>

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

/// A frame. Copies of a multicast share one record; it does not change on its way except by a copy of its own.
struct alignas(64) Frame {
  sim::TrueTime produced;          ///< when the application handed it over
  std::uint64_t sequence = 0;      ///< number within its stream, from 0
  AddressIndex destination;
  AddressIndex source;
  StreamIndex stream;
  PayloadIndex payload;            ///< none: only its length counts
  std::uint32_t references = 0;    ///< copies under way
  std::uint16_t length = 0;        ///< octets from DA to FCS as they are on the wire
  VlanId vlan = 0;
  Priority priority = 0;
  bool tagged = false;
};
static_assert(sizeof(Frame) == 64);

/// Why a frame ended before its destination.
enum class DropReason : std::uint8_t {
  queue_frames,         ///< the queue held its greatest number of frames
  queue_octets,         ///< the queue held its greatest number of octets
  no_filtering_entry,   ///< the filtering database knows no port for its address
  queue_max_sdu,        ///< longer than its queue allows (IEEE 802.1Q 8.6.8.4)
  count
};
constexpr const char* name_of(DropReason reason) {
  switch (reason) {
    case DropReason::queue_frames: return "queue_frames";
    case DropReason::queue_octets: return "queue_octets";
    case DropReason::no_filtering_entry: return "no_filtering_entry";
    case DropReason::queue_max_sdu: return "queue_max_sdu";
    case DropReason::count: break;
  }
  return "?";
}

}  // namespace takt::models
