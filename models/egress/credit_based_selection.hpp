// SPDX-License-Identifier: Apache-2.0
// The credit-based shaper algorithm for one class of a port (IEEE 802.1Q 8.6.8.2): the credit, and the gate that it
// follows.
#pragma once

#include "models/clock/local_clock.hpp"
#include "models/egress/credit_based_shaper.hpp"
#include "models/egress/gate_schedule.hpp"
#include "models/egress/shaping_config.hpp"

namespace takt::models {

/// The gate of the class as it is at present.
struct GateInForce {
  const LocalClock* clock = nullptr;
  bool has_gates = false;  ///< the port has any
  bool is_stuck = false;   ///< it stays as it is, whatever its list says
};

/// Follows its gate lazily, with a schedule of its own, since its time lags behind. All calls take true time, which
/// does not decrease.
class CreditBasedSelection {
 public:
  /// `config` outlives it.
  CreditBasedSelection(const CreditBased& config, TrafficClass q, GateStates admin_gate_states,
                       sim::DataRate port_transmit_rate);

  /// Another gate list for the port, asked for when its clock shows `asked`: now, or before the start.
  void request_change(const GateInForce& gate, sim::TrueTime now, sim::LocalTime asked,
                      const GateSchedule::AdminConfig& admin);
  /// Its gate is broken, open or closed, from now on; nothing: it works again.
  void force_gate(const GateInForce& gate, sim::TrueTime now, std::optional<bool> open);
  /// `now` if the credit is not negative, otherwise when to ask again. The gate is open.
  sim::TrueTime ready_time(const GateInForce& gate, sim::TrueTime now);
  /// At a port without gates: CreditBasedShaper::starts_at_rest().
  bool starts_at_rest(sim::TrueTime now, sim::Duration occupancy) { return credit_.starts_at_rest(now, occupancy); }
  /// How many bits the credit lacks, rounded up.
  std::uint32_t missing_bits(const GateInForce& gate, sim::TrueTime now) {
    const CreditBasedShaper& credit = credit_at(gate, now);
    const sim::int128 missing = -credit.credit(now).units;
    return missing <= 0 ? 0
                        : static_cast<std::uint32_t>((missing + credit.units_per_bit() - 1) / credit.units_per_bit());
  }
  /// The credit, which knows of its gate up to `now`.
  CreditBasedShaper& credit_at(const GateInForce& gate, sim::TrueTime now) {
    follow_gate(gate, now);
    return credit_;
  }

 private:
  void follow_gate(const GateInForce& gate, sim::TrueTime now);
  void set_gate(sim::TrueTime now, bool open);
  sim::LocalTime pending_change(sim::LocalTime at);
  void set_slope(sim::LocalTime local, sim::TrueTime now);

  const CreditBased* config_;
  TrafficClass class_;
  sim::DataRate rate_;
  CreditBasedShaper credit_;
  GateSchedule gates_;
  const GateControlList* slope_of_ = nullptr;  // the list for which the slope was computed
  sim::LocalTime followed_;                    // the time up to which the credit knows the gate
};

}  // namespace takt::models
