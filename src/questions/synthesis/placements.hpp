// SPDX-License-Identifier: Apache-2.0
// Other times and ways for the same streams, for those who are not content with the first schedule: what scheduled
// frames leave to the other classes depends on both.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"
#include "synthesis/open_routes.hpp"
#include "synthesis/stream_requirements.hpp"

namespace takt::synthesis {

/// A scenario with its schedule, how its streams were placed, and what bounds say of its requirements.
struct Placement {
  std::unique_ptr<scenario::Resolved> resolved;
  std::string how;              ///< "as soon as possible", "spread at sw1 to sw2" ...
  bool has_other_ways = false;  ///< than the scenario that was asked for
  std::vector<StreamRequirement> requirements;
};

struct PlacementOptions {
  OpenRoutes open;  ///< streams that may take other ways
  std::uint64_t seed = 1;
  std::function<bool()> stop;  ///< true: what is best so far is the answer
  /// The schedule of a scenario; null if there is none.
  std::function<std::unique_ptr<scenario::Resolved>(const scenario::Scenario&)> resolve;
};

/// What came of it.
struct Placed {
  Placement best;           ///< one that keeps what is required, or the one that comes closest
  std::uint32_t tried = 0;  ///< placements that are schedules, the first one among them
};

/// `first` is the schedule of `asked`. Goes on while a requirement is broken, through a fixed list of placements:
/// offsets that pack or spread frames at the port where the stream of the requirement waits longest, or are drawn; on
/// the ways that there are, on ways round those of the stream, and on other ways of the stream itself where they are
/// open. Same input, same answer, unless it is stopped.
Placed place_for_requirements(std::unique_ptr<scenario::Resolved> first, const scenario::Scenario& asked,
                              const PlacementOptions& options);

}  // namespace takt::synthesis
