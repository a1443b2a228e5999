// What management sets of a port beyond strict priority: gates, shapers, maximum SDU sizes.
#pragma once

#include <array>
#include <optional>
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
  bool operator==(const GateConfig&) const = default;
};

/// The credit-based shaper of a class.
struct ShaperConfig {
  sim::DataRate idle_slope;
  /// True: idle_slope is the class's bandwidth over the whole gate cycle, so credit grows faster while the gate is open
  /// (8.6.8.2 b). False: it is the rate of growth while the gate is open.
  bool of_whole_cycle = true;
  bool operator==(const ShaperConfig&) const = default;
};

/// Frame preemption of a port (IEEE 802.1Q 6.7.2, 12.30; IEEE 802.3 clause 99).
struct PreemptionConfig {
  ClassSet preemptable = 0;                         ///< the classes with frame preemption status preemptable; the others are express
  AddFragSize add_frag_size;
  /// How long before an entry that holds the MAC is asked to; as long as an express frame waits at most if absent.
  std::optional<sim::Duration> hold_advance;
  sim::Duration release_advance;
  bool operator==(const PreemptionConfig&) const = default;
};

struct ShapingConfig {
  GateStates admin_gate_states = all_gates_open;
  std::optional<GateConfig> gates;
  std::array<std::optional<ShaperConfig>, traffic_class_count> shapers{};
  std::array<Octets, traffic_class_count> queue_max_sdu{};  ///< octets after the EtherType; 0: any
  /// Classes whose frames wait for their eligibility time and are sent in its order: those with ATS (8.6.8.5), and those that
  /// a network interface sends at a launch time.
  ClassSet timed = 0;
  bool operator==(const ShapingConfig&) const = default;
  bool is_plain() const { return *this == ShapingConfig{}; }
};

}  // namespace takt::models
