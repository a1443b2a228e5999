#include "models/egress/port_shaping.hpp"

#include <algorithm>

namespace takt::models {
namespace {

sim::DataRate rate_of(sim::Duration octet_time) {
  return {sim::DataRate::ps_in_8_seconds / static_cast<std::uint64_t>(octet_time.ps())};
}

}  // namespace

PortShaping::PortShaping(const ShapingConfig& config, const LocalClock& clock, sim::Duration octet_time)
    : config_(&config), clock_(&clock), octet_time_(octet_time), has_gates_(config.admin_gate_states != all_gates_open), gates_(config.admin_gate_states) {
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

Selection PortShaping::select(sim::TrueTime now, ClassSet candidates, const HeadLengths& heads) {
  Selection selection;
  while (candidates != 0) {
    const TrafficClass q = highest_class(candidates);
    const sim::TrueTime ready = ready_time(now, q, heads[q]);
    if (ready == now) return {true, q, sim::TrueTime::never()};
    selection.ask_again = std::min(selection.ask_again, ready);
    candidates = static_cast<ClassSet>(candidates & ~(1u << q));
  }
  return selection;
}

/// `now` if the frame may start, otherwise the earliest instant at which it is worth asking again.
sim::TrueTime PortShaping::ready_time(sim::TrueTime now, TrafficClass q, std::uint32_t length) {
  if (has_gates_) {
    const StartAnswer answer = gates_.may_start(q, clock_->local_at(now), octet_time_ * (preamble_and_sfd.count + std::int64_t{length}));
    if (!answer.may_start) return answer.ask_again == sim::LocalTime::never() ? sim::TrueTime::never() : clock_->true_at(answer.ask_again);
  }
  if (Shaper* const shaper = shapers_[q].get()) {
    follow_gate(*shaper, q, now);
    return shaper->credit.eligible_time(now);
  }
  return now;
}

/// Tells the credit when the gate opened and closed up to `now`: one step for each change since it was last asked.
void PortShaping::follow_gate(Shaper& shaper, TrafficClass q, sim::TrueTime now) {
  if (!has_gates_) return;
  const sim::LocalTime local = clock_->local_at(now);
  for (;;) {
    const sim::LocalTime at = shaper.followed;
    const bool open = shaper.gates.is_open(q, at);
    set_slope(shaper, q, clock_->true_at(at));
    const sim::LocalTime toggle = open ? shaper.gates.close_time(q, at) : shaper.gates.open_time(q, at);
    if (toggle > local) break;
    shaper.followed = toggle;
    if (open)
      shaper.credit.gate_closed(clock_->true_at(toggle));
    else
      shaper.credit.gate_opened(clock_->true_at(toggle));
  }
  shaper.followed = local;
  set_slope(shaper, q, now);
}

/// The operational idle slope belongs to the list that is running.
void PortShaping::set_slope(Shaper& shaper, TrafficClass q, sim::TrueTime now) {
  const sim::LocalTime local = clock_->local_at(now);
  const GateControlList* const list = shaper.gates.oper_control_list(local);
  if (list == shaper.slope_of) return;
  shaper.slope_of = list;
  const ShaperConfig& config = *config_->shapers[q];
  const OpenShare share = shaper.gates.open_share(q, local);
  if (!config.of_whole_cycle || share.open == sim::Duration()) return;
  shaper.credit.set_idle_slope(now, operational_idle_slope(config.idle_slope, share.open, share.cycle, rate_of(octet_time_)));
}

std::int64_t PortShaping::credit_bits(sim::TrueTime now, TrafficClass q) {
  Shaper& shaper = *shapers_[q];
  follow_gate(shaper, q, now);
  const sim::int128 units = shaper.credit.credit(now).units;
  const sim::int128 bit = shaper.credit.units_per_bit();
  return static_cast<std::int64_t>(units >= 0 ? units / bit : -((-units + bit - 1) / bit));
}

}  // namespace takt::models
