// SPDX-License-Identifier: Apache-2.0
#include "models/egress/credit_based_selection.hpp"

#include <algorithm>

namespace takt::models {

CreditBasedSelection::CreditBasedSelection(const CreditBased& config, TrafficClass q, GateStates admin_gate_states,
                                           sim::DataRate port_transmit_rate)
    : config_(&config),
      class_(q),
      rate_(port_transmit_rate),
      credit_(CreditSlope{static_cast<std::int64_t>(config.idle_slope.bits_per_second), 1}, port_transmit_rate),
      gates_(admin_gate_states) {
  if ((admin_gate_states >> q & 1) == 0) credit_.gate_closed(sim::TrueTime());
}

void CreditBasedSelection::request_change(const GateInForce& gate, sim::TrueTime now, sim::LocalTime asked,
                                          const GateSchedule::AdminConfig& admin) {
  follow_gate(gate, now);
  gates_.request_change(asked, admin);
}

void CreditBasedSelection::force_gate(const GateInForce& gate, sim::TrueTime now, std::optional<bool> open) {
  follow_gate(gate, now);
  set_gate(now, open.value_or(gates_.is_open(class_, gate.clock->local_at(now))));
}

sim::TrueTime CreditBasedSelection::ready_time(const GateInForce& gate, sim::TrueTime now) {
  follow_gate(gate, now);
  const sim::TrueTime eligible = credit_.eligible_time(now);
  if (eligible == now || !gate.has_gates) return eligible;
  // Another list brings another slope.
  const sim::LocalTime change = pending_change(gate.clock->local_at(now));
  return std::min(eligible, gate.clock->true_after(change, now));
}

void CreditBasedSelection::set_gate(sim::TrueTime now, bool open) {
  if (open)
    credit_.gate_opened(now);
  else
    credit_.gate_closed(now);
}

/// Tells the credit when the gate opened and closed up to `now`: one step for each change since it was last asked, but
/// for those that find it at rest.
void CreditBasedSelection::follow_gate(const GateInForce& gate, sim::TrueTime now) {
  if (!gate.has_gates) return;
  const sim::LocalTime local = gate.clock->local_at(now);
  if (gate.is_stuck) {  // the list goes on behind it
    followed_ = local;
    static_cast<void>(gates_.is_open(class_, local));
    return;
  }
  // A slow clock shows one time at several instants, of which true_at() is the first, and the clock may have changed
  // since: no step goes behind what the credit knows already.
  const auto instant = [&](sim::LocalTime time) {
    return std::clamp(gate.clock->true_at(time), credit_.updated(), now);
  };
  for (;;) {
    const sim::LocalTime at = followed_;
    if (credit_.is_at_rest(instant(at))) {
      set_gate(now, gates_.is_open(class_, local));
      break;
    }
    const bool open = gates_.is_open(class_, at);
    if (open != credit_.gate_is_open())
      set_gate(instant(at), open);  // a list that began to run at once has moved the gate
    set_slope(at, instant(at));
    const sim::LocalTime toggle = open ? gates_.close_time(class_, at) : gates_.open_time(class_, at);
    if (const sim::LocalTime change = pending_change(at); change < toggle && change <= local) {
      followed_ = change;  // the slope belongs to the list, whether or not the gate moves
      continue;
    }
    if (toggle > local) break;
    followed_ = toggle;
    set_gate(instant(toggle), !open);
  }
  followed_ = local;
  set_slope(local, now);
}

/// When another list begins to run after `at`; never() if none is pending.
sim::LocalTime CreditBasedSelection::pending_change(sim::LocalTime at) {
  if (!gates_.config_pending(at)) return sim::LocalTime::never();
  const sim::LocalTime change = gates_.config_change_time();
  return change > at ? change : sim::LocalTime::never();
}

/// The operational idle slope belongs to the list that is running.
void CreditBasedSelection::set_slope(sim::LocalTime local, sim::TrueTime now) {
  const GateControlList* const list = gates_.oper_control_list(local);
  if (list == slope_of_) return;
  slope_of_ = list;
  const OpenShare share = gates_.open_share(class_, local);
  if (!config_->of_whole_cycle || share.open == sim::Duration()) return;
  credit_.set_idle_slope(now, operational_idle_slope(config_->idle_slope, share.open, share.cycle, rate_));
}

}  // namespace takt::models
