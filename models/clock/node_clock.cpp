// SPDX-License-Identifier: Apache-2.0
#include "models/clock/node_clock.hpp"

namespace takt::models {

NodeClock::NodeClock(sim::Simulation& simulation, const NodeClockPlan& plan, std::string_view path)
    : source_(simulation.add(*this)), oscillator_(plan.oscillator, simulation.seed(), path) {
  follow(simulation.now());
  if (plan.initial_offset != sim::Duration()) disciplined_.step(simulation.now(), plan.initial_offset);
}

void NodeClock::schedule_next(sim::Simulation& simulation) {
  const sim::TrueTime next = oscillator_.next_change();
  if (next != sim::TrueTime::never())
    simulation.schedule(source_, next, sim::Phase::control, source_.id(), 0, static_cast<std::uint64_t>(next.ps()));
}

void NodeClock::handle(sim::Simulation& simulation, const sim::Event& event) {
  if (oscillator_.next_change() != event.time) return;  // a fault has moved the next change
  oscillator_.advance();
  follow(simulation.now());
  schedule_next(simulation);
}

void NodeClock::set_frequency_offset(sim::Simulation& simulation, sim::FrequencyOffset offset) {
  const sim::TrueTime before = oscillator_.next_change();
  oscillator_.set_offset(simulation.now(), offset);
  follow(simulation.now());
  if (oscillator_.next_change() != before) schedule_next(simulation);
}

void NodeClock::follow(sim::TrueTime now) {
  free_running_.set_hardware_rate(now, oscillator_.rate());
  disciplined_.set_hardware_rate(now, oscillator_.rate());
}

}  // namespace takt::models
