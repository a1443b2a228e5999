// From a run's result to the figures that a study looks at.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/json/node.hpp"
#include "study/description.hpp"

namespace takt::study {

/// A measure that can be read off a result.
struct PlannedMeasure {
  std::string name;
  std::string unit;
  std::vector<std::string> steps;                                ///< "*": every member or item
  std::vector<std::pair<std::string, json::Node>> only;          ///< members of the object that holds the value
  Take take = Take::max;
  double divisor = 1;                                            ///< from the result's number to the unit
  double in_base_unit = 1;                                       ///< units in the base unit: 1e6 for "us"
  bool is_time = false;
};

/// Checks a measure; mistakes are diagnostics, and then there is none. A short form stands for a pointer:
///   reaction.KIND.TAKE   durations of reactions that nothing superseded; TAKE is max, min, mean, sum or count
///   latency.STREAM.FIGURE and latency.FIGURE (of all streams); FIGURE is max, p99, p50, mean, min or stddev
///   dropped  delivered  violations  events  verdict (1: pass)  utilisation  queue  sync
///   topology.FIGURE      diameter, bridges, disjoint_paths (topology_measures.hpp)
std::optional<PlannedMeasure> plan_measure(const Measure& measure, json::Diagnostics& diagnostics);

/// The figure in the measure's unit. Nothing if the result has none, or if one of several is null (a reaction that was never
/// complete has no greatest duration); sums and counts of nothing are 0.
std::optional<double> value_of(const PlannedMeasure& measure, const json::Node& result);

/// A limit of a measure, in its unit.
struct PlannedLimit {
  std::size_t measure = 0;
  bool is_upper = true;
  double value = 0;
  std::string text;                                              ///< "start <= 1ms"
  /// A figure that is missing does not keep a limit.
  bool holds(const std::optional<double>& figure) const { return figure && (is_upper ? *figure <= value : *figure >= value); }
};
std::optional<PlannedLimit> plan_limit(const Limit& limit, const std::vector<PlannedMeasure>& measures, json::Diagnostics& diagnostics);

}  // namespace takt::study
