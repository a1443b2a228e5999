// Requirements on a figure of the result.
#pragma once

#include <optional>
#include <string>

#include "scenario/figures/figure.hpp"
#include "scenario/resolve/resolved.hpp"

namespace takt::scenario {

/// What a requirement with "figure" asks.
struct FigureRequirement {
  Figure figure;
  FigureLimit limit;
  std::string name;   ///< "reaction.start.max", "/streams/*/latency_ps/max (mean)"
};

/// Reads a requirement with "figure"; mistakes are diagnostics, and then there is none. Names in the pointer are not checked.
std::optional<FigureRequirement> read_figure_requirement(const Requirement& requirement, json::Diagnostics& diagnostics);

/// Checks a requirement that may have "figure", against the names of the scenario as well: whether it is none, so that others check it.
bool check_figure(const Resolved& resolved, const Requirement& requirement, json::Diagnostics& diagnostics);

/// A name in a figure's pointer that nothing in the scenario has.
struct UnknownName {
  std::string kind;         ///< "stream", "program" ...
  std::string name;
  std::string suggestion;   ///< may be empty
};
std::optional<UnknownName> unknown_name(const Figure& figure, const Resolved& resolved);

}  // namespace takt::scenario
