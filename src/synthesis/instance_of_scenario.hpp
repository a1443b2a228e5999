// The scheduled streams of a scenario as an instance for the search of ways.
#pragma once

#include <optional>
#include <string>

#include "scenario/resolve/resolved.hpp"
#include "schedule/problem.hpp"

namespace takt::synthesis {

struct ScenarioInstance {
  schedule::Problem problem;                     ///< nodes as in the topology; streams of the scheduled classes
  std::vector<std::optional<std::size_t>> streams;  ///< by stream of the problem: its entry in Scenario::streams; nothing: it is of a program
};

/// `resolved`: the scenario without gates. `wanted`: as the user wrote it, with the gates that are asked for. Streams that have a path in the file, an offset that is no "auto", several listeners, or belong to a
/// program keep their way; those with a fixed offset keep it. Mistakes go to `diagnostics`. Nothing, and no mistake: `why_not` says what the instance cannot express. `allows_early`: frames that may be at their
/// talker's port before their windows are as good as others; that two of one queue come in the order of their windows is for the caller to find out.
std::optional<ScenarioInstance> instance_of(scenario::Resolved& resolved, const scenario::Scenario& wanted, json::Diagnostics& diagnostics, std::string& why_not, bool allows_early = false);

}  // namespace takt::synthesis
