// SPDX-License-Identifier: Apache-2.0
#include "models/egress/port_shaping.hpp"

#include <algorithm>

namespace takt::models {

PortShaping::PortShaping(const ShapingConfig& config, const LocalClock& clock, sim::Duration octet_time)
    : config_(&config),
      clock_(&clock),
      octet_time_(octet_time),
      has_gates_(config.admin_gate_states != all_gates_open),
      limits_sdu_(std::any_of(config.queue_max_sdu.begin(), config.queue_max_sdu.end(),
                              [](Octets most) { return most.count != 0; })),
      timed_(config.timed()),
      gates_(config.admin_gate_states) {
  const sim::DataRate rate{sim::DataRate::ps_in_8_seconds / static_cast<std::uint64_t>(octet_time.ps())};
  DeficitRoundRobin::PerClass quanta{};
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    if (const auto* const share = std::get_if<EnhancedTransmissionSelection>(&config.selection[q]))
      quanta[q] = share->bandwidth;
    if (const CreditBased* const shaper = config.shaper_of(q))
      credits_[q] = std::make_unique<CreditBasedSelection>(*shaper, q, config.admin_gate_states, rate);
  }
  if (config.shared() != 0) round_ = std::make_unique<DeficitRoundRobin>(quanta);
  if (config.gates)
    request_gates(
        sim::TrueTime(),
        first_request(clock.local_at(sim::TrueTime()), config.gates->admin_base_time, config.gates->is_running),
        *config.gates);
  find_gated();
}

void PortShaping::find_gated() {
  gated_ = 0;
  for (TrafficClass q = 0; q < traffic_class_count; ++q)
    if (has_gates_ && clock_->is_ideal() && !is_stuck(q) && !is_timed(q) && credits_[q] == nullptr)
      gated_ = with(gated_, q);
}

ConfigChange PortShaping::request_gates(sim::TrueTime now, const GateConfig& gates) {
  return request_gates(now, clock_->local_at(now), gates);
}

ConfigChange PortShaping::request_gates(sim::TrueTime now, sim::LocalTime asked, const GateConfig& gates) {
  has_gates_ = true;
  find_gated();
  lists_.push_back(std::make_unique<GateControlList>(gates.admin_control_list, gates.admin_cycle_time));
  const GateSchedule::AdminConfig admin{lists_.back().get(), gates.admin_base_time, gates.admin_cycle_time_extension};
  for (TrafficClass q = 0; q < traffic_class_count; ++q)
    if (CreditBasedSelection* const credit = credit_based(q)) credit->request_change(gate_of(q), now, asked, admin);
  return gates_.request_change(asked, admin);
}

/// `now` if the gate lets the frame pass, otherwise the earliest instant at which it is worth asking again.
[[gnu::always_inline]] inline sim::TrueTime PortShaping::gate_ready_time(sim::TrueTime now, TrafficClass q,
                                                                         std::uint32_t length, sim::Duration delay) {
  if (!has_gates_) return now;
  if (is_stuck(q)) [[unlikely]]
    return contains(forced_open_, q) ? now : sim::TrueTime::never();
  const StartAnswer answer = gates_.may_start(q, clock_->local_at(now), delay + occupancy_until_last_bit(length));
  if (answer.may_start) return now;
  return clock_->true_after(answer.ask_again, now);
}

sim::TrueTime PortShaping::ready_time(sim::TrueTime now, TrafficClass q, const Head& head, sim::Duration delay) {
  if (is_held(q, now, head)) return clock_->true_after(head.eligible, now);
  const sim::TrueTime gate = gate_ready_time(now, q, head.length, delay);
  if (gate != now) return gate;
  if (CreditBasedSelection* const credit = credit_based(q)) return credit->ready_time(gate_of(q), now);
  return now;
}

sim::TrueTime PortShaping::start_slow(sim::TrueTime now, TrafficClass q, const Head& head) {
  frame_waits(now, q);
  const sim::TrueTime ready = ready_time(now, q, head);
  if (ready == now) started(now, q, head.length, true);
  return ready;
}

sim::TrueTime PortShaping::rest_ready_time(sim::TrueTime now, TrafficClass q, std::uint32_t remaining) {
  return gate_ready_time(now, q, remaining, {});
}

BlockedRecord PortShaping::gate_refusal(sim::TrueTime now, TrafficClass q) {
  BlockedRecord refusal{.hindrance = BlockReason::gate_closed, .traffic_class = q, .amount = BlockedRecord::no_entry};
  if (is_stuck(q)) return refusal;
  const sim::LocalTime local = clock_->local_at(now);
  if (gates_.is_open(q, local)) refusal.hindrance = BlockReason::guard;
  if (const std::optional<std::size_t> entry = gates_.entry(local)) refusal.amount = static_cast<std::uint32_t>(*entry);
  return refusal;
}

BlockedRecord PortShaping::refusal(sim::TrueTime now, TrafficClass q, const Head& head) {
  if (is_held(q, now, head)) return {.hindrance = BlockReason::not_eligible, .traffic_class = q};
  CreditBasedSelection* const credit = credit_based(q);
  if (credit == nullptr || gate_ready_time(now, q, head.length, {}) != now) return gate_refusal(now, q);
  return {.hindrance = BlockReason::credit, .traffic_class = q, .amount = credit->missing_bits(gate_of(q), now)};
}

void PortShaping::force_gate(sim::TrueTime now, TrafficClass q, std::optional<bool> open) {
  has_gates_ = true;
  // Up to now its gate was as it was before.
  if (CreditBasedSelection* const credit = credit_based(q)) credit->force_gate(gate_of(q), now, open);
  forced_open_ = without(forced_open_, q);
  forced_closed_ = without(forced_closed_, q);
  if (open) {
    ClassSet& set = *open ? forced_open_ : forced_closed_;
    set = with(set, q);
  }
  find_gated();
}

void PortShaping::check_overrun(sim::TrueTime now, TrafficClass q, sim::TrueTime last_bit) {
  if (contains(forced_open_, q)) return;
  const sim::LocalTime close = gates_.close_time(q, clock_->local_at(now));
  if (contains(forced_closed_, q) || (close != sim::LocalTime::never() && clock_->true_at(close) < last_bit))
    ++transmission_overrun_[q];
}

}  // namespace takt::models
