// SPDX-License-Identifier: Apache-2.0
// Distributions of durations. Own ones: those of the standard library differ between implementations.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/random.hpp"
#include "sim/time.hpp"

namespace takt::sim {

/// A distribution from which durations are drawn, each with one draw of the stream (two for a mixture). Results are
/// whole picoseconds, never below `floor` and never above `ceiling`.
class Distribution {
 public:
  /// One point of an empirical table: `value` with relative frequency `weight`.
  struct Point {
    Duration value;
    std::uint64_t weight = 1;
    bool operator==(const Point&) const = default;
  };

  static Distribution constant(Duration value);
  /// Uniform over [low, high], both ends included.
  static Distribution uniform(Duration low, Duration high);
  static Distribution normal(Duration mean, Duration standard_deviation);
  /// That of a normal distribution among its results in [low, high]: cut off there, whereas clamped() heaps what lies
  /// beyond onto the ends. Precondition: low <= mean <= high, low < high, standard_deviation > 0.
  static Distribution truncated_normal(Duration mean, Duration standard_deviation, Duration low, Duration high);
  static Distribution exponential(Duration mean);
  /// Weibull with scale and shape k > 0: P(X > x) = exp(-(x/scale)^k).
  static Distribution weibull(Duration scale, double shape);
  /// exp of a normal distribution: `median` is exp(mu); sigma is that of the logarithm.
  static Distribution log_normal(Duration median, double sigma);
  /// The values of the table with their relative frequencies, no interpolation. Precondition: total weight > 0.
  static Distribution empirical(std::vector<Point> points);
  /// `tail` with probability `tail_parts_per_billion` / 10^9, otherwise `body`. Neither may itself be a mixture.
  static Distribution mixture(Distribution body, Distribution tail, std::uint32_t tail_parts_per_billion);

  /// The same distribution with its results clamped to [floor, ceiling].
  Distribution clamped(Duration floor, Duration ceiling) const;

  Duration draw(RandomStream& stream) const {
    // A measured table is what hosts draw from most.
    if (table_.empty()) [[unlikely]]
      return draw_slowly(stream);
    if (kind_ == Kind::mixture && stream.below(billion) < tail_parts_per_billion_) [[unlikely]]
      return clamped_draw(parts_[1], stream);
    return table_[stream.below(table_.size())];
  }
  /// What draws of a truncated normal distribution come to on average.
  Duration truncated_mean() const;

  bool is_constant() const { return kind_ == Kind::constant; }
  /// Bounds of what draw() can return (after clamping).
  Duration least() const;
  Duration greatest() const;

 private:
  enum class Kind : std::uint8_t {
    constant,
    uniform,
    normal,
    truncated_normal,
    exponential,
    weibull,
    log_normal,
    empirical,
    mixture
  };

  static constexpr std::uint64_t billion = 1'000'000'000;

  Duration draw_slowly(RandomStream& stream) const;
  Duration draw_raw(RandomStream& stream) const;
  /// Of a part, within the bounds of both.
  Duration clamped_draw(const Distribution& part, RandomStream& stream) const;
  void make_table();

  Kind kind_ = Kind::constant;
  std::uint32_t tail_parts_per_billion_ = 0;
  Duration location_;   // constant value, low end, mean, scale or median
  Duration spread_;     // high end or standard deviation
  double shape_ = 1.0;  // truncated: the probability of a result in the interval
  double below_ = 0.0;  // truncated: that of one below it
  Duration floor_ = Duration::from_ps(0);
  Duration ceiling_ = Duration::max();
  bool equal_weights_ = false;       // empirical: every weight is 1, so the draw is the index
  std::vector<Duration> table_;      // of equal weights, also of the body of a mixture: the results, clamped
  std::vector<Point> points_;        // empirical: weights made cumulative
  std::vector<Distribution> parts_;  // mixture: body, tail
};

}  // namespace takt::sim
