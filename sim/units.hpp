// SPDX-License-Identifier: Apache-2.0
// Quantities with a unit other than time: octets, data rates, lengths, frequency ratios. Exact integers throughout.
#pragma once

#include <compare>
#include <cstdint>

#include "sim/time.hpp"

namespace takt::sim {

/// A number of octets (the standards' word for 8 bits).
struct Octets {
  std::uint32_t count = 0;
  constexpr auto operator<=>(const Octets&) const = default;
  friend constexpr Octets operator+(Octets a, Octets b) { return {a.count + b.count}; }
  friend constexpr Octets operator-(Octets a, Octets b) { return {a.count - b.count}; }
};
constexpr Octets operator""_B(unsigned long long n) { return {static_cast<std::uint32_t>(n)}; }

/// A data rate in bits per second, 1 b/s to about 1.8e19 b/s.
struct DataRate {
  std::uint64_t bits_per_second = 0;
  constexpr auto operator<=>(const DataRate&) const = default;

  static constexpr std::uint64_t ps_in_8_seconds = 8'000'000'000'000ULL;
  /// True if an octet lasts a whole number of picoseconds, as at every Ethernet rate from 10 Mb/s to 100 Gb/s.
  constexpr bool has_exact_octet_time() const { return bits_per_second != 0 && ps_in_8_seconds % bits_per_second == 0; }
  /// The time of one octet. Exact only if has_exact_octet_time(); otherwise rounded up.
  constexpr Duration octet_time() const {
    return Duration::from_ps(static_cast<std::int64_t>((ps_in_8_seconds + bits_per_second - 1) / bits_per_second));
  }
};
constexpr DataRate operator""_Mbps(unsigned long long n) { return {n * 1'000'000ULL}; }
constexpr DataRate operator""_Gbps(unsigned long long n) { return {n * 1'000'000'000ULL}; }

/// A length of cable in millimetres.
struct Length {
  std::int64_t millimetres = 0;
  constexpr auto operator<=>(const Length&) const = default;
};
constexpr Length operator""_m(unsigned long long n) { return {static_cast<std::int64_t>(n) * 1'000}; }

/// A relative frequency deviation in parts per 10^12 (1 ppm = 1'000'000).
struct FrequencyOffset {
  std::int64_t parts_per_trillion = 0;
  constexpr auto operator<=>(const FrequencyOffset&) const = default;
};

}  // namespace takt::sim
