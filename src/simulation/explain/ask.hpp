// SPDX-License-Identifier: Apache-2.0
// Questions to a scenario: it is run, and what was asked about is explained.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "explain/explanation.hpp"
#include "explain/frame_finder.hpp"
#include "explain/reaction_chain.hpp"
#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::explain {

/// The stream of that name, if there is one.
std::optional<models::StreamIndex> stream_named(const scenario::Resolved& resolved, const std::string& name);

/// The frame, once for each of its ends that was asked for: of the slowest that end, of a lost one that where it was
/// dropped, or each copy of it, of a number all of them. Empty if there
/// is none, or if it was interrupted. For the slowest and a lost one the scenario is run twice: first to find the
/// frame, then to follow it.
std::vector<ExplainedFrame> explain_frame(const scenario::Resolved& resolved, const FrameQuestion& question,
                                          const Interrupted& interrupted = {});

/// The critical path of the reaction: the longest, or the one that took so long. Nothing if there is none, or if it was
/// interrupted. The scenario is run twice: first to find
/// the chain, then to follow its messages.
std::optional<ExplainedReaction> explain_reaction(const scenario::Resolved& resolved,
                                                  const scenario::AskedReaction& asked, TrueTime from,
                                                  std::optional<Duration> took = {},
                                                  const Interrupted& interrupted = {});

/// What a requirement of `resolved` has measured in a run of it, added to the explanation: the slowest frame or the
/// reaction that took so long. Of other requirements nothing.
void explain_measured(const scenario::Resolved& resolved, const results::RequirementResult& requirement,
                      Explanation& explanation, const Interrupted& interrupted = {});

}  // namespace takt::explain
