#include "models/egress/port_shaping.hpp"

#include <algorithm>

namespace takt::models {
namespace {

sim::DataRate rate_of(sim::Duration octet_time) {
  return {sim::DataRate::ps_in_8_seconds / static_cast<std::uint64_t>(octet_time.ps())};
}

}  // namespace

PortShaping::PortShaping(const ShapingConfig& config, const LocalClock& clock, sim::Duration octet_time)
    : config_(&config), clock_(&clock), octet_time_(octet_time), has_gates_(config.admin_gate_states != all_gates_open),
      limits_sdu_(std::any_of(config.queue_max_sdu.begin(), config.queue_max_sdu.end(), [](Octets most) { return most.count != 0; })),
      gates_(config.admin_gate_states) {
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    if (!config.shapers[q]) continue;
    const CreditSlope slope{static_cast<std::int64_t>(config.shapers[q]->idle_slope.bits_per_second), 1};
    shapers_[q] = std::make_unique<Shaper>(Shaper{CreditBasedShaper(slope, rate_of(octet_time)), GateSchedule(config.admin_gate_states), nullptr, {}});
    if ((config.admin_gate_states >> q & 1) == 0) shapers_[q]->credit.gate_closed(sim::TrueTime());
  }
  if (config.gates) request_gates(sim::TrueTime(), *config.gates);
}

ConfigChange PortShaping::request_gates(sim::TrueTime now, const GateConfig& gates) {
  has_gates_ = true;
  lists_.push_back(std::make_unique<GateControlList>(gates.admin_control_list, gates.admin_cycle_time));
  const GateSchedule::AdminConfig admin{lists_.back().get(), gates.admin_base_time, gates.admin_cycle_time_extension};
  const sim::LocalTime local = clock_->local_at(now);
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    if (!shapers_[q]) continue;
    follow_gate(*shapers_[q], q, now);
    shapers_[q]->gates.request_change(local, admin);
  }
  return gates_.request_change(local, admin);
}

/// `now` if the gate lets the frame pass, otherwise the earliest instant at which it is worth asking again.
[[gnu::always_inline]] inline sim::TrueTime PortShaping::gate_ready_time(sim::TrueTime now, TrafficClass q, std::uint32_t length, sim::Duration delay) {
  if (!has_gates_) return now;
  if (((forced_open_ | forced_closed_) >> q & 1u) != 0) [[unlikely]] return contains(forced_open_, q) ? now : sim::TrueTime::never();
  const StartAnswer answer = gates_.may_start(q, clock_->local_at(now), delay + octet_time_ * (preamble_and_sfd.count + std::int64_t{length}));
  if (answer.may_start) return now;
  return clock_->true_after(answer.ask_again, now);
}

sim::TrueTime PortShaping::ready_time(sim::TrueTime now, TrafficClass q, const Head& head, sim::Duration delay) {
  if (config_->timed != 0 && is_timed(q) && head.eligible > clock_->local_at(now)) return clock_->true_after(head.eligible, now);
  const sim::TrueTime gate = gate_ready_time(now, q, head.length, delay);
  if (gate != now) return gate;
  if (Shaper* const shaper = shapers_[q].get()) {
    follow_gate(*shaper, q, now);
    const sim::TrueTime eligible = shaper->credit.eligible_time(now);
    if (eligible == now || !has_gates_) return eligible;
    // Another list brings another slope.
    const sim::LocalTime change = pending_change(*shaper, clock_->local_at(now));
    return std::min(eligible, clock_->true_after(change, now));
  }
  return now;
}

sim::TrueTime PortShaping::rest_ready_time(sim::TrueTime now, TrafficClass q, std::uint32_t remaining) { return gate_ready_time(now, q, remaining, {}); }

void PortShaping::force_gate(sim::TrueTime now, TrafficClass q, std::optional<bool> open) {
  has_gates_ = true;
  Shaper* const shaper = shapers_[q].get();
  if (shaper != nullptr) follow_gate(*shaper, q, now);
  forced_open_ = without(forced_open_, q);
  forced_closed_ = without(forced_closed_, q);
  if (open) {
    ClassSet& set = *open ? forced_open_ : forced_closed_;
    set = with(set, q);
  }
  if (shaper == nullptr) return;
  if (open.value_or(shaper->gates.is_open(q, clock_->local_at(now))))
    shaper->credit.gate_opened(now);
  else
    shaper->credit.gate_closed(now);
}

void PortShaping::check_overrun(sim::TrueTime now, TrafficClass q, sim::TrueTime last_bit) {
  if (contains(forced_open_, q)) return;
  const sim::LocalTime close = gates_.close_time(q, clock_->local_at(now));
  if (contains(forced_closed_, q) || (close != sim::LocalTime::never() && clock_->true_at(close) < last_bit)) ++transmission_overrun_[q];
}

/// Tells the credit when the gate opened and closed up to `now`: one step for each change since it was last asked, but for those
/// that find it at rest.
void PortShaping::follow_gate(Shaper& shaper, TrafficClass q, sim::TrueTime now) {
  if (!has_gates_) return;
  const sim::LocalTime local = clock_->local_at(now);
  if (((forced_open_ | forced_closed_) >> q & 1u) != 0) {  // it stays as it is; the list goes on behind it
    shaper.followed = local;
    static_cast<void>(shaper.gates.is_open(q, local));
    return;
  }
  // A slow clock shows one time at several instants, of which true_at() is the first, and the clock may have changed since: no step goes behind what
  // the credit knows already.
  const auto instant = [&](sim::LocalTime time) { return std::clamp(clock_->true_at(time), shaper.credit.updated(), now); };
  for (;;) {
    const sim::LocalTime at = shaper.followed;
    if (shaper.credit.is_at_rest(instant(at))) {
      if (shaper.gates.is_open(q, local))
        shaper.credit.gate_opened(now);
      else
        shaper.credit.gate_closed(now);
      break;
    }
    const bool open = shaper.gates.is_open(q, at);
    if (open != shaper.credit.gate_is_open()) {  // a list that began to run at once has moved the gate
      if (open)
        shaper.credit.gate_opened(instant(at));
      else
        shaper.credit.gate_closed(instant(at));
    }
    set_slope(shaper, q, at, instant(at));
    const sim::LocalTime toggle = open ? shaper.gates.close_time(q, at) : shaper.gates.open_time(q, at);
    if (const sim::LocalTime change = pending_change(shaper, at); change < toggle && change <= local) {
      shaper.followed = change;  // the slope belongs to the list, whether or not the gate moves
      continue;
    }
    if (toggle > local) break;
    shaper.followed = toggle;
    if (open)
      shaper.credit.gate_closed(instant(toggle));
    else
      shaper.credit.gate_opened(instant(toggle));
  }
  shaper.followed = local;
  set_slope(shaper, q, local, now);
}

/// When another list begins to run after `at`; never() if none is pending.
sim::LocalTime PortShaping::pending_change(Shaper& shaper, sim::LocalTime at) {
  if (!shaper.gates.config_pending(at)) return sim::LocalTime::never();
  const sim::LocalTime change = shaper.gates.config_change_time();
  return change > at ? change : sim::LocalTime::never();
}

/// The operational idle slope belongs to the list that is running.
void PortShaping::set_slope(Shaper& shaper, TrafficClass q, sim::LocalTime local, sim::TrueTime now) {
  const GateControlList* const list = shaper.gates.oper_control_list(local);
  if (list == shaper.slope_of) return;
  shaper.slope_of = list;
  const ShaperConfig& config = *config_->shapers[q];
  const OpenShare share = shaper.gates.open_share(q, local);
  if (!config.of_whole_cycle || share.open == sim::Duration()) return;
  shaper.credit.set_idle_slope(now, operational_idle_slope(config.idle_slope, share.open, share.cycle, rate_of(octet_time_)));
}

}  // namespace takt::models
