// What a figure of the result can be in any run, as far as the bounds say it: for requirements with "figure".
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "analysis/bounds.hpp"
#include "scenario/figures/figure.hpp"

namespace takt::analysis {

/// The reaction whose durations the figure is taken of, as a requirement asks for it; nothing if it is no such figure.
std::optional<scenario::Requirement> reaction_of(const scenario::Figure& figure);
/// The stream whose latencies the figure is taken of ("*": all); nothing if it is no such figure.
std::optional<std::string> latency_of(const scenario::Figure& figure);

/// How many frames of the stream are delivered to all listeners together until the end, of those produced at `from` or later: as the scenario is, for when
/// its talker begins is no matter of the network. An end that is not known has a reason.
struct DeliveredFrames {
  std::optional<std::uint64_t> least;
  std::optional<std::uint64_t> greatest;
  std::string reason;
};
DeliveredFrames frames_delivered(const scenario::Resolved& resolved, const StreamBound& stream, sim::Duration from);

/// What a requirement on a reaction can be at most.
using ReactionBoundOf = std::function<RequirementBound(const scenario::Requirement&)>;

/// The range of a figure of what began at `from` or later, if the run has that figure: where no frame comes there is no latency. Where the range has
/// no end, the reason says what is not bounded.
RequirementBound bound_of_figure(const scenario::Resolved& resolved, const Bounds& bounds, const scenario::Figure& figure, sim::Duration from, const ReactionBoundOf& reaction);

}  // namespace takt::analysis
