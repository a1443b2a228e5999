// SPDX-License-Identifier: Apache-2.0
// A trial of a property: what goes wrong in a run, as plain numbers that a property test can draw and shrink.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "results/run_result.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::property {

/// From what trials are drawn.
struct Space {
  double highest_loss = 0;  ///< of frames on each direction of a link, 0 to 1; 0: none
  bool phases =
      true;  ///< phases of talkers and publishers and the instants of calls, where the scenario leaves them open
  bool link_downs = false;
  bool crashes = false;             ///< of hosts
  std::uint32_t most_troubles = 4;  ///< losses, outages and crashes in one run
  sim::Duration longest = {};       ///< outages and crashes last as long at most; 0: a tenth of the run
  bool shorten = true;              ///< leave out waiting where the scenario allows it (verify/shortened.hpp)
};

/// One thing that goes wrong. Smaller numbers are simpler, so that shrinking leads to less.
struct Trouble {
  enum class Kind : std::uint8_t { loss, link_down, crash };
  Kind kind = Kind::loss;
  std::uint32_t where = 0;  ///< number of the link, or of the host
  std::uint32_t when = 0;   ///< thousandths of the run's duration
  std::uint32_t size = 0;   ///< thousandths: of the highest loss, or of the longest outage
};

struct Trial {
  std::vector<Trouble> troubles;
  std::vector<std::uint32_t> phases;  ///< thousandths of their ranges; missing ones are 0
  std::uint32_t seed = 0;             ///< added to the scenario's
};

/// The scenario in which the trial happens. What cannot be (two outages of one link at once) is left out.
scenario::Scenario scenario_of(const scenario::Resolved& resolved, const Space& space, const Trial& trial);

/// What a run came to, for properties to look at.
class Outcome {
 public:
  explicit Outcome(results::RunResult result) : result_(std::move(result)) {}
  const results::RunResult& result() const { return result_; }
  /// Whether every reaction of that kind ("start", "halt" ...) that nothing superseded was complete within so long.
  bool reacted_within(const std::string& kind, sim::Duration limit) const;
  /// Whether all participants of all Programs are in this state at the end ("Halted", "Running" ...).
  bool all_end_in(const std::string& state) const;
  bool keeps_invariants() const;
  /// Whether all frames of the stream that came took at most so long.
  bool latency_within(const std::string& stream, sim::Duration limit) const;

 private:
  results::RunResult result_;
};

Outcome run(const scenario::Scenario& scenario);

}  // namespace takt::property
