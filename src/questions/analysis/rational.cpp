// SPDX-License-Identifier: Apache-2.0
#include "analysis/rational.hpp"

#include <algorithm>
#include <utility>

#include "sim/check.hpp"

namespace takt::analysis {
namespace {

using sim::int128;

constexpr int128 most = (int128{1} << 126) - 1;

int128 checked(int128 value) {
  if (value > most || value < -most) throw RationalOverflow();
  return value;
}

int128 product(int128 a, int128 b) {
  int128 result = 0;
  if (__builtin_mul_overflow(a, b, &result)) throw RationalOverflow();
  return checked(result);
}

int128 sum(int128 a, int128 b) { return checked(a + b); }  // both have at most 126 bits

int128 magnitude(int128 a) { return a < 0 ? -a : a; }

int128 greatest_common_divisor(int128 a, int128 b) {
  while (b != 0) a = std::exchange(b, a % b);
  return magnitude(a);
}

std::string to_text(int128 value) {
  std::string digits;
  for (int128 rest = magnitude(value); rest != 0 || digits.empty(); rest /= 10)
    digits += static_cast<char>('0' + static_cast<int>(rest % 10));
  if (value < 0) digits += '-';
  std::reverse(digits.begin(), digits.end());
  return digits;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A decimal without sign: digits, a fraction, an exponent, each but the first optional.
std::optional<Rational> parse_decimal(std::string_view text) {
  int128 digits = 0;
  int scale = 0;
  std::size_t at = 0;
  const auto fix_digits = [&](int step) {
    const std::size_t first = at;
    for (; at < text.size() && is_digit(text[at]); ++at) {
      digits = sum(product(digits, 10), text[at] - '0');
      scale += step;
    }
    return at > first;
  };
  if (!fix_digits(0)) return std::nullopt;
  if (at < text.size() && text[at] == '.') {
    ++at;
    if (!fix_digits(-1)) return std::nullopt;
  }
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    const bool negative = at < text.size() && text[at] == '-';
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
    int exponent = 0;
    if (at == text.size()) return std::nullopt;
    for (; at < text.size() && is_digit(text[at]); ++at) {
      exponent = exponent * 10 + (text[at] - '0');
      if (exponent > 40) return std::nullopt;
    }
    scale += negative ? -exponent : exponent;
  }
  if (at != text.size()) return std::nullopt;
  int128 power = 1;
  for (int i = 0; i < (scale < 0 ? -scale : scale); ++i) power = product(power, 10);
  return scale < 0 ? Rational(digits, power) : Rational(product(digits, power), 1);
}

}  // namespace

Rational::Rational(int128 numerator, int128 denominator) {
  TAKT_CHECK(denominator != 0, "a fraction has a denominator");
  const int128 divisor = greatest_common_divisor(numerator, denominator);
  const int128 sign = denominator < 0 ? -1 : 1;
  numerator_ = checked(numerator) / divisor * sign;
  denominator_ = checked(denominator) / divisor * sign;
}

std::string Rational::to_text() const {
  return is_whole() ? analysis::to_text(numerator_)
                    : analysis::to_text(numerator_) + "/" + analysis::to_text(denominator_);
}

std::optional<Rational> Rational::parse(std::string_view text) {
  try {
    const bool negative = text.starts_with('-');
    if (negative) text.remove_prefix(1);
    const std::size_t slash = text.find('/');
    std::optional<Rational> value = parse_decimal(text.substr(0, slash));
    if (value && slash != std::string_view::npos) {
      const std::optional<Rational> below = parse_decimal(text.substr(slash + 1));
      if (!below || *below == Rational()) return std::nullopt;
      value = *value / *below;
    }
    if (value && negative) value = Rational() - *value;
    return value;
  } catch (const RationalOverflow&) {
    return std::nullopt;
  }
}

Rational operator+(const Rational& a, const Rational& b) {
  const int128 divisor = greatest_common_divisor(a.denominator_, b.denominator_);
  const int128 scale = b.denominator_ / divisor;
  return {sum(product(a.numerator_, scale), product(b.numerator_, a.denominator_ / divisor)),
          product(a.denominator_, scale)};
}

Rational operator-(const Rational& a, const Rational& b) { return a + Rational(-b.numerator_, b.denominator_); }

Rational operator*(const Rational& a, const Rational& b) {
  const int128 across = greatest_common_divisor(a.numerator_, b.denominator_);
  const int128 down = greatest_common_divisor(b.numerator_, a.denominator_);
  return {product(a.numerator_ / across, b.numerator_ / down), product(a.denominator_ / down, b.denominator_ / across)};
}

Rational operator/(const Rational& a, const Rational& b) {
  TAKT_CHECK(b.numerator_ != 0, "nothing is divided by 0");
  return a * Rational(b.denominator_, b.numerator_);
}

std::strong_ordering operator<=>(const Rational& a, const Rational& b) {
  const int128 difference = (a - b).numerator_;
  return difference < 0   ? std::strong_ordering::less
         : difference > 0 ? std::strong_ordering::greater
                          : std::strong_ordering::equal;
}

}  // namespace takt::analysis
