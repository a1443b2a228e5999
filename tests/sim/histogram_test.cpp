// SPDX-License-Identifier: Apache-2.0
#include "sim/histogram.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sim/check.hpp"
#include "sim/random.hpp"

namespace takt::sim {
namespace {

Histogram histogram_of(const std::vector<std::int64_t>& samples) {
  Histogram histogram;
  for (const std::int64_t ps : samples) histogram.add(Duration::from_ps(ps));
  return histogram;
}

/// The smallest sample below or at which at least parts/whole of all lie.
std::int64_t true_percentile(std::vector<std::int64_t> samples, std::uint64_t parts, std::uint64_t whole) {
  std::sort(samples.begin(), samples.end());
  const std::uint64_t rank = std::max<std::uint64_t>(1, (samples.size() * parts + whole - 1) / whole);
  return samples[rank - 1];
}

void expect_exact_moments(const Histogram& histogram, const std::vector<std::int64_t>& samples) {
  EXPECT_EQ(histogram.count(), samples.size());
  EXPECT_EQ(histogram.minimum().ps(), *std::min_element(samples.begin(), samples.end()));
  EXPECT_EQ(histogram.maximum().ps(), *std::max_element(samples.begin(), samples.end()));
  int128 sum = 0;
  for (const std::int64_t ps : samples) sum += ps;
  const int128 n = static_cast<int128>(samples.size());
  EXPECT_EQ(histogram.mean().ps(), static_cast<std::int64_t>((2 * sum + n) / (2 * n)));  // half up
  long double scatter = 0;
  const long double mean = static_cast<long double>(sum) / static_cast<long double>(n);
  for (const std::int64_t ps : samples)
    scatter += (static_cast<long double>(ps) - mean) * (static_cast<long double>(ps) - mean);
  const long double deviation = std::sqrt(scatter / static_cast<long double>(n));
  // Rounded to the picosecond; a double holds 53 bits of it.
  EXPECT_NEAR(static_cast<double>(static_cast<long double>(histogram.standard_deviation().ps()) - deviation), 0.0,
              0.5 + 1e-9 + static_cast<double>(deviation) * 4e-16);
}

constexpr std::pair<std::uint64_t, std::uint64_t> percentiles[] = {
    {0, 100}, {1, 100}, {25, 100}, {50, 100}, {90, 100}, {99, 100}, {999, 1'000}, {9'999, 10'000}, {100, 100}};

/// Never below the true percentile and at most 1/128 above it.
bool percentiles_hold(const Histogram& histogram, const std::vector<std::int64_t>& samples) {
  for (const auto& [parts, whole] : percentiles) {
    const std::int64_t exact = true_percentile(samples, parts, whole);
    const std::int64_t found = histogram.percentile(parts, whole).ps();
    if (found < exact || found - exact > exact / 128 || found > histogram.maximum().ps()) return false;
  }
  return true;
}

// 2, 4, 4, 4, 5, 5, 7, 9: mean 5, deviation 2.
TEST(Histogram, SmallNumbersAreExact) {
  const Histogram h = histogram_of({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_EQ(h.count(), 8u);
  EXPECT_EQ(h.mean(), 5_ps);
  EXPECT_EQ(h.standard_deviation(), 2_ps);
  EXPECT_EQ(h.minimum(), 2_ps);
  EXPECT_EQ(h.maximum(), 9_ps);
  EXPECT_EQ(h.percentile(50, 100), 4_ps);  // the fourth of eight
  EXPECT_EQ(h.percentile(51, 100), 5_ps);  // ceil(4.08) = the fifth
  EXPECT_EQ(h.percentile(100, 100), 9_ps);
  EXPECT_EQ(h.percentile(0, 100), 2_ps);
}

TEST(Histogram, MeanIsRoundedToTheNearest) {
  EXPECT_EQ(histogram_of({1, 2}).mean(), 2_ps);     // 1.5, half up
  EXPECT_EQ(histogram_of({1, 1, 2}).mean(), 1_ps);  // 1.33
  EXPECT_EQ(histogram_of({1, 2, 2}).mean(), 2_ps);  // 1.67
}

TEST(Histogram, AgreesWithBruteForce) {
  for (const int log2 : {4, 8, 20, 34, 44}) {
    RandomStream chance(1, "histogram", "samples");
    std::vector<std::int64_t> samples;
    for (int i = 0; i < 20'000; ++i) samples.push_back(static_cast<std::int64_t>(chance.below(1ULL << log2)));
    const Histogram histogram = histogram_of(samples);
    expect_exact_moments(histogram, samples);
    EXPECT_TRUE(percentiles_hold(histogram, samples)) << log2;
  }
}

// A latency of an hour that jitters by picoseconds: the squares do not eat the deviation (numbers around 3.6e15, whose
// squares need 104 bits). The samples are c - 1, c, c + 1: deviation sqrt(2/3) = 0.82, rounded to 1.
TEST(Histogram, DeviationSurvivesALargeMean) {
  const std::int64_t c = 3'600'000'000'000'000;
  EXPECT_EQ(histogram_of({c - 1, c, c + 1}).standard_deviation(), 1_ps);
  EXPECT_EQ(histogram_of({c, c, c}).standard_deviation(), 0_ps);
  EXPECT_EQ(histogram_of({c - 1'000, c + 1'000}).standard_deviation(), 1'000_ps);
}

TEST(Histogram, AnySamples) {
  EXPECT_TRUE(rc::check("percentiles and moments of any samples", [] {
    const auto raw =
        *rc::gen::nonEmpty(rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, INT64_MAX)));
    std::vector<std::int64_t> samples;
    for (std::size_t i = 0; i < raw.size(); ++i) samples.push_back(raw[i] >> (raw[i] % 61));
    const Histogram histogram = histogram_of(samples);
    RC_ASSERT(percentiles_hold(histogram, samples));
    RC_ASSERT(histogram.minimum().ps() == *std::min_element(samples.begin(), samples.end()));
    RC_ASSERT(histogram.maximum().ps() == *std::max_element(samples.begin(), samples.end()));
  }));
}

// One sample in every bucket there is, found by walking from edge to edge: each bucket begins right after the one
// before, and spans at most 1/128 of its lower edge.
TEST(Histogram, BucketsAreContiguousFromZeroToTheEndOfTime) {
  std::uint64_t next = 0;
  int buckets = 0;
  while (next <= static_cast<std::uint64_t>(INT64_MAX)) {
    for (const bool at_the_upper_end : {false, true}) {
      Histogram one;
      std::int64_t lower = -1;
      std::int64_t upper = -1;
      const auto keep = [&](Duration from, Duration to, std::uint64_t n) {
        lower = from.ps();
        upper = to.ps();
        EXPECT_EQ(n, 1u);
      };
      one.add(Duration::from_ps(static_cast<std::int64_t>(next)));
      one.for_each_bucket(keep);
      if (at_the_upper_end) {
        Histogram last;
        last.add(Duration::from_ps(upper));
        last.for_each_bucket(keep);
      }
      ASSERT_EQ(lower, static_cast<std::int64_t>(next));
      ASSERT_GE(upper, lower);
      ASSERT_LE(upper - lower, lower / 128);
      if (at_the_upper_end) next = static_cast<std::uint64_t>(upper) + 1;
    }
    ++buckets;
  }
  // 128 buckets below 128 and for each of the 56 octaves 2^7 .. 2^62.
  EXPECT_EQ(buckets, 128 * 57);
}

TEST(Histogram, VisitsBucketsInAscendingOrderWithTheirCounts) {
  const Histogram h = histogram_of({1'000'000, 3, 3, 3, 70'000, 0, 70'001});
  std::int64_t last = -1;
  std::vector<std::uint64_t> counts;
  h.for_each_bucket([&](Duration lower, Duration upper, std::uint64_t n) {
    EXPECT_GT(lower.ps(), last);
    last = upper.ps();
    counts.push_back(n);
  });
  EXPECT_EQ(counts, (std::vector<std::uint64_t>{1, 3, 2, 1}));  // 70 000 lies in a bucket of 512
}

TEST(Histogram, HugeValues) {
  const std::int64_t huge = INT64_MAX;
  const Histogram h = histogram_of({huge, huge - 2, huge - 1});
  EXPECT_EQ(h.maximum().ps(), huge);
  EXPECT_EQ(h.mean().ps(), huge - 1);
  EXPECT_EQ(h.standard_deviation(), 1_ps);  // sqrt(2/3)
  EXPECT_EQ(h.percentile(50, 100).ps(), huge);
  const Histogram apart = histogram_of({0, huge});
  EXPECT_EQ(apart.mean().ps(), huge / 2 + 1);  // half up
  EXPECT_NEAR(static_cast<double>(apart.standard_deviation().ps()), 0x1p62, 1024);
}

TEST(Histogram, NegativeSamplesCountAsZero) {
  const Histogram h = histogram_of({-5, 3});
  EXPECT_EQ(h.minimum(), 0_ps);
  EXPECT_EQ(h.mean(), 2_ps);
}

TEST(Histogram, EmptyHasNoStatistics) {
  const Histogram h;
  EXPECT_TRUE(h.empty());
  EXPECT_EQ(h.count(), 0u);
  EXPECT_THROW(static_cast<void>(h.mean()), InvariantBroken);
  EXPECT_THROW(static_cast<void>(h.standard_deviation()), InvariantBroken);
  EXPECT_THROW(static_cast<void>(h.percentile(1, 2)), InvariantBroken);
  EXPECT_THROW(static_cast<void>(histogram_of({1}).percentile(3, 2)), InvariantBroken);
}

}  // namespace
}  // namespace takt::sim
