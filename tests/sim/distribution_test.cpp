// SPDX-License-Identifier: Apache-2.0
#include "sim/distribution.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "sim/check.hpp"

namespace takt::sim {
namespace {

RandomStream stream_of(const char* purpose) { return RandomStream(1, "distribution", purpose); }

/// E[X], E[X^2], E[X^3], E[X^4] in units of `scale`.
using Moments = std::array<long double, 4>;

struct Row {
  const char* name;
  Distribution distribution;
  Duration scale;
  Moments moments;
};

Moments uniform_moments(long double low, long double high) {
  Moments m{};
  for (int k = 1; k <= 4; ++k)
    m[static_cast<std::size_t>(k - 1)] = (std::pow(high, k + 1) - std::pow(low, k + 1)) / ((k + 1) * (high - low));
  return m;
}
Moments normal_moments(long double mean, long double sd) {
  const long double v = sd * sd;
  return {mean, mean * mean + v, mean * mean * mean + 3 * mean * v,
          mean * mean * mean * mean + 6 * mean * mean * v + 3 * v * v};
}
/// E[X^k] = Gamma(1 + k / shape) in units of the scale.
Moments weibull_moments(long double shape) {
  return {std::tgamma(1 + 1 / shape), std::tgamma(1 + 2 / shape), std::tgamma(1 + 3 / shape),
          std::tgamma(1 + 4 / shape)};
}
/// E[X^k] = exp(k^2 sigma^2 / 2) in units of the median.
Moments log_normal_moments(long double sigma) {
  const long double h = sigma * sigma / 2;
  return {std::exp(h), std::exp(4 * h), std::exp(9 * h), std::exp(16 * h)};
}
/// A point of probability 1 at x; mixtures of moments are linear.
Moments point_moments(long double x) { return {x, x * x, x * x * x, x * x * x * x}; }
Moments mix(const Moments& a, long double weight_a, const Moments& b) {
  Moments m{};
  for (std::size_t k = 0; k < 4; ++k) m[k] = weight_a * a[k] + (1 - weight_a) * b[k];
  return m;
}

std::vector<Row> rows() {
  return {
      {"uniform", Distribution::uniform(2_us, 5_us), 1_us, uniform_moments(2, 5)},
      {"normal", Distribution::normal(100_us, 7_us), 1_us, normal_moments(100, 7)},
      // Moments by quadrature of the density.
      {"truncated",
       Distribution::truncated_normal(20_us, 10_us, 15_us, 40_us),
       1_us,
       {24.457437782754383L, 635.8256465104715L, 17500.7668141514L, 506859.04372950824L}},
      {"exponential", Distribution::exponential(30_us), 30_us, {1, 2, 6, 24}},
      {"weibull_0_8", Distribution::weibull(10_us, 0.8), 10_us, weibull_moments(0.8L)},
      {"weibull_3", Distribution::weibull(10_us, 3.0), 10_us, weibull_moments(3)},
      {"log_normal", Distribution::log_normal(20_us, 0.4), 20_us, log_normal_moments(0.4L)},
      {"empirical", Distribution::empirical({{1_us, 3}, {9_us, 1}}), 1_us,
       mix(point_moments(1), 0.75L, point_moments(9))},
      {"mixture",
       Distribution::mixture(Distribution::uniform(0_us, 2_us), Distribution::exponential(10_us), 200'000'000), 1_us,
       mix(uniform_moments(0, 2), 0.8L, {10, 200, 6'000, 240'000})},
  };
}

// Mean and variance of 10^5 draws within 4 standard errors: sigma / sqrt n for the mean, sqrt((mu4 - sigma^4) / n) for
// the variance.
TEST(Distribution, MeansAndVariances) {
  constexpr int n = 100'000;
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    const auto [m1, m2, m3, m4] = row.moments;
    const long double variance = m2 - m1 * m1;
    const long double fourth = m4 - 4 * m1 * m3 + 6 * m1 * m1 * m2 - 3 * m1 * m1 * m1 * m1;
    RandomStream stream = stream_of(row.name);
    long double sum = 0;
    long double squares = 0;
    for (int i = 0; i < n; ++i) {
      const long double x =
          static_cast<long double>(row.distribution.draw(stream).ps()) / static_cast<long double>(row.scale.ps());
      sum += x;
      squares += (x - m1) * (x - m1);
    }
    EXPECT_LT(std::abs(static_cast<double>(sum / n - m1)), 4 * std::sqrt(static_cast<double>(variance / n)));
    EXPECT_LT(std::abs(static_cast<double>(squares / n - variance)),
              4 * std::sqrt(static_cast<double>((fourth - variance * variance) / n)));
  }
}

// Three draws of each kind, to the picosecond, on every machine. Computed independently (Python: the published
// generator, libm, and statistics.NormalDist for the normal quantile).
TEST(Distribution, PinnedDraws) {
  const std::map<std::string, std::array<std::int64_t, 3>> expected = {
      {"uniform", {4'752'716, 2'616'143, 2'191'631}},
      {"normal", {109'722'451, 94'242'131, 89'338'867}},
      {"truncated", {34'195'391, 18'639'186, 16'180'598}},
      {"exponential", {2'580'737, 47'486'625, 82'523'886}},
      {"weibull_0_8", {465'884, 17'754'668, 35'426'073}},
      {"weibull_3", {4'414'425, 11'654'224, 14'011'549}},
      {"log_normal", {34'858'636, 14'392'557, 10'875'632}},
      {"empirical", {9'000'000, 1'000'000, 1'000'000}},
      {"mixture", {410'762, 4'274'044, 68'582}},
  };
  for (const Row& row : rows()) {
    RandomStream stream = stream_of("pinned");
    std::array<std::int64_t, 3> found{};
    for (std::int64_t& ps : found) ps = row.distribution.draw(stream).ps();
    EXPECT_EQ(found, expected.at(row.name)) << row.name;
  }
}

// By quadrature, see rows(); cut off at its mean on one side a normal distribution has the mean of half a one, sqrt(2 /
// pi) deviations away; far from its ends it is not cut off at all. Between ends that are close together it is almost
// uniform.
TEST(Distribution, MeanOfATruncatedOne) {
  const auto mean = [](Duration low, Duration high) {
    return Distribution::truncated_normal(20_us, 10_us, low, high).truncated_mean().ps();
  };
  EXPECT_NEAR(static_cast<double>(mean(15_us, 40_us)), 24'457'437.78, 1.5);
  EXPECT_NEAR(static_cast<double>(mean(20_us, Duration::max())), 20e6 + 10e6 * std::sqrt(2 / 3.14159265358979), 1.5);
  EXPECT_EQ(mean(Duration::from_ps(-1'000'000'000), 1_s), 20'000'000);
  EXPECT_NEAR(static_cast<double>(mean(19_us, 22_us)), 20'500'000, 20'000);
}

// The comment says: one draw of the stream each, two for a mixture. So a change of parameters does not shift later
// draws.
TEST(Distribution, DrawsOnceAMixtureTwice) {
  for (const Row& row : rows()) {
    RandomStream stream = stream_of("count");
    RandomStream plain = stream_of("count");
    static_cast<void>(row.distribution.draw(stream));
    const int draws = std::string(row.name) == "mixture" ? 2 : 1;
    for (int i = 0; i < draws; ++i) static_cast<void>(plain.next());
    EXPECT_EQ(stream.next(), plain.next()) << row.name;
  }
}

TEST(Distribution, LeastAndGreatestAreNeverViolated) {
  for (const Row& row : rows()) {
    SCOPED_TRACE(row.name);
    const Duration floor = row.scale * 3 / 2;
    const Duration ceiling = row.scale * 4;
    for (const Distribution& d : {row.distribution, row.distribution.clamped(floor, ceiling)}) {
      RandomStream stream = stream_of("bounds");
      for (int i = 0; i < 20'000; ++i) {
        const Duration x = d.draw(stream);
        ASSERT_GE(x, d.least());
        ASSERT_LE(x, d.greatest());
      }
    }
    const Distribution clamped = row.distribution.clamped(floor, ceiling);
    EXPECT_GE(clamped.least(), floor);
    EXPECT_LE(clamped.greatest(), ceiling);
  }
}

TEST(Distribution, ClampingReachesBothEnds) {
  const Distribution d = Distribution::normal(10_us, 5_us).clamped(8_us, 12_us);
  RandomStream stream = stream_of("ends");
  bool at_floor = false;
  bool at_ceiling = false;
  for (int i = 0; i < 1'000; ++i) {
    const Duration x = d.draw(stream);
    at_floor = at_floor || x == 8_us;
    at_ceiling = at_ceiling || x == 12_us;
  }
  EXPECT_TRUE(at_floor && at_ceiling);
  EXPECT_EQ(d.least(), 8_us);
  EXPECT_EQ(d.greatest(), 12_us);
}

TEST(Distribution, UnclampedNormalIsNeverNegative) {
  const Distribution d = Distribution::normal(0_us, 5_us);
  RandomStream stream = stream_of("negative");
  int zeros = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Duration x = d.draw(stream);
    ASSERT_GE(x, 0_ps);
    zeros += x == 0_ps ? 1 : 0;
  }
  EXPECT_NEAR(zeros, 5'000, 4 * 50);  // sqrt(n/4) = 50
}

TEST(Distribution, ConstantIsConstant) {
  const Distribution d = Distribution::constant(5_us);
  RandomStream stream = stream_of("constant");
  RandomStream untouched = stream_of("constant");
  EXPECT_EQ(d.draw(stream), 5_us);
  EXPECT_EQ(stream.next(), untouched.next());
  EXPECT_TRUE(d.is_constant());
  EXPECT_EQ(d.least(), 5_us);
  EXPECT_EQ(d.greatest(), 5_us);
  EXPECT_EQ(d.clamped(6_us, 7_us).draw(stream), 6_us);
  EXPECT_EQ(Distribution::constant(-(3_us)).draw(stream), -(3_us));
  EXPECT_FALSE(Distribution::uniform(5_us, 5_us).is_constant());
}

TEST(Distribution, UniformIncludesBothEnds) {
  const Distribution d = Distribution::uniform(-(1_ps), 1_ps);
  RandomStream stream = stream_of("three values");
  std::map<std::int64_t, int> counts;
  for (int i = 0; i < 30'000; ++i) ++counts[d.draw(stream).ps()];
  EXPECT_EQ(counts.size(), 3u);
  for (const auto& [value, count] : counts) EXPECT_NEAR(count, 10'000, 4 * 82) << value;  // sqrt(n p q) = 82
  EXPECT_EQ(Distribution::uniform(4_us, 4_us).draw(stream), 4_us);
  EXPECT_THROW(Distribution::uniform(2_us, 1_us), InvariantBroken);
}

TEST(Distribution, EmpiricalFrequencies) {
  const Distribution d = Distribution::empirical({{7_us, 50}, {1_us, 30}, {9_us, 0}, {3_us, 20}});
  RandomStream stream = stream_of("frequencies");
  std::map<Duration, int> counts;
  for (int i = 0; i < 100'000; ++i) ++counts[d.draw(stream)];
  EXPECT_EQ(counts.size(), 3u);  // weight 0 never occurs
  EXPECT_NEAR(counts[7_us], 50'000, 4 * 158);
  EXPECT_NEAR(counts[1_us], 30'000, 4 * 145);
  EXPECT_NEAR(counts[3_us], 20'000, 4 * 126);
  EXPECT_THROW(Distribution::empirical({}), InvariantBroken);
  EXPECT_THROW(Distribution::empirical({{1_us, 0}}), InvariantBroken);
}

// Tables in which every weight is 1 take a shorter way; a point of weight 0 forces the general one. The draws are the
// same.
TEST(Distribution, EqualWeightsDrawTheSameAsTheGeneralTable) {
  const Distribution equal = Distribution::empirical({{5_us, 1}, {2_us, 1}, {8_us, 1}});
  const Distribution general = Distribution::empirical({{5_us, 1}, {2_us, 1}, {8_us, 1}, {1_us, 0}});
  RandomStream one = stream_of("weights");
  RandomStream two = stream_of("weights");
  std::map<Duration, int> counts;
  for (int i = 0; i < 30'000; ++i) {
    const Duration x = equal.draw(one);
    ASSERT_EQ(x, general.draw(two));
    ++counts[x];
  }
  EXPECT_EQ(counts.size(), 3u);
  for (const auto& [value, count] : counts) EXPECT_NEAR(count, 10'000, 4 * 82) << value.ps();
}

TEST(Distribution, MixtureTakesTheTailWithItsProbability) {
  const Distribution d =
      Distribution::mixture(Distribution::constant(1_us), Distribution::constant(100_us), 10'000'000);
  RandomStream stream = stream_of("tail");
  int tails = 0;
  for (int i = 0; i < 100'000; ++i) tails += d.draw(stream) == 100_us ? 1 : 0;
  EXPECT_NEAR(tails, 1'000, 4 * 31.5);  // n p = 1000
  EXPECT_EQ(d.least(), 1_us);
  EXPECT_EQ(d.greatest(), 100_us);
  EXPECT_FALSE(d.is_constant());
  EXPECT_THROW(Distribution::mixture(d, Distribution::constant(1_us), 1), InvariantBroken);
  const Distribution never = Distribution::mixture(Distribution::constant(1_us), Distribution::constant(2_us), 0);
  const Distribution always =
      Distribution::mixture(Distribution::constant(1_us), Distribution::constant(2_us), 1'000'000'000);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(never.draw(stream), 1_us);
    EXPECT_EQ(always.draw(stream), 2_us);
  }
}

// A scale at the end of time: P(X > scale) = exp(-1) = 0.368 of the draws do not fit and become the greatest duration.
TEST(Distribution, HugeValuesSaturate) {
  RandomStream stream = stream_of("huge");
  const Distribution d = Distribution::weibull(Duration::max(), 0.01);
  int saturated = 0;
  for (int i = 0; i < 1'000; ++i) {
    const Duration x = d.draw(stream);
    ASSERT_GE(x, 0_ps);
    saturated += x == Duration::max() ? 1 : 0;
  }
  EXPECT_NEAR(saturated, 370, 4 * 16);
}

TEST(Distribution, BadShapesAreRefused) {
  EXPECT_THROW(Distribution::weibull(1_us, 0.0), InvariantBroken);
  EXPECT_THROW(Distribution::constant(1_us).clamped(2_us, 1_us), InvariantBroken);
}

}  // namespace
}  // namespace takt::sim
