// SPDX-License-Identifier: Apache-2.0
// What a figure of the result can be in any run, as far as the bounds say it: for requirements with "figure".
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "analysis/bounds.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::analysis {

/// How many frames of the stream are delivered to all listeners together until the end, of those produced at `from` or
/// later: as the scenario is, for when its talker begins is no matter of the network. An end that is not known has a
/// reason.
struct DeliveredFrames {
  std::optional<std::uint64_t> least;
  std::optional<std::uint64_t> greatest;
  std::string reason;
};
DeliveredFrames frames_delivered(const scenario::Resolved& resolved, const StreamBound& stream, sim::Duration from);

/// How long such a reaction can take at most.
using ReactionBoundOf = std::function<RequirementBound(const scenario::AskedReaction&)>;

/// The range of a figure of what began at `from` or later, if the run has that figure: where no frame comes there is no
/// latency. Where the range has no end, the reason says what is not bounded.
RequirementBound bound_of_figure(const scenario::Resolved& resolved, const Bounds& bounds,
                                 const scenario::Figure& figure, sim::Duration from, const ReactionBoundOf& reaction);

}  // namespace takt::analysis
