// SPDX-License-Identifier: Apache-2.0
#include "models/clock/fixed_sine.hpp"

#include <utility>

#include "sim/time.hpp"

namespace takt::models {
namespace {

constexpr int bits = 62;
constexpr std::int64_t half_pi = 0x6487ED5110B4611A;  // pi / 2 * 2^62

std::int64_t product(std::int64_t a, std::int64_t b) { return static_cast<std::int64_t>((sim::int128{a} * b) >> bits); }

/// x^2 reaches 2.47, more than 62 bits below the point leave room for, so it is divided before it is multiplied. By
/// constants, which are no divisions.
template <std::uint64_t... k>
std::int64_t taylor_sum(std::uint64_t square, std::integer_sequence<std::uint64_t, k...>) {
  constexpr std::int64_t one = std::int64_t{1} << bits;
  std::int64_t sum = one;
  ((sum = one - product(static_cast<std::int64_t>(square / ((24 - 2 * k) * (25 - 2 * k))), sum)), ...);
  return sum;
}

}  // namespace

std::int64_t fixed_sine(std::uint64_t turns) {
  const bool negative = turns >> 63 != 0;
  std::uint64_t half = turns << 1 >> 1;  // [0, 1/2) turn, 2^63 = half a turn
  constexpr std::uint64_t quarter = std::uint64_t{1} << bits;
  if (half > quarter) half = 2 * quarter - half;                             // the second quarter mirrors the first
  const std::int64_t x = product(static_cast<std::int64_t>(half), half_pi);  // radians, [0, pi/2]
  // Taylor to x^25 in Horner's form: x (1 - x^2/(2 3) (1 - x^2/(4 5) (...))); x^27/27! is below 2^-75.
  const std::int64_t sine = product(x, taylor_sum(static_cast<std::uint64_t>((sim::int128{x} * x) >> bits),
                                                  std::make_integer_sequence<std::uint64_t, 12>{}));
  return negative ? -sine : sine;
}

}  // namespace takt::models
