// SPDX-License-Identifier: Apache-2.0
#include "sim/distribution.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "sim/check.hpp"
#include "sim/mathematics.hpp"

namespace takt::sim {
namespace {

constexpr double most_ps = 9.0e18;
constexpr double least_probability = 1e-300;
constexpr double greatest_probability = 1 - 0x1p-53;

/// Rounds to the nearest picosecond, half away from zero, within the range of a Duration.
Duration rounded(double ps) {
  if (ps >= most_ps) return Duration::max();
  if (ps <= -most_ps) return Duration::from_ps(-9'000'000'000'000'000'000);
  return Duration::from_ps(static_cast<std::int64_t>(ps + (ps < 0 ? -0.5 : 0.5)));
}

double as_double(Duration d) { return static_cast<double>(d.ps()); }

/// The probability of a result below z, z <= 0, of the standard normal distribution: the greatest number whose quantile
/// lies below. Positive numbers are in the order of their bits.
double lower_tail(double z) {
  if (z < normal_quantile(least_probability)) return 0;
  std::uint64_t below = std::bit_cast<std::uint64_t>(least_probability);
  for (std::uint64_t above = std::bit_cast<std::uint64_t>(0.5); above - below > 1;) {
    const std::uint64_t middle = below + (above - below) / 2;
    (normal_quantile(std::bit_cast<double>(middle)) < z ? below : above) = middle;
  }
  return std::bit_cast<double>(below);
}

/// The density of the standard normal distribution.
double density(double z) { return exact_exp(-z * z / 2) / std::sqrt(2 * 3.14159265358979323846); }

}  // namespace

Distribution Distribution::constant(Duration value) {
  Distribution d;
  d.location_ = value;
  d.floor_ = std::min(value, Duration());
  return d;
}

Distribution Distribution::uniform(Duration low, Duration high) {
  TAKT_CHECK(low <= high, "a uniform distribution needs low <= high");
  Distribution d;
  d.kind_ = Kind::uniform;
  d.location_ = low;
  d.spread_ = high;
  d.floor_ = low;
  d.ceiling_ = high;
  return d;
}

Distribution Distribution::normal(Duration mean, Duration standard_deviation) {
  Distribution d;
  d.kind_ = Kind::normal;
  d.location_ = mean;
  d.spread_ = standard_deviation;
  return d;
}

Distribution Distribution::truncated_normal(Duration mean, Duration standard_deviation, Duration low, Duration high) {
  TAKT_CHECK(low <= mean && mean <= high && low < high && standard_deviation > Duration(),
             "a normal distribution is cut off on both sides of its mean");
  Distribution d = normal(mean, standard_deviation);
  d.kind_ = Kind::truncated_normal;
  d.below_ = lower_tail(as_double(low - mean) / as_double(standard_deviation));
  d.shape_ = 1 - d.below_ - lower_tail(as_double(mean - high) / as_double(standard_deviation));
  d.floor_ = low;
  d.ceiling_ = high;
  return d;
}

Duration Distribution::truncated_mean() const {
  TAKT_CHECK(kind_ == Kind::truncated_normal, "the mean of a truncated normal distribution");
  const double spread = as_double(spread_);
  const double shift =
      density(as_double(floor_ - location_) / spread) - density(as_double(ceiling_ - location_) / spread);
  return std::clamp(rounded(as_double(location_) + spread * shift / shape_), floor_, ceiling_);
}

Distribution Distribution::exponential(Duration mean) {
  Distribution d;
  d.kind_ = Kind::exponential;
  d.location_ = mean;
  return d;
}

Distribution Distribution::weibull(Duration scale, double shape) {
  TAKT_CHECK(shape > 0, "the shape of a Weibull distribution is positive");
  Distribution d;
  d.kind_ = Kind::weibull;
  d.location_ = scale;
  d.shape_ = shape;
  return d;
}

Distribution Distribution::log_normal(Duration median, double sigma) {
  Distribution d;
  d.kind_ = Kind::log_normal;
  d.location_ = median;
  d.shape_ = sigma;
  return d;
}

Distribution Distribution::empirical(std::vector<Point> points) {
  std::uint64_t total = 0;
  Distribution d;
  d.equal_weights_ = std::all_of(points.begin(), points.end(), [](const Point& point) { return point.weight == 1; });
  for (Point& point : points) point.weight = total += point.weight;
  TAKT_CHECK(total > 0, "an empirical table needs a positive weight");
  d.kind_ = Kind::empirical;
  d.points_ = std::move(points);
  d.make_table();
  return d;
}

Distribution Distribution::mixture(Distribution body, Distribution tail, std::uint32_t tail_parts_per_billion) {
  TAKT_CHECK(body.kind_ != Kind::mixture && tail.kind_ != Kind::mixture, "mixtures do not nest");
  Distribution d;
  d.kind_ = Kind::mixture;
  d.tail_parts_per_billion_ = tail_parts_per_billion;
  d.floor_ = std::min(body.floor_, tail.floor_);
  d.parts_ = {std::move(body), std::move(tail)};
  d.make_table();
  return d;
}

Distribution Distribution::clamped(Duration floor, Duration ceiling) const {
  TAKT_CHECK(floor <= ceiling, "a distribution is clamped to an interval");
  Distribution d = *this;
  d.floor_ = floor;
  d.ceiling_ = ceiling;
  d.make_table();
  return d;
}

/// To be called when the points, the parts or the bounds have changed.
void Distribution::make_table() {
  table_.clear();
  const Distribution& from = kind_ == Kind::mixture ? parts_[0] : *this;
  if (!from.equal_weights_) return;
  for (const Point& point : from.points_)
    table_.push_back(std::clamp(std::clamp(point.value, from.floor_, from.ceiling_), floor_, ceiling_));
}

Duration Distribution::draw_slowly(RandomStream& stream) const {
  if (kind_ != Kind::mixture) return clamped_draw(*this, stream);
  return clamped_draw(parts_[stream.below(billion) < tail_parts_per_billion_ ? 1 : 0], stream);  // no mixture itself
}

Duration Distribution::clamped_draw(const Distribution& part, RandomStream& stream) const {
  const Duration raw =
      part.equal_weights_ ? part.points_[stream.below(part.points_.size())].value : part.draw_raw(stream);
  return std::clamp(std::clamp(raw, part.floor_, part.ceiling_), floor_, ceiling_);
}

Duration Distribution::draw_raw(RandomStream& stream) const {
  switch (kind_) {
    case Kind::constant:
      return location_;
    case Kind::uniform:
      return location_ + Duration::from_ps(static_cast<std::int64_t>(
                             stream.below(static_cast<std::uint64_t>((spread_ - location_).ps()) + 1)));
    case Kind::normal:
      return rounded(as_double(location_) + as_double(spread_) * normal_quantile(stream.unit()));
    case Kind::truncated_normal:
      return rounded(as_double(location_) +
                     as_double(spread_) * normal_quantile(std::clamp(below_ + shape_ * stream.unit(), least_probability,
                                                                     greatest_probability)));
    case Kind::exponential:
      return rounded(-as_double(location_) * exact_log(stream.unit()));
    case Kind::weibull:
      return rounded(as_double(location_) * exact_exp(exact_log(-exact_log(stream.unit())) / shape_));
    case Kind::log_normal:
      return rounded(as_double(location_) * exact_exp(shape_ * normal_quantile(stream.unit())));
    case Kind::empirical: {
      const std::uint64_t pick = stream.below(points_.back().weight);
      const auto found = std::upper_bound(points_.begin(), points_.end(), pick,
                                          [](std::uint64_t value, const Point& point) { return value < point.weight; });
      return found->value;
    }
    case Kind::mixture:
      break;  // draw() chooses one of its parts
  }
  TAKT_CHECK(false, "a distribution of no kind");
}

Duration Distribution::least() const {
  switch (kind_) {
    case Kind::constant:
      return std::clamp(location_, floor_, ceiling_);
    case Kind::empirical:
      return std::clamp(std::min_element(points_.begin(), points_.end(),
                                         [](const Point& a, const Point& b) { return a.value < b.value; })
                            ->value,
                        floor_, ceiling_);
    case Kind::mixture:
      return std::clamp(std::min(parts_[0].least(), parts_[1].least()), floor_, ceiling_);
    default:
      return floor_;
  }
}

Duration Distribution::greatest() const {
  switch (kind_) {
    case Kind::constant:
      return std::clamp(location_, floor_, ceiling_);
    case Kind::empirical:
      return std::clamp(std::max_element(points_.begin(), points_.end(),
                                         [](const Point& a, const Point& b) { return a.value < b.value; })
                            ->value,
                        floor_, ceiling_);
    case Kind::mixture:
      return std::clamp(std::max(parts_[0].greatest(), parts_[1].greatest()), floor_, ceiling_);
    default:
      return ceiling_;
  }
}

}  // namespace takt::sim
