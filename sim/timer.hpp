// SPDX-License-Identifier: Apache-2.0
// A time-out that can be moved and cancelled in O(1).
#pragma once

#include "sim/simulation.hpp"

namespace takt::sim {

/// One cancellable, movable time-out of a component. Moving it to a later time costs no event: the pending event
/// notices when it comes due that the deadline has moved, and goes there. So a time-out that every message restarts
/// keeps one event in the queue. The owner calls fired() when an event of the timer's kind arrives.
class Timer {
 public:
  /// Events carry `kind`, go to `target` in `phase`, and are scheduled under the source that is given with each call.
  Timer(ComponentId target, Phase phase, EventKind kind) : target_(target), kind_(kind), phase_(phase) {}

  bool armed() const { return deadline_ != TrueTime::never(); }
  TrueTime deadline() const { return deadline_; }

  void arm(Simulation& simulation, EventSource& source, TrueTime deadline) {
    deadline_ = deadline;
    if (deadline < pending_) {
      pending_ = deadline;
      simulation.schedule(source, deadline, phase_, target_, kind_, ++generation_);
    }
  }

  void cancel() { deadline_ = TrueTime::never(); }

  /// True if `event`, an event of this timer, is the time-out itself and not the trace of a moved or cancelled one.
  bool fired(Simulation& simulation, EventSource& source, const Event& event) {
    if (!is_due(simulation, source, event)) return false;
    cancel();
    return true;
  }
  /// The same for an owner that may act on another of its timers first: it stays armed.
  bool is_due(Simulation& simulation, EventSource& source, const Event& event) {
    if (event.argument != generation_) return false;
    pending_ = TrueTime::never();
    if (!armed()) return false;
    if (deadline_ <= simulation.now()) return true;
    arm(simulation, source, deadline_);
    return false;
  }

 private:
  TrueTime deadline_ = TrueTime::never();
  TrueTime pending_ = TrueTime::never();
  std::uint64_t generation_ = 0;
  ComponentId target_;
  EventKind kind_;
  Phase phase_;
};

}  // namespace takt::sim
