// SPDX-License-Identifier: Apache-2.0
// Mean, variance and Student's confidence interval.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace takt::study {

struct Summary {
  std::size_t count = 0;
  double mean = 0;
  double variance = 0;  ///< of the sample (divided by count - 1); 0 for one value
  double min = 0;
  double max = 0;
  std::optional<double>
      half_width;  ///< of the two-sided confidence interval of the mean; none for fewer than two values
};

/// The level of confidence that reports state.
constexpr double confidence = 0.95;

/// `level` 0: without an interval, which costs more than all the rest. Two passes, so that a small variance of great
/// values keeps its digits.
Summary summary_of(std::span<const double> values, double level = confidence);

/// P(T <= t) of Student's distribution with so many degrees of variable (a real number above 0).
double student_cdf(double t, double degrees);
/// The t with P(T <= t) = p, for 0 < p < 1; accurate to about 1e-12 of its value.
double student_quantile(double p, double degrees);

}  // namespace takt::study
