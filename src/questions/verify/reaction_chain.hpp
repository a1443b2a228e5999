// SPDX-License-Identifier: Apache-2.0
// How a reaction of a run came about: the words that made the last participant follow, backwards to the cause.
#pragma once

#include <vector>

#include "scenario/figures/requirement.hpp"
#include "verify/frame_log.hpp"
#include "verify/slack.hpp"

namespace takt::verify {

/// The parts of the longest reaction that `required` asks about, in `run`, which is over: each word waits to be
/// published and is on its way, INIT lasts. `log` has all words between participants. What the bound has beyond that
/// chain is a part of its own. Nothing if no reaction took `measured`.
std::vector<SlackPart> reaction_parts(const scenario::Run& run, const FrameLog& log, const analysis::Bounds& bounds,
                                      const scenario::RequiredFigure& required, sim::Duration measured,
                                      sim::Duration bound);

}  // namespace takt::verify
