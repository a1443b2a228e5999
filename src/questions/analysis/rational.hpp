// SPDX-License-Identifier: Apache-2.0
// Exact fractions, for known answers of network calculus: no rounding anywhere.
//
// Our own, since boost::rational of 128 bits does not see that it overflows, and over Boost.Multiprecision, which does,
// each file that includes this would compile for 2.7 s instead of 0.3 s; reading and writing fractions would stay here
// in any case.
#pragma once

#include <compare>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sim/time.hpp"

namespace takt::analysis {

/// A result has more than 126 bits in its numerator or denominator.
struct RationalOverflow : std::overflow_error {
  RationalOverflow() : std::overflow_error("a fraction has more than 126 bits") {}
};

/// numerator / denominator in lowest terms, denominator > 0. Every operation is exact or throws RationalOverflow.
class Rational {
 public:
  constexpr Rational() = default;
  constexpr Rational(std::int64_t whole) : numerator_(whole) {}  // NOLINT: whole numbers are fractions
  /// Precondition: denominator != 0.
  Rational(sim::int128 numerator, sim::int128 denominator);

  sim::int128 numerator() const { return numerator_; }
  sim::int128 denominator() const { return denominator_; }
  bool is_whole() const { return denominator_ == 1; }
  /// For people and for what need not be exact.
  double to_double() const { return static_cast<double>(numerator_) / static_cast<double>(denominator_); }
  /// "55" or "575/12".
  std::string to_text() const;
  /// A whole number, a fraction ("575/12") or a decimal ("53.75", "2.5e3"); nothing if it is none or has too many
  /// digits.
  static std::optional<Rational> parse(std::string_view text);

  friend Rational operator+(const Rational& a, const Rational& b);
  friend Rational operator-(const Rational& a, const Rational& b);
  friend Rational operator*(const Rational& a, const Rational& b);
  /// Precondition: b is not 0.
  friend Rational operator/(const Rational& a, const Rational& b);
  Rational& operator+=(const Rational& other) { return *this = *this + other; }
  bool operator==(const Rational&) const = default;
  friend std::strong_ordering operator<=>(const Rational& a, const Rational& b);

 private:
  sim::int128 numerator_ = 0;
  sim::int128 denominator_ = 1;
};

}  // namespace takt::analysis
