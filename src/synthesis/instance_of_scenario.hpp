// The scheduled streams of a scenario as an instance for the search of ways.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "scenario/resolve/resolved.hpp"
#include "schedule/problem.hpp"
#include "synthesis/open_routes.hpp"

namespace takt::synthesis {

/// The nodes and links of a scenario, without streams.
struct InstanceNetwork {
  schedule::Problem problem;                     ///< nodes as in the topology
  std::map<std::pair<std::uint32_t, std::uint16_t>, schedule::LinkIndex> link_at;   ///< by node and port that sends
};
InstanceNetwork network_of(const scenario::Resolved& resolved);

struct ScenarioInstance {
  schedule::Problem problem;                     ///< nodes as in the topology; streams of the scheduled classes
  std::vector<std::optional<std::size_t>> streams;  ///< by stream of the problem: its entry in Scenario::streams; nothing: it is of a program
};

/// `resolved`: the scenario without gates. `wanted`: as the user wrote it, with the gates that are asked for, and the shortest paths of streams whose routes are `open`. Streams that have a path in the file, an offset that is no "auto", several listeners, or belong to a
/// program keep their way; those with a fixed offset keep it. Mistakes go to `diagnostics`. Nothing, and no mistake: `why_not` says what the instance cannot express. `allows_early`: frames that may be at their
/// talker's port before their windows are as good as others; that two of one queue come in the order of their windows is for the caller to find out.
std::optional<ScenarioInstance> instance_of(scenario::Resolved& resolved, const scenario::Scenario& wanted, const OpenRoutes& open, json::Diagnostics& diagnostics, std::string& why_not, bool allows_early = false);

}  // namespace takt::synthesis
