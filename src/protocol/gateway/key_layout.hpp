// SPDX-License-Identifier: Apache-2.0
// Which octets of a payload are its key, and the key hash that they make (DDSI-RTPS 2.5, 9.6.4.8).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gateway/idl_type.hpp"
#include "uadp/octets.hpp"

namespace takt::gateway {

/// The key members in big-endian CDR, in the order of their declaration, filled up with zeros; of more than 16 octets
/// the MD5 of these.
using KeyHash = std::array<std::uint8_t, 16>;

class KeyLayout {
 public:
  /// No key.
  KeyLayout() = default;
  /// Preconditions: the struct has numbers and arrays of numbers only, and members of these names.
  KeyLayout(const IdlStruct& type, std::span<const std::string> keys);

  bool has_key() const { return !members_.empty(); }
  /// Of the key in CDR.
  std::size_t octets() const { return octets_; }
  /// Whether the hash is the key.
  bool is_in_hash() const { return octets_ <= std::tuple_size_v<KeyHash>; }
  /// The key of a serialized payload, of a whole sample or of the key alone, in big-endian CDR without an encapsulation
  /// header. Empty if it is none of the struct.
  std::vector<std::uint8_t> key_in_data(uadp::Octets payload) const { return key_in(payload, &Member::in_data); }
  std::vector<std::uint8_t> key_in_key(uadp::Octets payload) const { return key_in(payload, &Member::in_key); }
  /// Of a serialized payload with its encapsulation header, CDR of either byte order. All zeros if it is none of the
  /// struct.
  KeyHash of_data(uadp::Octets payload) const;
  /// Of a payload that holds the key only.
  KeyHash of_key(uadp::Octets payload) const;

 private:
  struct Member {
    std::size_t in_data = 0;  // behind the header, as the next
    std::size_t in_key = 0;
    std::size_t size = 0;  // of a value
    std::size_t count = 1;
  };
  std::vector<std::uint8_t> key_in(uadp::Octets payload, std::size_t Member::*place) const;
  bool copy_key(uadp::Octets payload, std::size_t Member::*place, std::span<std::uint8_t> key) const;
  KeyHash hash_of(uadp::Octets payload, std::size_t Member::*place) const;

  std::vector<Member> members_;
  std::size_t octets_ = 0;
};

}  // namespace takt::gateway
