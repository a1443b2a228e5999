#include "sim/distribution.hpp"

#include <algorithm>
#include <utility>

#include "sim/check.hpp"
#include "sim/mathematics.hpp"

namespace takt::sim {
namespace {

constexpr double most_ps = 9.0e18;

/// Rounds to the nearest picosecond, half away from zero, within the range of a Duration.
Duration rounded(double ps) {
  if (ps >= most_ps) return Duration::max();
  if (ps <= -most_ps) return Duration::from_ps(-9'000'000'000'000'000'000);
  return Duration::from_ps(static_cast<std::int64_t>(ps + (ps < 0 ? -0.5 : 0.5)));
}

double as_double(Duration d) { return static_cast<double>(d.ps()); }

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
  return d;
}

Distribution Distribution::mixture(Distribution body, Distribution tail, std::uint32_t tail_parts_per_billion) {
  TAKT_CHECK(body.kind_ != Kind::mixture && tail.kind_ != Kind::mixture, "mixtures do not nest");
  Distribution d;
  d.kind_ = Kind::mixture;
  d.tail_parts_per_billion_ = tail_parts_per_billion;
  d.floor_ = std::min(body.floor_, tail.floor_);
  d.parts_ = {std::move(body), std::move(tail)};
  return d;
}

Distribution Distribution::clamped(Duration floor, Duration ceiling) const {
  TAKT_CHECK(floor <= ceiling, "a distribution is clamped to an interval");
  Distribution d = *this;
  d.floor_ = floor;
  d.ceiling_ = ceiling;
  return d;
}

Duration Distribution::draw(RandomStream& stream) const {
  const Distribution* from = this;
  if (kind_ == Kind::mixture) from = &parts_[stream.below(1'000'000'000) < tail_parts_per_billion_ ? 1 : 0];  // no mixture itself
  // A measured table is what hosts draw from most.
  const Duration raw = from->equal_weights_ ? from->points_[stream.below(from->points_.back().weight)].value : from->draw_raw(stream);
  return std::clamp(std::clamp(raw, from->floor_, from->ceiling_), floor_, ceiling_);
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
      return std::clamp(std::min_element(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.value < b.value; })->value,
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
      return std::clamp(std::max_element(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.value < b.value; })->value,
                        floor_, ceiling_);
    case Kind::mixture:
      return std::clamp(std::max(parts_[0].greatest(), parts_[1].greatest()), floor_, ceiling_);
    default:
      return ceiling_;
  }
}

}  // namespace takt::sim
