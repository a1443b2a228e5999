// SPDX-License-Identifier: Apache-2.0
// Exact counts of durations in buckets of constant relative width; no list of samples, so memory stays flat for hours.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "sim/time.hpp"

namespace takt::sim {

/// Counts, extrema and moments of non-negative durations. Minimum, maximum, mean and standard deviation are exact
/// (integer sums); a percentile is the upper edge of its bucket, at most 1/128 above the true value, and never outside
/// [minimum, maximum]. The buckets of an octave are allocated when the first sample falls into it.
class Histogram {
 public:
  static constexpr int sub_bits = 7;
  static constexpr std::size_t sub_buckets = std::size_t{1} << sub_bits;

  void add(Duration sample) {
    const std::int64_t ps = sample.ps() < 0 ? 0 : sample.ps();
    ++count_;
    sum_ += ps;
    sum_of_squares_ += static_cast<uint128>(static_cast<std::uint64_t>(ps)) * static_cast<std::uint64_t>(ps);
    if (ps < least_) least_ = ps;
    if (ps > greatest_) greatest_ = ps;
    const Place place = place_of(static_cast<std::uint64_t>(ps));
    if (!octaves_[place.octave]) [[unlikely]]
      add_octave(place.octave);
    recent_ = &(*octaves_[place.octave])[place.bucket];
    ++*recent_;
  }
  /// Counts what the other one has counted, too: as if each sample had been added here.
  void add(const Histogram& other);
  /// Brings what add() will probably touch towards the cache.
  void prefetch() const {
    __builtin_prefetch(recent_, 1);
    __builtin_prefetch(&octaves_[place_of(static_cast<std::uint64_t>(greatest_)).octave]);
  }

  std::uint64_t count() const { return count_; }
  bool empty() const { return count_ == 0; }
  /// Precondition of the following: not empty.
  Duration minimum() const { return Duration::from_ps(least_); }
  Duration maximum() const { return Duration::from_ps(greatest_); }
  /// Rounded to the nearest picosecond.
  Duration mean() const;
  /// Of the population, rounded to the nearest picosecond.
  Duration standard_deviation() const;
  /// The smallest edge below or at which at least `parts` of `whole` of the samples lie (e.g. 99 of 100).
  Duration percentile(std::uint64_t parts, std::uint64_t whole) const;

  /// Calls visit(lower edge, upper edge (included), count) for each bucket that holds a sample, in ascending order.
  template <class Visit>
  void for_each_bucket(Visit&& visit) const {
    for (std::size_t octave = 0; octave < octaves_.size(); ++octave) {
      if (!octaves_[octave]) continue;
      for (std::size_t bucket = 0; bucket < sub_buckets; ++bucket) {
        if (const std::uint64_t n = (*octaves_[octave])[bucket]; n > 0)
          visit(lower_edge({octave, bucket}), upper_edge({octave, bucket}), n);
      }
    }
  }

 private:
  using Octave = std::array<std::uint64_t, sub_buckets>;
  struct Place {
    std::size_t octave;
    std::size_t bucket;
  };
  static Place place_of(std::uint64_t ps) {
    if (ps < sub_buckets) return {0, static_cast<std::size_t>(ps)};
    const int top = 63 - __builtin_clzll(ps);
    return {static_cast<std::size_t>(top - sub_bits + 1),
            static_cast<std::size_t>(ps >> (top - sub_bits)) - sub_buckets};
  }
  void add_octave(std::size_t octave);
  static Duration lower_edge(Place place);
  static Duration upper_edge(Place place);

  std::uint64_t count_ = 0;
  std::int64_t least_ = INT64_MAX;
  std::int64_t greatest_ = 0;
  std::uint64_t* recent_ = nullptr;  // the bucket that was counted last
  int128 sum_ = 0;
  uint128 sum_of_squares_ = 0;  // up to here it is one cache line
  std::array<std::unique_ptr<Octave>, 64 - sub_bits + 1> octaves_;
};

}  // namespace takt::sim
