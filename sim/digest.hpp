// SPDX-License-Identifier: Apache-2.0
// The digest of a run: 64 bits over what happened.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sim/time.hpp"

namespace takt::sim {

/// A bijective mixer of 64 bits (the finaliser of SplitMix64).
constexpr std::uint64_t mix64(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xBF58476D1CE4E5B9ULL;
  x ^= x >> 27;
  x *= 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// Both halves of a product in one word: each bit of either factor reaches every bit, for the price of one
/// multiplication.
constexpr std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) {
  const uint128 product = static_cast<uint128>(a) * b;
  return static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64);
}

/// Two numbers of a record in one word, in which both count. Cheap, but linear: not to be nested, see Content.
constexpr std::uint64_t joined(std::uint64_t a, std::uint64_t b) { return a * 0x9E3779B97F4A7C15ULL + b; }

/// Any number of numbers in one word, in which each of them counts at its place.
class Content {
 public:
  template <class... Numbers>
  constexpr explicit Content(Numbers... numbers) {
    (add(static_cast<std::uint64_t>(numbers)), ...);
  }
  constexpr void add(std::uint64_t number) { value_ = mix64(joined(value_, number)); }
  constexpr std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1;
};

/// Octets in one word, the same on every machine.
constexpr std::uint64_t hash_of(std::span<const std::byte> octets) {
  Content hash(octets.size());
  std::uint64_t word = 0;
  std::size_t at = 0;
  for (; octets.size() - at >= 8; at += 8) {  // spelt out, so that it becomes one load
    const std::byte* const from = octets.data() + at;
    const auto octet = [&](std::size_t i) { return static_cast<std::uint64_t>(from[i]) << (56 - 8 * i); };
    word = octet(0) | octet(1) | octet(2) | octet(3) | octet(4) | octet(5) | octet(6) | octet(7);
    hash.add(word);
  }
  if (at == octets.size()) return hash.value();
  for (; at < octets.size(); ++at) word = word << 8 | static_cast<std::uint64_t>(octets[at]);
  hash.add(word);
  return hash.value();
}

/// A sum of hashed records. A sum, so that the order in which records of one instant are added does not matter:
/// the digest says what happened when, not in which order the program worked through an instant.
class Digest {
 public:
  /// `kind` names the sort of record, `who` the place, `what` the content.
  void add(std::uint32_t kind, std::uint64_t who, TrueTime when, std::uint64_t what) {
    add(key_of(kind, who), when, what);
  }

  /// The part that records of one kind and place share. Made once by writers of many records.
  struct Key {
    std::uint64_t hash = 0;
  };
  static constexpr Key key_of(std::uint32_t kind, std::uint64_t who) {
    return {mix64(who + 0x9E3779B97F4A7C15ULL * (kind + 1))};
  }
  void add(Key key, TrueTime when, std::uint64_t what) {
    sum_ += folded_product(key.hash ^ static_cast<std::uint64_t>(when.ps()), what ^ 0xD1B54A32D192ED03ULL);
  }
  /// All records that the other one has.
  void add(const Digest& other) { sum_ += other.sum_; }
  std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

}  // namespace takt::sim
