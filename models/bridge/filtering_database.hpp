// The static filtering database of a bridge: (VLAN, address) -> ports (IEEE 802.1Q clause 8.8).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "sim/check.hpp"
#include "sim/digest.hpp"

namespace takt::models {

/// Open addressing in one array, so that a look-up touches one cache line. Learning is off: entries come from the topology.
class FilteringDatabase {
 public:
  /// Adds a port to the entry of (vlan, address); adding it twice changes nothing.
  void add(VlanId vlan, AddressIndex address, std::uint16_t port);

  /// The ports of an entry in ascending order; empty if there is none.
  std::span<const std::uint16_t> find(VlanId vlan, AddressIndex address) const {
    if (slots_.empty()) return {};
    const std::uint64_t key = key_of(vlan, address);
    for (std::size_t at = sim::mix64(key) & mask_;; at = (at + 1) & mask_) {
      const Slot& slot = slots_[at];
      if (slot.key == key) [[likely]]
        return slot.count == 1 ? std::span(&slot.port, 1) : std::span(ports_).subspan(slot.first, slot.count);
      if (slot.key == no_key) return {};
    }
  }

  std::size_t entries() const { return entries_; }

 private:
  static constexpr std::uint64_t no_key = ~0ULL;
  struct Slot {
    std::uint64_t key = no_key;
    std::uint32_t first = 0;   ///< where the ports begin in ports_, if there are several
    std::uint16_t count = 0;
    std::uint16_t port = 0;    ///< the port, if there is one
  };
  static std::uint64_t key_of(VlanId vlan, AddressIndex address) {
    return static_cast<std::uint64_t>(vlan) << 32 | address.value;
  }
  Slot& slot_for(std::uint64_t key);
  void grow();

  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  std::size_t entries_ = 0;
  std::vector<std::uint16_t> ports_;
};

}  // namespace takt::models
