// From a run's result to the figures that a study looks at.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/figures/figure.hpp"
#include "scenario/resolve/resolved.hpp"
#include "study/description.hpp"

namespace takt::study {

/// A figure that has a name.
struct PlannedMeasure : scenario::Figure {
  std::string name;
};

/// Checks a measure; mistakes are diagnostics, and then there is none. What can be a figure: scenario/figures/figure.hpp.
std::optional<PlannedMeasure> plan_measure(const Measure& measure, json::Diagnostics& diagnostics);

/// The same in a study of schedules: one of scheduling_figures() (scheduling.hpp), of shares in % if the unit says so.
std::optional<PlannedMeasure> plan_scheduling_measure(const Measure& measure, json::Diagnostics& diagnostics);

/// A limit of a measure, in its unit.
struct PlannedLimit : scenario::FigureLimit {
  std::size_t measure = 0;
};
/// Its text is "start <= 1ms".
std::optional<PlannedLimit> plan_limit(const Limit& limit, const std::vector<PlannedMeasure>& measures, json::Diagnostics& diagnostics);

}  // namespace takt::study
