// SPDX-License-Identifier: Apache-2.0
// A scenario with "gates": "auto" gets offsets, paths and gate lists, or a reason why not.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"
#include "schedule/decide.hpp"
#include "synthesis/clock_margin.hpp"
#include "synthesis/slack.hpp"
#include "synthesis/stream_requirements.hpp"

namespace takt::synthesis {

struct ScenarioOptions {
  bool may_route = true;                         ///< streams without a path and with "offset": "auto" may get one
  bool may_route_open = true;                    ///< those that say "route": "auto" may
  std::uint32_t entries = 1024;                  ///< a gate list may have, besides what "gate_limits" of nodes say
  bool wants_slack = false;                      ///< the greatest clock error, not the first schedule
  std::optional<ClockMargin> clock_margin = {};  ///< for "margin": "auto"; empty: it is measured first
  schedule::SearchOptions search;
};

/// How one scheduled stream fared.
struct JudgedStream {
  std::string name;
  sim::Duration planned;               ///< latency that the schedule promises, from the release on
  std::uint64_t delivered = 0;         ///< in the run
  sim::Duration simulated;             ///< the greatest latency there
  std::optional<sim::Duration> bound;  ///< from production on
};

struct ScenarioSchedule {
  schedule::Decision::Verdict verdict = schedule::Decision::Verdict::undecided;
  std::string how;  ///< "given paths", "searched paths"; what stood in the way, or the kind of the proof
  std::unique_ptr<scenario::Resolved> resolved;  ///< if scheduled; its `scenario` is the answer
  std::optional<schedule::Problem> instance;     ///< what the certificate is of, and the left-over streams
  std::optional<schedule::Certificate> certificate;
  std::string proof;  ///< what the certificate says, in words
  std::vector<schedule::LeftOver> left_over;
  std::size_t most_entries = 0;
  std::optional<ClockMargin> clock_margin;  ///< if "auto" was asked for
  std::optional<Slack> slack;               ///< if it was asked for
  std::vector<std::string> wrong;           ///< what a judge found; takt is wrong then
  std::vector<JudgedStream> streams;
  std::vector<StreamRequirement>
      requirements;              ///< what is required of streams; if that breaks, of the schedule that comes closest
  std::uint32_t placements = 0;  ///< schedules that were bounded for their sake
  std::string placement;         ///< how streams were placed in the one that `requirements` are of
};

/// Mistakes of the scenario go to `diagnostics`; then the answer is nothing.
std::optional<ScenarioSchedule> schedule_scenario(const scenario::Scenario& wanted, const ScenarioOptions& options,
                                                  json::Diagnostics& diagnostics);

}  // namespace takt::synthesis
