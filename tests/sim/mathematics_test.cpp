// SPDX-License-Identifier: Apache-2.0
#include "sim/mathematics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sim/check.hpp"
#include "sim/random.hpp"

namespace takt::sim {
namespace {

double relative_error(double found, long double expected) {
  return static_cast<double>(std::abs((static_cast<long double>(found) - expected) / expected));
}

TEST(ExactLog, AgreesWithLibmFromTheSmallestToTheLargest) {
  RandomStream chance(1, "mathematics", "log");
  double worst = 0;
  for (int i = 0; i < 200'000; ++i) {
    const std::uint64_t exponent = 1 + chance.below(2045);  // 2^-1022 .. 2^1022
    const double x = std::bit_cast<double>(exponent << 52 | chance.next() >> 12);
    worst = std::max(worst, relative_error(exact_log(x), std::log(static_cast<long double>(x))));
  }
  EXPECT_LT(worst, 4e-15);
}

// Where the logarithm itself is tiny, its relative error would suffer first.
TEST(ExactLog, AgreesWithLibmAroundOne) {
  RandomStream chance(1, "mathematics", "log");
  double worst = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double distance = chance.unit() * std::ldexp(1.0, -static_cast<int>(chance.below(52)));
    for (const double x : {1.0 + distance, 1.0 - distance / 2}) {
      if (x == 1.0) continue;
      worst = std::max(worst, relative_error(exact_log(x), std::log(static_cast<long double>(x))));
    }
  }
  EXPECT_LT(worst, 4e-15);
  EXPECT_EQ(exact_log(1.0), 0.0);
}

TEST(ExactLog, RefusesWhatHasNoLogarithm) {
  for (const double x : {0.0, -1.0, std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(static_cast<void>(exact_log(x)), InvariantBroken) << x;
}

TEST(ExactExp, AgreesWithLibm) {
  RandomStream chance(1, "mathematics", "exp");
  double worst = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double wide = (chance.unit() - 0.5) * 1400.0;  // -700 .. 700
    const double narrow = (chance.unit() - 0.5) * std::ldexp(1.0, -static_cast<int>(chance.below(60)));
    for (const double x : {wide, narrow})
      worst = std::max(worst, relative_error(exact_exp(x), std::exp(static_cast<long double>(x))));
  }
  EXPECT_LT(worst, 4e-15);
}

TEST(ExactExp, AtTheEndsOfItsRange) {
  EXPECT_EQ(exact_exp(0.0), 1.0);
  EXPECT_EQ(exact_exp(-0.0), 1.0);
  EXPECT_EQ(exact_exp(-700.5), 0.0);
  EXPECT_EQ(exact_exp(-std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_GT(exact_exp(-700.0), 0.0);
  EXPECT_EQ(exact_exp(1e300), exact_exp(700.0));
  EXPECT_EQ(exact_exp(std::numeric_limits<double>::infinity()), exact_exp(700.0));
}

TEST(ExactExp, UndoesTheLogarithm) {
  RandomStream chance(1, "mathematics", "both");
  for (int i = 0; i < 10'000; ++i) {
    const double x = chance.unit() * 1e6 + 1e-6;
    EXPECT_NEAR(exact_exp(exact_log(x)) / x, 1.0, 1e-14);
  }
}

// Phi(q) = erfc(-q / sqrt 2) / 2.
long double phi(double q) { return std::erfc(-static_cast<long double>(q) / std::sqrt(2.0L)) / 2; }

TEST(NormalQuantile, IsTheInverseOfPhi) {
  RandomStream chance(1, "mathematics", "quantile");
  double worst = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double p = chance.unit();
    worst = std::max(worst, static_cast<double>(std::abs(phi(normal_quantile(p)) - p)));
  }
  EXPECT_LT(worst, 1e-13);
}

// In the tail absolute agreement says nothing. Phi'(q) / Phi(q) is about |q|, so an error e of q shows as |q| e; with
// |q| up to 37 and e = 4e-15 |q| that is 5e-12.
TEST(NormalQuantile, IsTheInverseOfPhiInTheFarTailToo) {
  double worst = 0;
  for (int exponent = -1000; exponent <= -2; ++exponent) {
    const double p = std::ldexp(1.3, exponent);
    worst = std::max(worst, relative_error(static_cast<double>(phi(normal_quantile(p)) / p), 1.0L));
  }
  EXPECT_LT(worst, 5e-12);
}

TEST(NormalQuantile, KnownValuesAndSymmetry) {
  EXPECT_EQ(normal_quantile(0.5), 0.0);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-15 * 4);
  EXPECT_NEAR(normal_quantile(0.999), 3.090232306167814, 1e-15 * 8);
  EXPECT_NEAR(normal_quantile(1e-9), -5.997807015007687, 1e-14);
  for (const double p : {0.25, 0.0625, 0x1p-20, 0x1p-52})  // 1 - p is exact
    EXPECT_EQ(normal_quantile(p), -normal_quantile(1 - p)) << p;
}

TEST(NormalQuantile, RefusesTheEnds) {
  EXPECT_THROW(static_cast<void>(normal_quantile(0.0)), InvariantBroken);
  EXPECT_THROW(static_cast<void>(normal_quantile(1.0)), InvariantBroken);
}

// To the bit, with every compiler and at every level of optimisation.
TEST(Mathematics, PinnedBits) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  EXPECT_EQ(bits(exact_log(2.0)), 0x3FE62E42FEFA39EFULL);
  EXPECT_EQ(bits(exact_log(0.1)), 0xC0026BB1BBB55515ULL);
  EXPECT_EQ(bits(exact_log(0x1.fffffffffffffp-1)), 0xBCA0000000000000ULL);
  EXPECT_EQ(bits(exact_log(123456.789)), 0x40277281CAD8A844ULL);
  EXPECT_EQ(bits(exact_exp(1.0)), 0x4005BF0A8B14576AULL);
  EXPECT_EQ(bits(exact_exp(-12.34)), 0x3ED257C2C1CE3704ULL);
  EXPECT_EQ(bits(exact_exp(345.678)), 0x5F1A22AD25CCB60EULL);
  EXPECT_EQ(bits(normal_quantile(0.3)), 0xBFE0C7E39582C5FAULL);
  EXPECT_EQ(bits(normal_quantile(0.01)), 0xC0029C5C4630FF0EULL);
  EXPECT_EQ(bits(normal_quantile(1e-20)), 0xC022865170B43A4BULL);
  EXPECT_EQ(bits(normal_quantile(0.99999)), 0x40110F3F8843A850ULL);
}

}  // namespace
}  // namespace takt::sim
