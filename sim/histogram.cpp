// SPDX-License-Identifier: Apache-2.0
#include "sim/histogram.hpp"

#include <algorithm>
#include <cmath>

#include "sim/check.hpp"

namespace takt::sim {

void Histogram::add_octave(std::size_t octave) { octaves_[octave] = std::make_unique<Octave>(); }

void Histogram::add(const Histogram& other) {
  count_ += other.count_;
  sum_ += other.sum_;
  sum_of_squares_ += other.sum_of_squares_;
  least_ = std::min(least_, other.least_);
  greatest_ = std::max(greatest_, other.greatest_);
  for (std::size_t octave = 0; octave < octaves_.size(); ++octave) {
    if (!other.octaves_[octave]) continue;
    if (!octaves_[octave]) add_octave(octave);
    for (std::size_t bucket = 0; bucket < sub_buckets; ++bucket)
      (*octaves_[octave])[bucket] += (*other.octaves_[octave])[bucket];
  }
}

Duration Histogram::lower_edge(Place place) {
  if (place.octave == 0) return Duration::from_ps(static_cast<std::int64_t>(place.bucket));
  return Duration::from_ps(static_cast<std::int64_t>((place.bucket + sub_buckets) << (place.octave - 1)));
}

Duration Histogram::upper_edge(Place place) {
  if (place.octave == 0) return Duration::from_ps(static_cast<std::int64_t>(place.bucket));
  return Duration::from_ps(static_cast<std::int64_t>(((place.bucket + sub_buckets + 1) << (place.octave - 1)) - 1));
}

Duration Histogram::mean() const {
  TAKT_CHECK(count_ > 0, "an empty histogram has no mean");
  const int128 n = static_cast<int128>(count_);
  return Duration::from_ps(static_cast<std::int64_t>((sum_ + n / 2) / n));
}

Duration Histogram::standard_deviation() const {
  TAKT_CHECK(count_ > 0, "an empty histogram has no deviation");
  // n * sum of squares - sum^2 could overflow; shift the samples to their mean first (exact for integers).
  const int128 n = static_cast<int128>(count_);
  const int128 mean = sum_ / n;
  const int128 rest = sum_ - mean * n;  // |rest| < n
  // sum (x - mean)^2 = sum x^2 - 2 mean sum x + n mean^2 = sum x^2 - mean (sum + rest)
  const uint128 scatter = sum_of_squares_ - static_cast<uint128>(mean) * static_cast<uint128>(sum_ + rest);
  const double variance = static_cast<double>(scatter) / static_cast<double>(count_) -
                          (static_cast<double>(rest) / static_cast<double>(count_)) *
                              (static_cast<double>(rest) / static_cast<double>(count_));
  return Duration::from_ps(static_cast<std::int64_t>(std::sqrt(std::max(0.0, variance)) + 0.5));
}

Duration Histogram::percentile(std::uint64_t parts, std::uint64_t whole) const {
  TAKT_CHECK(count_ > 0 && parts <= whole, "a percentile of an empty histogram or beyond the whole");
  const uint128 wanted = std::max<uint128>(1, (static_cast<uint128>(count_) * parts + whole - 1) / whole);
  uint128 seen = 0;
  Duration edge;
  bool found = false;
  for_each_bucket([&](Duration, Duration upper, std::uint64_t n) {
    seen += n;
    if (!found && seen >= wanted) {
      edge = upper;
      found = true;
    }
  });
  return std::clamp(edge, minimum(), maximum());
}

}  // namespace takt::sim
