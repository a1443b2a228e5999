// SPDX-License-Identifier: Apache-2.0
// Time and durations as they are on the wire: seconds and 2^-32 of a second (DDSI-RTPS 8.3.5.8, 9.3.2).
//
// Beyond the wire takt reckons in picoseconds (sim/time.hpp). A fraction is 232.8 ps, so what is read is rounded to
// whole nanoseconds, as other implementations do: all that is a multiple of 1 ns survives, and 1 ms offered is not
// longer than 1 ms requested.
#pragma once

#include <compare>
#include <cstdint>

#include "sim/time.hpp"

namespace takt::dds {

/// The standard's infinite duration, for QoS and time-outs. What is longer than 106 days is taken for it.
inline constexpr sim::Duration infinite = sim::Duration::max();

namespace detail {
inline constexpr std::int64_t ps_per_second = 1'000'000'000'000;
inline constexpr std::int64_t ps_per_ns = 1'000;

struct Fixed {
  std::int32_t seconds = 0;
  std::uint32_t fraction = 0;
};
/// Rounds to the nearest fraction. Every sim::Duration has less than 2^31 seconds.
constexpr Fixed to_fixed(std::int64_t ps) {
  std::int64_t seconds = ps / ps_per_second;
  std::int64_t rest = ps % ps_per_second;
  if (rest < 0) {
    rest += ps_per_second;
    --seconds;
  }
  const auto scaled = ((static_cast<sim::uint128>(rest) << 32) + ps_per_second / 2) / ps_per_second;
  if (scaled >> 32 != 0) return {static_cast<std::int32_t>(seconds + 1), 0};
  return {static_cast<std::int32_t>(seconds), static_cast<std::uint32_t>(scaled)};
}
/// Rounds to the nearest nanosecond; saturates.
constexpr std::int64_t to_ps(Fixed fixed) {
  const std::int64_t ns = static_cast<std::int64_t>(
      (static_cast<sim::uint128>(fixed.fraction) * 1'000'000'000U + (std::uint64_t{1} << 31)) >> 32);
  const sim::int128 sum = static_cast<sim::int128>(fixed.seconds) * ps_per_second + ns * ps_per_ns;
  constexpr sim::int128 most = sim::Duration::max().ps();
  return sum > most    ? sim::Duration::max().ps()
         : sum < -most ? -sim::Duration::max().ps()
                       : static_cast<std::int64_t>(sum);
}
}  // namespace detail

/// Duration_t.
struct Duration {
  std::int32_t seconds = 0;
  std::uint32_t fraction = 0;  ///< 2^-32 s
  constexpr auto operator<=>(const Duration&) const = default;

  static constexpr Duration zero() { return {}; }
  static constexpr Duration infinite() { return {0x7FFF'FFFF, 0xFFFF'FFFFU}; }
  static constexpr Duration from(sim::Duration duration) {
    if (duration == dds::infinite) return infinite();
    const detail::Fixed fixed = detail::to_fixed(duration.ps());
    return {fixed.seconds, fixed.fraction};
  }
  constexpr bool is_infinite() const { return *this == infinite(); }
  constexpr sim::Duration to_sim() const { return sim::Duration::from_ps(detail::to_ps({seconds, fraction})); }
};

/// Time_t: since 1970, or since the zero of whatever clock stamps the samples. In takt: the local time of the node.
struct Time {
  std::int32_t seconds = 0;
  std::uint32_t fraction = 0;  ///< 2^-32 s
  constexpr auto operator<=>(const Time&) const = default;

  static constexpr Time zero() { return {}; }
  static constexpr Time invalid() { return {-1, 0xFFFF'FFFFU}; }
  static constexpr Time infinite() { return {0x7FFF'FFFF, 0xFFFF'FFFFU}; }
  static constexpr Time from(sim::LocalTime time) {
    if (time == sim::LocalTime::never()) return infinite();
    const detail::Fixed fixed = detail::to_fixed(time.ps());
    return {fixed.seconds, fixed.fraction};
  }
  constexpr bool is_invalid() const { return *this == invalid(); }
  /// Saturates at never(), for example when the other end counts from 1970.
  constexpr sim::LocalTime to_local() const { return sim::LocalTime::from_ps(detail::to_ps({seconds, fraction})); }
};

}  // namespace takt::dds
