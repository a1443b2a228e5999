// SPDX-License-Identifier: Apache-2.0
// Numbers of changes and of fragments, and the sets of them that acknowledge, ask again and leave out
// (DDSI-RTPS 8.3.5.4, 8.3.5.5, 9.4.2.6).
#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace takt::dds {

/// The number of a change of one writer: 1, 2, ... ; 0 is before the first. Never rolls over.
struct SequenceNumber {
  std::int64_t value = 0;
  /// SEQUENCENUMBER_UNKNOWN: high -1, low 0.
  static constexpr SequenceNumber unknown() { return {-(std::int64_t{1} << 32)}; }

  constexpr auto operator<=>(const SequenceNumber&) const = default;
  constexpr SequenceNumber next() const { return {value + 1}; }
  constexpr SequenceNumber previous() const { return {value - 1}; }
  constexpr SequenceNumber& operator++() {
    ++value;
    return *this;
  }
  friend constexpr SequenceNumber operator+(SequenceNumber a, std::int64_t n) { return {a.value + n}; }
  friend constexpr SequenceNumber operator-(SequenceNumber a, std::int64_t n) { return {a.value - n}; }
  friend constexpr std::int64_t operator-(SequenceNumber a, SequenceNumber b) { return a.value - b.value; }
};

inline constexpr SequenceNumber first_sequence_number{1};
/// The wire is believed up to here (2^62), so that sums never overflow.
inline constexpr SequenceNumber greatest_sequence_number{std::int64_t{1} << 62};

/// The number of a fragment of a sample: 1, 2, ...
struct FragmentNumber {
  std::uint32_t value = 0;
  constexpr auto operator<=>(const FragmentNumber&) const = default;
  constexpr FragmentNumber next() const { return {value + 1}; }
  friend constexpr FragmentNumber operator+(FragmentNumber a, std::int64_t n) {
    return {static_cast<std::uint32_t>(a.value + n)};
  }
  friend constexpr std::int64_t operator-(FragmentNumber a, FragmentNumber b) {
    return std::int64_t{a.value} - b.value;
  }
};

/// Numbers from `base` to at most `base` + 255. Bit i of the bitmap, counted from the most significant of word i / 32,
/// is `base` + i.
template <class N>
class NumberSet {
 public:
  static constexpr std::uint32_t most_bits = 256;

  constexpr NumberSet() = default;
  constexpr explicit NumberSet(N base) : base_(base) {}
  /// As it is on the wire. `bit_count` is at most 256; bits behind it are cleared.
  constexpr NumberSet(N base, std::uint32_t bit_count, const std::array<std::uint32_t, 8>& words)
      : base_(base), bit_count_(bit_count), words_(words) {
    for (std::uint32_t i = 0; i < words_.size(); ++i) {
      const std::uint32_t used = bit_count <= 32 * i ? 0 : bit_count - 32 * i;
      if (used < 32) words_[i] &= used == 0 ? 0U : ~0U << (32 - used);
    }
  }

  constexpr bool operator==(const NumberSet&) const = default;
  constexpr N base() const { return base_; }
  /// numBits of the wire: from the base to the greatest member (or behind it, if so decoded).
  constexpr std::uint32_t bit_count() const { return bit_count_; }
  constexpr std::size_t word_count() const { return (bit_count_ + 31) / 32; }
  constexpr std::uint32_t word(std::size_t index) const { return words_[index]; }

  /// Whether `number` lies where a set with this base can hold it.
  constexpr bool can_hold(N number) const { return number - base_ >= 0 && number - base_ < std::int64_t{most_bits}; }
  /// False, and nothing happens, if the set cannot hold it.
  constexpr bool insert(N number) {
    if (!can_hold(number)) return false;
    const auto bit = static_cast<std::uint32_t>(number - base_);
    words_[bit / 32] |= 1U << (31 - bit % 32);
    if (bit >= bit_count_) bit_count_ = bit + 1;
    return true;
  }
  constexpr bool contains(N number) const {
    if (!can_hold(number)) return false;
    const auto bit = static_cast<std::uint32_t>(number - base_);
    return (words_[bit / 32] >> (31 - bit % 32) & 1U) != 0;
  }
  constexpr std::size_t count() const {
    std::size_t sum = 0;
    for (const std::uint32_t word : words_) sum += static_cast<std::size_t>(std::popcount(word));
    return sum;
  }
  constexpr bool is_empty() const { return count() == 0; }
  constexpr std::optional<N> greatest() const {
    for (std::uint32_t bit = bit_count_; bit != 0; --bit)
      if (contains(base_ + std::int64_t{bit - 1})) return base_ + std::int64_t{bit - 1};
    return std::nullopt;
  }
  /// Calls `visit` with each member, ascending.
  template <class Visit>
  constexpr void for_each(Visit visit) const {
    for (std::uint32_t bit = 0; bit < bit_count_; ++bit)
      if ((words_[bit / 32] >> (31 - bit % 32) & 1U) != 0) visit(base_ + std::int64_t{bit});
  }

 private:
  N base_{};
  std::uint32_t bit_count_ = 0;
  std::array<std::uint32_t, 8> words_{};
};

using SequenceNumberSet = NumberSet<SequenceNumber>;
using FragmentNumberSet = NumberSet<FragmentNumber>;

}  // namespace takt::dds
