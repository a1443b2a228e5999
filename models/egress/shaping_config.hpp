// SPDX-License-Identifier: Apache-2.0
// What management sets of a port: gates, the transmission selection algorithm of each class, maximum SDU sizes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "models/egress/class_set.hpp"
#include "models/egress/gate_control_list.hpp"
#include "models/egress/preemption.hpp"
#include "models/ethernet/frame.hpp"
#include "sim/time.hpp"
#include "sim/units.hpp"

namespace takt::models {

/// The gates of a port as management sets them.
struct GateConfig {
  std::vector<GateControlEntry> admin_control_list;
  sim::Duration admin_cycle_time;
  sim::Duration admin_cycle_time_extension;
  sim::LocalTime admin_base_time;
  bool is_running = false;  ///< set before the start: a list whose base time lies in the past is in force then
  bool operator==(const GateConfig&) const = default;
};

// The transmission selection algorithms of IEEE 802.1Q 8.6.8 (Table 8-6).
/// 8.6.8.1: what waits may be sent.
struct StrictPriority {
  bool operator==(const StrictPriority&) const = default;
};
/// 8.6.8.2: what waits may be sent while the credit of the class is not negative.
struct CreditBased {
  sim::DataRate idle_slope;
  /// True: idle_slope is the class's bandwidth over the whole gate cycle, so credit grows faster while the gate is open
  /// (8.6.8.2 b). False: it is the rate of growth while the gate is open.
  bool of_whole_cycle = true;
  /// A network interface sends frames of the class at a launch time, too: each waits for its own first.
  bool has_launch_times = false;
  bool operator==(const CreditBased&) const = default;
};
/// Frames wait for their eligibility time and are sent in its order: ATS (8.6.8.5), and launch times of a network
/// interface.
struct TimeBased {
  bool operator==(const TimeBased&) const = default;
};
/// 8.6.8.3: the class shares what all classes with other algorithms leave with the others that have this one.
struct EnhancedTransmissionSelection {
  std::uint8_t bandwidth = 0;  ///< percent, 1 to 100; those of a port sum to 100
  bool operator==(const EnhancedTransmissionSelection&) const = default;
};
using SelectionAlgorithm = std::variant<StrictPriority, CreditBased, TimeBased, EnhancedTransmissionSelection>;

/// Frame preemption of a port (IEEE 802.1Q 6.7.2, 12.30; IEEE 802.3 clause 99).
struct PreemptionConfig {
  ClassSet preemptable = 0;  ///< the classes with frame preemption status preemptable; the others are express
  AddFragSize add_frag_size;
  /// How long before an entry that holds the MAC is asked to; as long as an express frame waits at most if absent.
  std::optional<sim::Duration> hold_advance;
  sim::Duration release_advance;
  bool operator==(const PreemptionConfig&) const = default;
};

struct ShapingConfig {
  GateStates admin_gate_states = all_gates_open;
  std::optional<GateConfig> gates;
  std::array<SelectionAlgorithm, traffic_class_count> selection{};
  std::array<Octets, traffic_class_count> queue_max_sdu{};  ///< octets after the EtherType; 0: any
  bool operator==(const ShapingConfig&) const = default;
  bool is_plain() const { return *this == ShapingConfig{}; }
  /// Null without a credit-based shaper.
  const CreditBased* shaper_of(TrafficClass q) const { return std::get_if<CreditBased>(&selection[q]); }
  bool is_shared(TrafficClass q) const { return std::holds_alternative<EnhancedTransmissionSelection>(selection[q]); }
  /// The classes that share bandwidth (ETS).
  ClassSet shared() const {
    ClassSet set = 0;
    for (TrafficClass q = 0; q < traffic_class_count; ++q)
      if (is_shared(q)) set = with(set, q);
    return set;
  }
  /// Its frames wait for a time of their own.
  bool is_timed(TrafficClass q) const {
    const CreditBased* const shaper = shaper_of(q);
    return shaper != nullptr ? shaper->has_launch_times : std::holds_alternative<TimeBased>(selection[q]);
  }
  ClassSet timed() const {
    ClassSet set = 0;
    for (TrafficClass q = 0; q < traffic_class_count; ++q)
      if (is_timed(q)) set = with(set, q);
    return set;
  }
  bool has_strict_priority_only() const { return selection == ShapingConfig{}.selection; }
};

}  // namespace takt::models
