// SPDX-License-Identifier: Apache-2.0
// The scheduled streams of a scenario as an instance for the search of ways.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "scenario/resolved/resolved.hpp"
#include "schedule/problem.hpp"
#include "synthesis/open_routes.hpp"

namespace takt::synthesis {

/// The nodes and links of a scenario, without streams.
struct InstanceNetwork {
  schedule::Problem problem;                                                       ///< nodes as in the topology
  std::map<std::pair<std::uint32_t, std::uint16_t>, schedule::LinkIndex> link_at;  ///< by node and port that sends
};
InstanceNetwork network_of(const scenario::Resolved& resolved);

struct ScenarioInstance {
  schedule::Problem problem;  ///< nodes as in the topology; streams of the scheduled classes
  /// By stream of the problem: its entry in Scenario::streams; nothing: it is of a Program, or a link that others keep.
  std::vector<std::optional<std::size_t>> streams;
  std::vector<schedule::Ps> lags;  ///< by stream: from its offset to its start at the talker
  bool cuts_through = false;       ///< some node may; the instance counts store and forward, so it proves nothing
  std::vector<bool> is_given;      ///< by stream: the scenario asks for no less; else it could be elsewhere
};

enum class InstanceFor : std::uint8_t {
  search,  ///< what has no stream in the instance keeps its place: on each link a stream that cannot move
  change,  ///< it is in nobody's way, or there is no instance
};

/// `resolved`: the scenario without gates. `wanted`: as the user wrote it, with the gates that are asked for, and the
/// shortest paths of streams whose routes are `open`. Streams that have a path in the file, an offset that is no
/// "auto", several listeners, or belong to a Program keep their way; those with a fixed offset keep it. Of frames that
/// may be at their talker's port before their windows, whether two of one queue come in the order of their windows is
/// for the caller to find out. Mistakes go to `diagnostics`. Nothing, and no mistake: `why_not` says what the instance
/// cannot express.
std::optional<ScenarioInstance> instance_of(scenario::Resolved& resolved, const scenario::Scenario& wanted,
                                            const OpenRoutes& open, json::Diagnostics& diagnostics,
                                            std::string& why_not, InstanceFor purpose = InstanceFor::search);

/// The same without what could be elsewhere: if that has no schedule the scenario has none.
ScenarioInstance given_streams(const ScenarioInstance& whole);

}  // namespace takt::synthesis
