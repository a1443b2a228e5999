// SPDX-License-Identifier: Apache-2.0
// Two-parameter laws of the time from a thread's activation until its operation is done.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace takt::papers::coexistence {

enum class Law : std::uint8_t { weibull, lognormal, log_logistic, gamma };
inline constexpr std::array<Law, 4> laws = {Law::weibull, Law::lognormal, Law::log_logistic, Law::gamma};
std::string_view name_of(Law law);

/// `scale` in ms. Shapes: Weibull 1 - exp(-(t/scale)^shape); lognormal, the standard deviation of ln t (scale is the
/// median); log-logistic 1 / (1 + (t/scale)^-shape); gamma, the usual one.
struct FittedLaw {
  Law law = Law::weibull;
  double shape = 1;
  double scale = 1;

  /// The share of responses within so many ms; t > 0.
  double done_within(double t) const;
};

/// The law that goes through both points: a share `early` is done within t_early ms, a share `late` within t_late.
/// Preconditions: 0 < early < late < 1, 0 < t_early < t_late.
FittedLaw fit(Law law, double t_early, double early, double t_late, double late);

}  // namespace takt::papers::coexistence
