// SPDX-License-Identifier: Apache-2.0
// The clocks of one node: an oscillator, a free-running clock for timestamps, and the one that the node's time comes
// from.
#pragma once

#include <string_view>

#include "models/clock/local_clock.hpp"
#include "models/clock/oscillator.hpp"
#include "models/clock/timestamp_unit.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

struct NodeClockPlan {
  OscillatorConfig oscillator;
  TimestampUnit timestamps;
  sim::Duration initial_offset;  ///< of the node's time from true time at the start
};

class NodeClock final : public sim::Component {
 public:
  /// `path` names the node in the random streams.
  NodeClock(sim::Simulation& simulation, const NodeClockPlan& plan, std::string_view path);

  /// Schedules the first change of frequency. Call once, at time zero.
  void start(sim::Simulation& simulation) { schedule_next(simulation); }
  void handle(sim::Simulation& simulation, const sim::Event& event) override;

  /// Follows the oscillator alone.
  LocalClock& free_running() { return free_running_; }
  const LocalClock& free_running() const { return free_running_; }
  /// The node's time: follows the oscillator, and what a servo makes of it.
  LocalClock& disciplined() { return disciplined_; }
  const LocalClock& disciplined() const { return disciplined_; }

  /// Another frequency offset from now on, on top of drift, temperature and walk (a fault).
  void set_frequency_offset(sim::Simulation& simulation, sim::FrequencyOffset offset);
  /// The node's time jumps (a fault, or management).
  void step(sim::Simulation& simulation, sim::Duration by) { disciplined_.step(simulation.now(), by); }

 private:
  void schedule_next(sim::Simulation& simulation);
  void follow(sim::TrueTime now);

  sim::EventSource source_;
  Oscillator oscillator_;
  LocalClock free_running_;
  LocalClock disciplined_;
};

}  // namespace takt::models
