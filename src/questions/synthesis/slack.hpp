// SPDX-License-Identifier: Apache-2.0
// How far clocks may differ before a schedule of windows breaks, and the schedule that takes most.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "scenario/resolved/resolved.hpp"

namespace takt::synthesis {

/// The greatest margin with which the windows of these streams, at their times, still are a schedule.
struct Slack {
  sim::Duration margin;   ///< whole ns; at least that of the plan
  std::string with_more;  ///< what is wrong with 1 ns more
};

/// Why windows with this margin are no schedule: two that meet, a required latency that they exceed, a port at which
/// the other classes have no time for a frame of 1522 octets any more, or what the checker finds. Empty: they are one.
std::string why_not_with(sim::Duration margin, const scenario::GatePlan& plan, const scenario::Scenario& scenario);

/// What is asked of scenarios with other margins.
struct SlackQuestions {
  using Resolver = std::function<std::unique_ptr<scenario::Resolved>(const scenario::Scenario&)>;
  Resolver at_these_times;  ///< the schedule of a scenario whose offsets are written; null if there is none
  Resolver at_other_times;  ///< the same where offsets are open, one that keeps what is required
  /// A requirement that a schedule breaks: wider windows leave less to the other traffic. Empty: none.
  std::function<std::string(const scenario::Resolved&)> breaks;
};

/// `resolved` is the schedule of `asked`, which may leave offsets open. Looks for offsets that let clocks differ more,
/// until `stop` or to the ns, and gives the windows the margin that was found.
std::unique_ptr<scenario::Resolved> with_most_slack(std::unique_ptr<scenario::Resolved> resolved,
                                                    const scenario::Scenario& asked, const SlackQuestions& questions,
                                                    const std::function<bool()>& stop, Slack& slack);

}  // namespace takt::synthesis
