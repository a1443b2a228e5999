#include "chart/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace takt::chart {

Axis::Axis(Scale scale, double least, double greatest, double from, double to)
    : scale_(scale), least_(least), greatest_(greatest > least ? greatest : least + 1), from_(from), to_(to) {}

double Axis::pixel(double value) const {
  const double clamped = std::clamp(value, least_, greatest_);
  const double share = scale_ == Scale::linear ? (clamped - least_) / (greatest_ - least_) : std::log(clamped / least_) / std::log(greatest_ / least_);
  return from_ + share * (to_ - from_);
}

std::vector<Axis::Mark> Axis::marks() const {
  std::vector<Mark> marks;
  if (scale_ == Scale::logarithmic) {
    const double base = greatest_ / least_ > 100 ? 10 : 2;
    const double first = std::ceil(std::log(least_) / std::log(base) - 1e-9);
    for (double power = first; std::pow(base, power) <= greatest_ * (1 + 1e-9); ++power) marks.push_back({std::pow(base, power), fmt::format("{:g}", std::pow(base, power))});
    return marks;
  }
  const double rough = (greatest_ - least_) / 5;
  const double decade = std::pow(10, std::floor(std::log10(rough)));
  const double step = rough / decade < 1.5 ? decade : rough / decade < 3.5 ? 2 * decade : rough / decade < 7.5 ? 5 * decade : 10 * decade;
  for (double k = std::ceil(least_ / step - 1e-9); k * step <= greatest_ + step * 1e-9; ++k) marks.push_back({k * step + 0.0, fmt::format("{:g}", k * step + 0.0)});
  return marks;
}

}  // namespace takt::chart
