// Octets that somebody else owns, and numbers in both byte orders: RTPS tells the order of each submessage by a flag, CDR that of each payload.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace takt::dds {

using Octets = std::span<const std::byte>;

enum class ByteOrder : std::uint8_t { big, little };

template <class T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

namespace detail {
template <std::size_t Size>
using UnsignedOfSize = std::conditional_t<
    Size == 1, std::uint8_t,
    std::conditional_t<Size == 2, std::uint16_t, std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;
}  // namespace detail

/// The number that begins at `at`; sizeof(T) octets must be there.
template <Number T>
inline T load(const std::byte* at, ByteOrder order) {
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
  const auto value = std::bit_cast<detail::UnsignedOfSize<sizeof(T)>>(number);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const std::size_t shift = 8 * (order == ByteOrder::little ? i : sizeof(T) - 1 - i);
    at[i] = static_cast<std::byte>(value >> shift);
  }
}

constexpr std::size_t rounded_up(std::size_t size, std::size_t alignment) { return (size + alignment - 1) / alignment * alignment; }

}  // namespace takt::dds
