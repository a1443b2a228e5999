#include "models/clock/fixed_sine.hpp"

#include "sim/time.hpp"

namespace takt::models {
namespace {

constexpr int bits = 62;
constexpr std::int64_t half_pi = 0x6487ED5110B4611A;  // pi / 2 * 2^62

std::int64_t product(std::int64_t a, std::int64_t b) { return static_cast<std::int64_t>((sim::int128{a} * b) >> bits); }

}  // namespace

std::int64_t fixed_sine(std::uint64_t turns) {
  const bool negative = turns >> 63 != 0;
  std::uint64_t half = turns << 1 >> 1;                                  // [0, 1/2) turn, 2^63 = half a turn
  constexpr std::uint64_t quarter = std::uint64_t{1} << bits;
  if (half > quarter) half = 2 * quarter - half;                         // the second quarter mirrors the first
  const std::int64_t x = product(static_cast<std::int64_t>(half), half_pi);  // radians, [0, pi/2]
  // Taylor to x^25 in Horner's form: x (1 - x^2/(2 3) (1 - x^2/(4 5) (...))); x^27/27! is below 2^-75.
  // x^2 reaches 2.47, more than 62 bits below the point leave room for, so it is divided before it is multiplied.
  const sim::int128 square = (sim::int128{x} * x) >> bits;
  std::int64_t sum = std::int64_t{1} << bits;
  for (int n = 24; n >= 2; n -= 2)
    sum = (std::int64_t{1} << bits) - product(static_cast<std::int64_t>(square / (n * (n + 1))), sum);
  const std::int64_t sine = product(x, sum);
  return negative ? -sine : sine;
}

}  // namespace takt::models
