// SPDX-License-Identifier: Apache-2.0
#include "sim/mathematics.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

#include "sim/check.hpp"

namespace takt::sim {
namespace {

constexpr double ln2_high = 0x1.62E42FEFA38p-1;   // the upper bits of ln 2, so that k * ln2_high is exact
constexpr double ln2_low = 0x1.EF35793C7673p-45;  // ln 2 - ln2_high

/// Horner's rule; coefficients from the constant term upwards.
template <std::size_t n>
constexpr double polynomial(const std::array<double, n>& coefficients, double x) {
  double sum = coefficients[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

// Rational approximations of AS 241 (PPND16): central region, near tail, far tail.
constexpr std::array<double, 8> central_numerator = {
    3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3, 1.3731693765509461125e+4,
    4.5921953931549871457e+4, 6.7265770927008700853e+4, 3.3430575583588128105e+4, 2.5090809287301226727e+3};
constexpr std::array<double, 8> central_denominator = {1.0,
                                                       4.2313330701600911252e+1,
                                                       6.8718700749205790830e+2,
                                                       5.3941960214247511077e+3,
                                                       2.1213794301586595867e+4,
                                                       3.9307895800092710610e+4,
                                                       2.8729085735721942674e+4,
                                                       5.2264952788528545610e+3};
constexpr std::array<double, 8> near_numerator = {
    1.42343711074968357734e0, 4.63033784615654529590e0,  5.76949722146069140550e0,  3.64784832476320460504e0,
    1.27045825245236838258e0, 2.41780725177450611770e-1, 2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr std::array<double, 8> near_denominator = {1.0,
                                                    2.05319162663775882187e0,
                                                    1.67638483018380384940e0,
                                                    6.89767334985100004550e-1,
                                                    1.48103976427480074590e-1,
                                                    1.51986665636164571966e-2,
                                                    5.47593808499534494600e-4,
                                                    1.05075007164441684324e-9};
constexpr std::array<double, 8> far_numerator = {
    6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,  2.96560571828504891230e-1,
    2.65321895265761230930e-2, 1.24266094738807843860e-3, 2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr std::array<double, 8> far_denominator = {1.0,
                                                   5.99832206555887937690e-1,
                                                   1.36929880922735805310e-1,
                                                   1.48753612908506148525e-2,
                                                   7.86869131145613259100e-4,
                                                   1.84631831751005468180e-5,
                                                   1.42151175831644588870e-7,
                                                   2.04426310338993978564e-15};

}  // namespace

double exact_log(double x) {
  TAKT_CHECK(x >= 0x1p-1022 && x < 0x1p1023, "logarithm of a number that is not positive, normal and finite");
  // x = m * 2^e with m in [sqrt(1/2), sqrt(2)); log m = 2 artanh(s), s = (m - 1) / (m + 1), |s| < 0.172.
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  int exponent = static_cast<int>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0x000F'FFFF'FFFF'FFFFULL) | 0x3FF0'0000'0000'0000ULL);
  if (m > 0x1.6A09E667F3BCDp+0) {
    m *= 0.5;
    ++exponent;
  }
  const double s = (m - 1.0) / (m + 1.0);
  const double square = s * s;
  double series = 0.0;
  for (int odd = 23; odd >= 3; odd -= 2) series = (series + 1.0 / odd) * square;
  const double e = exponent;
  return e * ln2_high + (2.0 * s + (2.0 * s * series + e * ln2_low));
}

double exact_exp(double x) {
  if (x < -700.0) return 0.0;
  if (x > 700.0) x = 700.0;
  // x = k ln 2 + r, |r| <= ln(2)/2; exp r by its series, which needs 15 terms for full precision there.
  const double scaled = x * 0x1.71547652B82FEp+0;
  const std::int64_t k = static_cast<std::int64_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
  const double count = static_cast<double>(k);
  const double r = (x - count * ln2_high) - count * ln2_low;
  double series = 1.0;
  for (int n = 16; n >= 1; --n) series = 1.0 + series * r / n;
  return series * std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

double normal_quantile(double p) {
  TAKT_CHECK(p > 0.0 && p < 1.0, "a quantile needs a probability between 0 and 1");
  const double q = p - 0.5;
  if (q >= -0.425 && q <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * polynomial(central_numerator, r) / polynomial(central_denominator, r);
  }
  const double tail = q < 0 ? p : 1.0 - p;
  double r = std::sqrt(-exact_log(tail));
  double value = 0.0;
  if (r <= 5.0) {
    r -= 1.6;
    value = polynomial(near_numerator, r) / polynomial(near_denominator, r);
  } else {
    r -= 5.0;
    value = polynomial(far_numerator, r) / polynomial(far_denominator, r);
  }
  return q < 0 ? -value : value;
}

}  // namespace takt::sim
