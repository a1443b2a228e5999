// SPDX-License-Identifier: Apache-2.0
// The stream identity table of a bridge, laid out for speed: a frame of a stream that is known by its address is found
// with one look at a hash table; only entries of other kinds build a header.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "models/ethernet/traffic.hpp"
#include "models/ingress/ingress_config.hpp"

namespace takt::models {

class StreamTable {
 public:
  static constexpr std::uint16_t no_member = 0xFFFF;
  struct Found {
    StreamHandle stream;  ///< or none
    std::uint16_t member = no_member;
    bool operator==(const Found&) const = default;
  };

  /// `first_group` as in mac_address_of. The entries outlive the table.
  StreamTable(std::span<const StreamIdentityEntry> entries, std::uint32_t first_group);

  /// What the first entry that matches says.
  Found identify(const Frame& frame) const {
    std::uint32_t at = first_of(frame.destination);
    while (at != end && !matches(by_address_[at], frame)) at = by_address_[at].next;
    if (others_.empty()) [[likely]]
      return at == end ? Found{} : by_address_[at].found;
    return search_bucket(frame, at);
  }

  /// The same where all entries go by the address; null: identify() knows better, or nothing matches.
  const Found* find_by_address(const Frame& frame) const {
    std::uint32_t at = others_.empty() ? first_of(frame.destination) : end;
    while (at != end && !matches(by_address_[at], frame)) at = by_address_[at].next;
    return at == end ? nullptr : &by_address_[at].found;
  }

 private:
  static constexpr std::uint32_t end = 0xFFFF'FFFF;
  struct ByAddress {
    AddressIndex destination;
    Tagged tagged = Tagged::all;
    VlanId vlan = 0;
    Found found;
    std::uint32_t order = 0;   // in the table
    std::uint32_t next = end;  // entry with the same hash, in the order of the table
  };

  static bool matches(const ByAddress& entry, const Frame& frame) {
    if (entry.destination != frame.destination) return false;
    const bool has_vid = frame.tagged && frame.vlan != 0;
    if (!has_vid) return entry.tagged != Tagged::tagged;
    return entry.tagged != Tagged::priority && (entry.vlan == 0 || entry.vlan == frame.vlan);
  }
  std::size_t home_of(AddressIndex address) const {
    return static_cast<std::size_t>((address.value * 0x9E3779B97F4A7C15ULL) >> 32) & mask_;
  }
  std::uint32_t first_of(AddressIndex address) const { return heads_[home_of(address)]; }
  Found search_bucket(const Frame& frame, std::uint32_t by_address) const;

  std::span<const StreamIdentityEntry> entries_;
  std::vector<ByAddress> by_address_;
  std::vector<std::uint32_t> heads_;  // open hashing: the first of each chain
  std::size_t mask_ = 0;
  std::vector<std::uint32_t> others_;  // entries of other kinds, ascending
  std::uint32_t first_group_;
};

}  // namespace takt::models
