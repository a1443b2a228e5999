// SPDX-License-Identifier: Apache-2.0
#include "chart/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace takt::chart {
namespace {

/// 1, 2 or 5 times a power of ten, not below `least`.
double round_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

}  // namespace

std::string number_text(double value) { return fmt::format("{:.5g}", value == 0 ? 0.0 : value); }

Axis::Axis(Scale scale, double low, double high, double from, double to)
    : is_logarithmic_(scale == Scale::logarithmic),
      low_(low),
      high_(high > low ? high : low + 1),
      step_(round_step((high_ - low_) / 7.5)),
      from_(from),
      to_(to) {}

Axis::Axis(const std::vector<double>& values, Scale scale, double from, double to)
    : is_logarithmic_(scale == Scale::logarithmic), from_(from), to_(to) {
  std::vector<double> shown;
  for (const double value : values)
    if (std::isfinite(value) && (!is_logarithmic_ || value > 0)) shown.push_back(value);
  if (shown.empty()) {
    is_logarithmic_ = false;
    shown = {0, 1};
  }
  low_ = *std::min_element(shown.begin(), shown.end());
  high_ = *std::max_element(shown.begin(), shown.end());
  if (is_logarithmic_) {
    low_ = std::pow(10, std::floor(std::log10(low_) + 1e-9));
    high_ = std::pow(10, std::ceil(std::log10(high_) - 1e-9));
    if (high_ <= low_) high_ = 10 * low_;
    return;
  }
  if (high_ - low_ <= 1e-12 * std::max(std::abs(low_), std::abs(high_))) {
    // Nothing but zeros: counts of what did not happen, which are never negative.
    const double room = high_ == 0 ? 1 : std::abs(high_) * 0.1;
    low_ -= high_ == 0 ? 0 : room;
    high_ += room;
  }
  step_ = round_step((high_ - low_) / 6);
  low_ = std::floor(low_ / step_ + 1e-9) * step_;
  high_ = std::ceil(high_ / step_ - 1e-9) * step_;
}

double Axis::at(double value) const {
  const double clamped = std::clamp(value, low_, high_);
  const double share =
      is_logarithmic_ ? std::log10(clamped / low_) / std::log10(high_ / low_) : (clamped - low_) / (high_ - low_);
  return from_ + share * (to_ - from_);
}

std::vector<Tick> Axis::ticks() const {
  std::vector<Tick> all;
  const double slack = 1e-6;
  if (!is_logarithmic_) {
    for (double k = std::ceil(low_ / step_ - slack); k <= high_ / step_ + slack; ++k)
      all.push_back({k * step_ + 0.0, number_text(k * step_)});
    return all;
  }
  const bool is_short = high_ / low_ < 1001;
  for (double power = std::pow(10, std::floor(std::log10(low_) + slack)); power <= high_ * (1 + slack); power *= 10)
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * power;
      if ((factor == 1 || is_short) && value >= low_ * (1 - slack) && value <= high_ * (1 + slack))
        all.push_back({value, number_text(value)});
    }
  return all;
}

}  // namespace takt::chart
