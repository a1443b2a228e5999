// SPDX-License-Identifier: Apache-2.0
#include "models/ingress/stream_gate.hpp"

namespace takt::models {

StreamGate::StreamGate(const StreamGateConfig& config)
    : config_(config), schedule_(config.admin_gate_open, config.admin_ipv) {
  if (!config.admin_control_list.empty())
    request_change(first_request(sim::LocalTime(), config.admin_base_time, config.is_running), config);
}

/// Where it is closed, or octets are counted.
StreamGate::Verdict StreamGate::admit_slow(Octets msdu, sim::LocalTime now) {
  const StreamGateState state = schedule_.state(now);
  if (is_latched() || !state.open) {
    ++counters_.closed;
    closed_due_to_invalid_rx_ = closed_due_to_invalid_rx_ || config_.closed_due_to_invalid_rx_enable;
    return {Outcome::closed, std::nullopt};
  }
  if (!interval_octets_.take(state, msdu.count)) {
    ++counters_.octets_exceeded;
    closed_due_to_octets_exceeded_ = config_.closed_due_to_octets_exceeded_enable;
    return {Outcome::octets_exceeded, std::nullopt};
  }
  ++counters_.passed;
  return {Outcome::passed, state.ipv};
}

ConfigChange StreamGate::request_change(sim::LocalTime now, const StreamGateConfig& config) {
  TAKT_CHECK(!config.admin_control_list.empty(), "a change of a stream gate brings a list");
  lists_.push_back(std::make_unique<const StreamGateList>(config.admin_control_list, config.admin_cycle_time));
  return schedule_.request_change(now,
                                  {lists_.back().get(), config.admin_base_time, config.admin_cycle_time_extension});
}

}  // namespace takt::models
