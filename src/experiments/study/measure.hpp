// SPDX-License-Identifier: Apache-2.0
// From a run's result to the figures that a study looks at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/figures/figure.hpp"
#include "scenario/resolved/resolved.hpp"
#include "study/description.hpp"

namespace takt::study {

/// Whose figure it is.
enum class Basis : std::uint8_t {
  run,      ///< of the point's run; of a study of schedules, of its schedule
  worst,    ///< the greatest in any run that the search for the worst one found
  bound,    ///< what no run exceeds
  verdict,  ///< whether the scenario's requirements are proved: 1, refuted: 0, undecided: no figure
};
/// "run", "worst", "bound", "verdict".
std::string_view name_of(Basis basis);
std::optional<Basis> basis_named(std::string_view name);

/// A figure that has a name.
struct PlannedMeasure : scenario::Figure {
  std::string name;
  Basis basis = Basis::run;
};

/// Whether the search for the worst run and bounds are about this figure: the greatest latency of a stream or of all,
/// the longest reaction of a kind.
bool has_worst_case(const scenario::Figure& figure);

/// Checks a measure of runs; mistakes are diagnostics, and then there is none. What can be a figure:
/// scenario/figures/figure.hpp.
std::optional<PlannedMeasure> plan_measure(const Measure& measure, json::Diagnostics& diagnostics);

/// Checks a measure of a study of runs: of a run, or of the verification (worst.X, bound.X, verdict).
std::optional<PlannedMeasure> plan_study_measure(const Measure& measure, json::Diagnostics& diagnostics);

/// The same in a study of schedules: one of scheduling_figures() (scheduling.hpp), of shares in % if the unit says so.
std::optional<PlannedMeasure> plan_scheduling_measure(const Measure& measure, json::Diagnostics& diagnostics);

/// A limit of a measure, in its unit.
struct PlannedLimit : scenario::FigureLimit {
  std::size_t measure = 0;
};
/// Its text is "start <= 1ms".
std::optional<PlannedLimit> plan_limit(const Limit& limit, const std::vector<PlannedMeasure>& measures,
                                       json::Diagnostics& diagnostics);

}  // namespace takt::study
