// SPDX-License-Identifier: Apache-2.0
// Lengths of time as bounds need them: whole picoseconds that saturate at "unbounded", and roundings that never make a
// bound too small.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "sim/time.hpp"

namespace takt::analysis {

/// Picoseconds. Not sim::Duration, whose sums wrap around: a bound that grows without end stops here.
using Ps = std::int64_t;

/// Rates of clocks and links are factors in parts of this, as in 1 + 10^-12 * rate_ppt.
inline constexpr std::int64_t one_ppt = 1'000'000'000'000;

/// No bound. Every Ps at or above counts as unbounded; half the range, so that two of them can be added.
inline constexpr Ps unbounded_ps = std::numeric_limits<Ps>::max() / 4;

constexpr bool is_bounded(Ps value) { return value < unbounded_ps; }
constexpr std::optional<sim::Duration> duration_of(Ps value) {
  return is_bounded(value) ? std::optional(sim::Duration::from_ps(value)) : std::nullopt;
}
constexpr Ps sum(Ps a, Ps b) { return is_bounded(a) && is_bounded(b) && is_bounded(a + b) ? a + b : unbounded_ps; }
template <class... More>
constexpr Ps sum(Ps a, Ps b, More... more) {
  return sum(sum(a, b), more...);
}
/// a * n, both not negative.
constexpr Ps product(Ps a, std::int64_t n) {
  if (a == 0 || n == 0) return 0;
  const sim::int128 value = static_cast<sim::int128>(a) * n;
  return is_bounded(a) && value < unbounded_ps ? static_cast<Ps>(value) : unbounded_ps;
}
/// a * numerator / denominator, rounded up; a and the factors not negative.
constexpr Ps scaled_up(Ps a, std::int64_t numerator, std::int64_t denominator) {
  if (!is_bounded(a)) return unbounded_ps;
  const sim::int128 value = (static_cast<sim::int128>(a) * numerator + denominator - 1) / denominator;
  return value < unbounded_ps ? static_cast<Ps>(value) : unbounded_ps;
}
/// The same, rounded down.
constexpr Ps scaled_down(Ps a, std::int64_t numerator, std::int64_t denominator) {
  return static_cast<Ps>(static_cast<sim::int128>(a) * numerator / denominator);
}

/// What was worked out in floating point by a few dozen operations, rounded up beyond their error.
inline Ps rounded_up(double ps) {
  if (!(ps < static_cast<double>(unbounded_ps))) return unbounded_ps;
  const double up = std::ceil(ps + std::fabs(ps) * 1e-12) + 1;
  return up < static_cast<double>(unbounded_ps) ? static_cast<Ps>(up) : unbounded_ps;
}

}  // namespace takt::analysis
