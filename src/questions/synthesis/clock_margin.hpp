// SPDX-License-Identifier: Apache-2.0
// "margin": "auto": how far apart the clocks of two nodes may be, from the scenario's own gPTP.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/diagnostics.hpp"
#include "json/type.hpp"
#include "scenario/description/description.hpp"

namespace takt::synthesis {

/// The margin of gates and what it is made of. Some parts are bounds, some are measured: other seeds may do worse,
/// which the requirement "clocks" of the schedule then tells.
struct ClockMargin {
  std::uint64_t seeds = 0;  ///< runs of the scenario, without gates
  sim::Duration from;       ///< measured from then on
  sim::Duration measured;   ///< greatest difference of two clocks on ways that meet, in all runs
  sim::Duration
      between_looks;  ///< bound: what two oscillators drift apart between an instant and the nearest look at them
  std::optional<sim::Duration>
      required;              ///< what the scenario's own requirements let them differ by, on which bounds rest
  sim::Duration difference;  ///< the greater of what is required and what was measured and drifts; whole ns
  sim::Duration on_the_way;  ///< bound: what two oscillators drift apart in a cycle of the gates and the longest way of
                             ///< a scheduled frame
  sim::Duration margin;      ///< the difference and what drifts on the way; whole ns
  std::vector<std::string> nodes = {};  ///< whose clocks they are
};

constexpr std::uint64_t clock_margin_seeds = 8;

/// Automatic gates with the margin "auto".
inline bool has_margin_to_measure(const scenario::Scenario& scenario) {
  return scenario.gates && scenario.gates->plan == scenario::GatePlanning::automatic && scenario.gates->margin &&
         scenario.gates->margin->is_auto;
}

/// Runs the scenario with seeds from its own on. Nothing, with a diagnostic at "margin", if there is no gPTP, or not at
/// all nodes that scheduled frames pass, or clocks are not synchronised by `from`, follow two grandmasters, or are
/// worse than the scenario requires; or the scenario is wrong. Precondition: has_margin_to_measure().
std::optional<ClockMargin> measure_clock_margin(const scenario::Scenario& wanted, json::Diagnostics& diagnostics);

/// The same with that margin as a number; and the difference as requirement "clocks", on which bounds rest, if it has
/// none.
scenario::Scenario with_clock_margin(scenario::Scenario scenario, const ClockMargin& margin);

const json::Record& describe(json::Type<ClockMargin>);

}  // namespace takt::synthesis
