// SPDX-License-Identifier: Apache-2.0
// Rates of clocks in fixed point: how fast one clock runs against another, and by how much that differs from one.
//
// Multiples of 2^-62, so that the rate 2 (+10^6 ppm) is still exact; one unit is 2.2e-19, half a picosecond in 26 days.
#pragma once

#include <compare>
#include <cstdint>

#include "sim/check.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::models {

/// numerator / denominator, rounded to the nearest, halves away from zero. Precondition: denominator > 0.
constexpr sim::int128 divide_rounded(sim::int128 numerator, sim::int128 denominator) {
  return numerator >= 0 ? (numerator + denominator / 2) / denominator : -((-numerator + denominator / 2) / denominator);
}

/// A relative frequency difference, y = f/f0 - 1, as a signed multiple of 2^-62; |y| < 2.
class RateOffset {
 public:
  static constexpr int fraction_bits = 62;
  static constexpr std::int64_t one = std::int64_t{1} << fraction_bits;

  constexpr RateOffset() = default;
  static constexpr RateOffset from_multiple(std::int64_t of_2_to_minus_62) {
    RateOffset y;
    y.multiple_ = of_2_to_minus_62;
    return y;
  }
  /// 1 ppm = 1'000'000 parts per 10^12. Precondition: |y| <= 1.
  static constexpr RateOffset from(sim::FrequencyOffset y) {
    constexpr std::int64_t trillion = 1'000'000'000'000;
    TAKT_CHECK(y.parts_per_trillion <= trillion && y.parts_per_trillion >= -trillion,
               "a clock between standstill and twice its rate");
    return from_multiple(
        static_cast<std::int64_t>(divide_rounded(sim::int128{y.parts_per_trillion} << fraction_bits, trillion)));
  }
  /// As 802.1AS writes it in cumulativeScaledRateOffset: a multiple of 2^-41.
  static constexpr RateOffset from_scaled_41(std::int32_t y) {
    return from_multiple(std::int64_t{y} << (fraction_bits - 41));
  }

  constexpr std::int64_t multiple() const { return multiple_; }
  /// Rounded towards minus infinity and limited to what 32 bits hold (about +-977 ppm).
  constexpr std::int32_t scaled_41() const {
    const std::int64_t scaled = multiple_ >> (fraction_bits - 41);
    if (scaled > INT32_MAX) return INT32_MAX;
    return scaled < INT32_MIN ? INT32_MIN : static_cast<std::int32_t>(scaled);
  }
  /// In parts per 10^12, rounded to the nearest.
  constexpr sim::FrequencyOffset frequency_offset() const {
    return {static_cast<std::int64_t>(divide_rounded(sim::int128{multiple_} * 1'000'000'000'000, sim::int128{one}))};
  }

  constexpr auto operator<=>(const RateOffset&) const = default;
  constexpr RateOffset operator-() const { return from_multiple(-multiple_); }
  friend constexpr RateOffset operator+(RateOffset a, RateOffset b) { return from_multiple(a.multiple_ + b.multiple_); }
  friend constexpr RateOffset operator-(RateOffset a, RateOffset b) { return from_multiple(a.multiple_ - b.multiple_); }

 private:
  std::int64_t multiple_ = 0;
};

/// A ratio of two frequencies, greater than 0 and at most 2.
class ClockRate {
 public:
  constexpr ClockRate() = default;  // one
  static constexpr ClockRate one() { return ClockRate(); }
  /// 1 + y, limited to the range of a rate.
  static constexpr ClockRate one_plus(RateOffset y) {
    if (y.multiple() <= -RateOffset::one) return from_multiple(1);
    return y.multiple() >= RateOffset::one ? from_multiple(2 * std::uint64_t{RateOffset::one})
                                           : from_multiple(static_cast<std::uint64_t>(RateOffset::one + y.multiple()));
  }
  static constexpr ClockRate from_multiple(std::uint64_t of_2_to_minus_62) {
    TAKT_CHECK(of_2_to_minus_62 > 0 && of_2_to_minus_62 <= 2 * std::uint64_t{RateOffset::one},
               "a rate above 0 and up to 2");
    ClockRate rate;
    rate.multiple_ = of_2_to_minus_62;
    return rate;
  }
  /// a / b, rounded to the nearest. Precondition: 0 < a <= 2 b.
  static constexpr ClockRate ratio(sim::Duration a, sim::Duration b) {
    TAKT_CHECK(a.ps() > 0 && b.ps() > 0 && a.ps() / 2 <= b.ps(), "a ratio above 0 and up to 2");
    return from_multiple(
        static_cast<std::uint64_t>(divide_rounded(sim::int128{a.ps()} << RateOffset::fraction_bits, b.ps())));
  }

  constexpr std::uint64_t multiple() const { return multiple_; }
  constexpr RateOffset minus_one() const {
    return RateOffset::from_multiple(static_cast<std::int64_t>(multiple_ - std::uint64_t{RateOffset::one}));
  }

  /// d * rate, rounded to the nearest picosecond.
  constexpr sim::Duration times(sim::Duration d) const {
    return sim::Duration::from_ps(
        static_cast<std::int64_t>(divide_rounded(sim::int128{d.ps()} * static_cast<std::int64_t>(multiple_ >> 1),
                                                 sim::int128{1} << (RateOffset::fraction_bits - 1))));
  }
  /// d / rate, rounded to the nearest picosecond.
  constexpr sim::Duration divide(sim::Duration d) const {
    return sim::Duration::from_ps(static_cast<std::int64_t>(
        divide_rounded(sim::int128{d.ps()} << RateOffset::fraction_bits, sim::int128{multiple_})));
  }
  /// The product of two rates, rounded down and limited to the range of a rate.
  friend constexpr ClockRate operator*(ClockRate a, ClockRate b) {
    const sim::uint128 product = (sim::uint128{a.multiple_} * b.multiple_) >> RateOffset::fraction_bits;
    if (product > 2 * std::uint64_t{RateOffset::one}) return from_multiple(2 * std::uint64_t{RateOffset::one});
    return from_multiple(product == 0 ? 1 : static_cast<std::uint64_t>(product));
  }
  friend constexpr ClockRate operator/(ClockRate a, ClockRate b) {
    const sim::uint128 quotient = (sim::uint128{a.multiple_} << RateOffset::fraction_bits) / b.multiple_;
    if (quotient > 2 * std::uint64_t{RateOffset::one}) return from_multiple(2 * std::uint64_t{RateOffset::one});
    return from_multiple(quotient == 0 ? 1 : static_cast<std::uint64_t>(quotient));
  }
  constexpr auto operator<=>(const ClockRate&) const = default;

 private:
  std::uint64_t multiple_ = std::uint64_t{RateOffset::one};
};

}  // namespace takt::models
