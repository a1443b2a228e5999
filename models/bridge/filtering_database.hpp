// SPDX-License-Identifier: Apache-2.0
// The static filtering database of a bridge: (VLAN, address) -> ports (IEEE 802.1Q clause 8.8).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "models/bridge/internal_port.hpp"
#include "models/ethernet/frame.hpp"
#include "sim/check.hpp"

namespace takt::models {

/// Open addressing in one array of 8-octet words, so that a look-up touches one cache line and large networks stay in
/// the cache. Learning is off: entries come from the topology.
class FilteringDatabase {
 public:
  /// What an entry says: one port, or a set of ports in ports_of().
  class Entry {
   public:
    constexpr bool found() const { return (word_ & key_mask) != key_mask; }
    constexpr bool is_one_port() const { return (word_ & several) == 0; }
    /// Precondition: found() and is_one_port().
    constexpr std::uint16_t port() const { return static_cast<std::uint16_t>(word_); }

   private:
    friend FilteringDatabase;
    constexpr explicit Entry(std::uint64_t word) : word_(word) {}
    std::uint64_t word_;
  };

  FilteringDatabase() : words_(1, empty_word) {}

  /// Adds a port, below 2^15, to the entry of (vlan, address); adding it twice changes nothing.
  void add(VlanId vlan, AddressIndex address, std::uint16_t port);

  /// Replaces the entry of (vlan, address): frames leave through these ports from now on; through none: they are
  /// dropped.
  void assign(VlanId vlan, AddressIndex address, std::span<const std::uint16_t> ports);

  Entry find(VlanId vlan, AddressIndex address) const {
    const std::uint64_t key = key_of(vlan, address);
    for (std::size_t at = home_of(key);; at = (at + 1) & mask_) {
      const std::uint64_t word = words_[at];
      if ((word & key_mask) == key || word == empty_word) return Entry(word);
    }
  }
  /// The port of an entry that names one port and lies where it is looked for first, as nearly all do; otherwise
  /// not_at_once, and find() must be asked.
  std::uint32_t single_egress_port(VlanId vlan, AddressIndex address) const {
    const std::uint64_t key = key_of(vlan, address);
    const std::uint64_t rest = words_[home_of(key)] ^ key;  // of a word with this key: what is not key
    return rest < several ? static_cast<std::uint32_t>(rest) : not_at_once;
  }
  static constexpr std::uint32_t not_at_once = 0xFFFF'FFFF;
  /// The ports of an entry that was found, in ascending order. The span lives until the next add().
  std::span<const std::uint16_t> ports_of(const Entry& entry) const { return sets_[entry.port()]; }

  std::size_t entries() const { return entries_; }
  /// Brings the word of (vlan, address) towards the cache. Costs nothing but the instruction.
  void prefetch(VlanId vlan, AddressIndex address) const {
    __builtin_prefetch(&words_[home_of(key_of(vlan, address))]);
  }

 private:
  // A word: address 32 bits, VLAN 12 bits, 4 bits of which one says "several ports", port or number of the set 16 bits.
  static constexpr std::uint64_t several = 1ULL << 16;
  static constexpr std::uint64_t key_mask = ~((1ULL << 20) - 1);
  static constexpr std::uint64_t empty_word = ~0ULL;  // address "none" in VLAN 4095, which does not exist

  static constexpr std::uint64_t key_of(VlanId vlan, AddressIndex address) {
    return static_cast<std::uint64_t>(address.value) << 32 | static_cast<std::uint64_t>(vlan & 0xFFF) << 20;
  }
  /// Fibonacci hashing: the high bits of one product.
  std::size_t home_of(std::uint64_t key) const {
    return static_cast<std::size_t>(((key >> 20) * 0x9E3779B97F4A7C15ULL) >> 32) & mask_;
  }
  std::uint64_t& word_for(std::uint64_t key);
  /// The entry becomes one of a set of ports.
  void make_set(std::uint64_t& word, std::vector<std::uint16_t> ports);
  void grow();

  std::vector<std::uint64_t> words_;
  std::size_t mask_ = 0;
  std::size_t entries_ = 0;
  std::vector<std::vector<std::uint16_t>> sets_;
};

}  // namespace takt::models
