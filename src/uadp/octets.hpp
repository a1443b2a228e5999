// Little-endian numbers at a place in memory: what OPC UA Binary (OPC 10000-6, 5.2.2) makes of integers and floats.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace takt::uadp {

using Octets = std::span<const std::byte>;

namespace detail {
template <std::size_t Size>
using UnsignedOfSize = std::conditional_t<
    Size == 1, std::uint8_t,
    std::conditional_t<Size == 2, std::uint16_t, std::conditional_t<Size == 4, std::uint32_t, std::uint64_t>>>;
}  // namespace detail

/// The number that begins at `at`; sizeof(T) octets must be there.
template <class T>
  requires std::is_arithmetic_v<T> && (!std::same_as<T, bool>)
inline T load_little_endian(const std::byte* at) {
  using Unsigned = detail::UnsignedOfSize<sizeof(T)>;
  if constexpr (std::endian::native == std::endian::little) {
    T copy;  // one load: the compiler does not always see it in the loop below
    std::memcpy(&copy, at, sizeof copy);
    return copy;
  }
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    value = static_cast<Unsigned>(value | static_cast<Unsigned>(static_cast<Unsigned>(at[i]) << (8 * i)));
  return std::bit_cast<T>(value);
}

/// Writes sizeof(T) octets; there must be room for them.
template <class T>
  requires std::is_arithmetic_v<T> && (!std::same_as<T, bool>)
inline void store_little_endian(std::byte* at, T number) {
  using Unsigned = detail::UnsignedOfSize<sizeof(T)>;
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(at, &number, sizeof number);
    return;
  }
  const auto value = std::bit_cast<Unsigned>(number);
  for (std::size_t i = 0; i < sizeof(T); ++i) at[i] = static_cast<std::byte>(value >> (8 * i));
}

}  // namespace takt::uadp
