// Questions to a scenario: it is run, and what was asked about is explained.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "explain/explanation.hpp"
#include "explain/reaction_chain.hpp"
#include "results/run_result.hpp"
#include "scenario/resolve/resolved.hpp"

namespace takt::explain {

/// Asked between slices of a run; true: no more.
using Interrupted = std::function<bool()>;

struct FrameQuestion {
  enum class Which : std::uint8_t { slowest, lost, number };
  std::optional<models::StreamIndex> stream = {};   ///< all streams but those of gPTP, if absent; with `number` there must be one
  Which which = Which::slowest;                     ///< of all deliveries; the first that is dropped (no copy that was eliminated); that number
  std::uint64_t number = 0;
  TrueTime from = {};                               ///< of frames that are produced then or later
};

/// The stream of that name, if there is one.
std::optional<models::StreamIndex> stream_named(const scenario::Resolved& resolved, const std::string& name);

/// The frame, once for each of its ends that was asked for: of the slowest and of a lost one that end, of a number all of them. Empty if there is none, or if it was interrupted.
std::vector<ExplainedFrame> explain_frame(const scenario::Resolved& resolved, const FrameQuestion& question, const Interrupted& interrupted = {});

/// The critical path of the reaction: the longest, or the one that took so long. Nothing if there is none, or if it was interrupted. The scenario is run twice: first to find
/// the chain, then to follow its messages.
std::optional<ExplainedReaction> explain_reaction(const scenario::Resolved& resolved, const scenario::AskedReaction& asked, TrueTime from, std::optional<Duration> took = {}, const Interrupted& interrupted = {});

/// What a requirement of `resolved` has measured in a run of it, added to the explanation: the slowest frame or the reaction that took so long. Of other requirements nothing.
void explain_measured(const scenario::Resolved& resolved, const results::RequirementResult& requirement, Explanation& explanation, const Interrupted& interrupted = {});

}  // namespace takt::explain
