// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/response_law.hpp"

#include <cmath>
#include <numbers>

namespace takt::papers::coexistence {
namespace {

/// Where a rising function passes `wanted`, between `low` and `high`.
template <typename F>
double where(F&& f, double wanted, double low, double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (f(middle) < wanted ? low : high) = middle;
  }
  return (low + high) / 2;
}

double normal_cdf(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

/// The regularised lower incomplete gamma function P(a, x): its series below a + 1, the continued fraction (by Lentz)
/// above.
double incomplete_gamma(double a, double x) {
  if (x <= 0) return 0;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a;
    double sum = term;
    for (int n = 1; n < 1000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
    return front * sum;
  }
  double b = x + 1 - a;
  double c = 1e300;
  double d = 1 / b;
  double fraction = d;
  for (int i = 1; i < 1000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    fraction *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return 1 - front * fraction;
}

/// Laws whose share is a fixed function of shape * ln(t / scale) go through two points along a straight line.
FittedLaw line(Law law, double t_early, double z_early, double t_late, double z_late) {
  const double slope = (z_late - z_early) / std::log(t_late / t_early);
  return {law, slope, t_early * std::exp(-z_early / slope)};
}

FittedLaw fit_gamma(double t_early, double early, double t_late, double late) {
  // In logarithms, since shapes and scales may be small.
  const auto with_shape = [&](double log_shape) {
    const double shape = std::exp(log_shape);
    const double x =
        std::exp(where([&](double log_x) { return incomplete_gamma(shape, std::exp(log_x)); }, early, -200, 7));
    return FittedLaw{Law::gamma, shape, t_early / x};
  };
  return with_shape(where([&](double log_shape) { return with_shape(log_shape).done_within(t_late); }, late,
                          std::log(0.02), std::log(50)));
}

}  // namespace

std::string_view name_of(Law law) {
  constexpr std::array<std::string_view, 4> names = {"Weibull", "lognormal", "log-logistic", "gamma"};
  return names[static_cast<std::size_t>(law)];
}

double FittedLaw::done_within(double t) const {
  switch (law) {
    case Law::weibull:
      return -std::expm1(-std::pow(t / scale, shape));
    case Law::lognormal:
      return normal_cdf(std::log(t / scale) / shape);
    case Law::log_logistic:
      return 1 / (1 + std::pow(t / scale, -shape));
    case Law::gamma:
      return incomplete_gamma(shape, t / scale);
  }
  return 0;
}

FittedLaw fit(Law law, double t_early, double early, double t_late, double late) {
  switch (law) {
    case Law::weibull:
      return line(law, t_early, std::log(-std::log1p(-early)), t_late, std::log(-std::log1p(-late)));
    case Law::log_logistic:
      return line(law, t_early, std::log(early / (1 - early)), t_late, std::log(late / (1 - late)));
    case Law::lognormal: {
      const auto quantile = [](double share) { return where(normal_cdf, share, -10, 10); };
      FittedLaw made = line(law, t_early, quantile(early), t_late, quantile(late));
      made.shape = 1 / made.shape;
      return made;
    }
    case Law::gamma:
      return fit_gamma(t_early, early, t_late, late);
  }
  return {};
}

}  // namespace takt::papers::coexistence
