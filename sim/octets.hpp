// SPDX-License-Identifier: Apache-2.0
// Octets that somebody else owns, and numbers in them in both byte orders: one bounded reader and one bounded writer
// for all protocols.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "sim/check.hpp"

namespace takt::sim {

using OctetSpan = std::span<const std::byte>;

enum class ByteOrder : std::uint8_t { big, little };
/// A byte order known at compile time costs nothing. A ByteOrder itself is for messages that announce theirs.
using BigEndian = std::integral_constant<ByteOrder, ByteOrder::big>;
using LittleEndian = std::integral_constant<ByteOrder, ByteOrder::little>;

template <class T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

namespace detail {
template <std::size_t Size>
using UnsignedOfSize = std::conditional_t<
    Size == 1, std::uint8_t,
    std::conditional_t<Size == 2, std::uint16_t, std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;

constexpr bool is_native(ByteOrder order) {
  return (order == ByteOrder::little) == (std::endian::native == std::endian::little);
}
}  // namespace detail

/// The number that begins at `at`; sizeof(T) octets must be there.
template <Number T>
inline T load(const std::byte* at, ByteOrder order) {
  if (detail::is_native(order)) {
    T copy;  // one load: the compiler does not always see it in the loop below
    std::memcpy(&copy, at, sizeof copy);
    return copy;
  }
  using Unsigned = detail::UnsignedOfSize<sizeof(T)>;
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const std::size_t shift = 8 * (order == ByteOrder::little ? i : sizeof(T) - 1 - i);
    value = static_cast<Unsigned>(value | static_cast<Unsigned>(static_cast<Unsigned>(at[i]) << shift));
  }
  return std::bit_cast<T>(value);
}

/// Writes sizeof(T) octets; there must be room for them.
template <Number T>
inline void store(std::byte* at, T number, ByteOrder order) {
  if (detail::is_native(order)) {
    std::memcpy(at, &number, sizeof number);
    return;
  }
  const auto value = std::bit_cast<detail::UnsignedOfSize<sizeof(T)>>(number);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const std::size_t shift = 8 * (order == ByteOrder::little ? i : sizeof(T) - 1 - i);
    at[i] = static_cast<std::byte>(value >> shift);
  }
}

constexpr std::size_t rounded_up(std::size_t size, std::size_t alignment) {
  return (size + alignment - 1) / alignment * alignment;
}

/// Reads from the front, never past the end; allocates nothing. What is not there reads as 0 or as nothing and makes
/// failed() true for good.
template <class Order>
class OctetReader {
 public:
  explicit OctetReader(OctetSpan source) requires std::is_empty_v<Order> : OctetReader(source, Order()) {}
  OctetReader(OctetSpan source, Order order) : source_(source), order_(order) {}

  template <Number T>
  T get() {
    if (left() < sizeof(T)) {
      fail();
      return T{};
    }
    const T value = load<T>(source_.data() + used_, order_);
    used_ += sizeof(T);
    return value;
  }

  /// The next `count` octets; none if they are not all there.
  OctetSpan take(std::size_t count) {
    if (left() < count) {
      fail();
      return {};
    }
    const OctetSpan taken = source_.subspan(used_, count);
    used_ += count;
    return taken;
  }
  /// Skips to a multiple of `alignment`, counted from the beginning.
  void align(std::size_t alignment) { take(rounded_up(used_, alignment) - used_); }

  void fail() {
    failed_ = true;
    used_ = source_.size();
  }
  bool failed() const { return failed_; }
  std::size_t left() const { return source_.size() - used_; }
  /// Octets read so far.
  std::size_t position() const { return used_; }
  /// What was read since a former position().
  OctetSpan since(std::size_t position) const { return source_.subspan(position, used_ - position); }
  OctetSpan rest() const { return source_.subspan(used_); }
  Order order() const { return order_; }

 private:
  OctetSpan source_;
  [[no_unique_address]] Order order_;
  std::size_t used_ = 0;
  bool failed_ = false;
};

/// Writes from the front; allocates nothing. What does not fit is not written and makes overflowed() true until it is
/// taken back.
template <class Order>
class OctetWriter {
 public:
  explicit OctetWriter(std::span<std::byte> target) requires std::is_empty_v<Order> : OctetWriter(target, Order()) {}
  OctetWriter(std::span<std::byte> target, Order order) : target_(target), order_(order) {}

  template <Number T>
  void put(T number) {
    if (!has_room(sizeof(T))) return;
    store(target_.data() + used_, number, order_);
    used_ += sizeof(T);
  }
  void put_octets(OctetSpan octets) {
    if (!has_room(octets.size()) || octets.empty()) return;
    std::memcpy(target_.data() + used_, octets.data(), octets.size());
    used_ += octets.size();
  }
  void put_zeros(std::size_t count) {
    if (!has_room(count) || count == 0) return;
    std::memset(target_.data() + used_, 0, count);
    used_ += count;
  }
  /// Zeros up to a multiple of `alignment`, counted from `origin`.
  void align(std::size_t alignment, std::size_t origin = 0) {
    put_zeros(rounded_up(used_ - origin, alignment) - (used_ - origin));
  }

  /// Overwrites a number that was written before.
  template <Number T>
  void patch(std::size_t position, T number) {
    TAKT_CHECK(position + sizeof(T) <= used_, "only what was written is patched");
    store(target_.data() + position, number, order_);
  }
  /// Takes back what was written after a former position(), and that it did not fit.
  void rewind_to(std::size_t position) {
    TAKT_CHECK(position <= used_, "only what was written is taken back");
    used_ = position;
    overflowed_ = false;
  }

  bool overflowed() const { return overflowed_; }
  std::size_t position() const { return used_; }
  std::size_t room() const { return target_.size() - used_; }
  Order order() const { return order_; }
  OctetSpan written() const { return target_.first(used_); }
  /// All that was written; nothing if something did not fit.
  OctetSpan finished() const { return overflowed_ ? OctetSpan() : written(); }

 private:
  bool has_room(std::size_t count) {
    if (!overflowed_ && room() >= count) [[likely]]
      return true;
    overflowed_ = true;
    return false;
  }

  std::span<std::byte> target_;
  [[no_unique_address]] Order order_;
  std::size_t used_ = 0;
  bool overflowed_ = false;
};

}  // namespace takt::sim
