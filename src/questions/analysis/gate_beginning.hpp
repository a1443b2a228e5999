// SPDX-License-Identifier: Apache-2.0
// When gate lists come into force, in true time: their base times are read on clocks that may be slow, and wrong from
// the start.
#pragma once

#include <optional>

#include "analysis/bounds.hpp"
#include "analysis/port_bound.hpp"

namespace takt::analysis {

class GateBeginning {
 public:
  GateBeginning(const scenario::Resolved& resolved, const BoundOptions& options) : r_(resolved), options_(options) {}

  /// The latest instant, since the start, at which a list comes into force that is written at `node` at `from`. A list
  /// whose base time is over begins with the next cycle of its own, unless it has been running since before the start;
  /// until then all gates are as they were (IEEE 802.1Q 8.6.9.1.1).
  template <class Config>
  sim::Duration latest(models::NodeIndex node, const Config& gates, sim::Duration from = {}) {
    if (gates.is_running && is_over_at_the_start(node, gates.admin_base_time)) return {};
    return latest(node, gates.admin_base_time, gates.admin_cycle_time, from);
  }

  /// From when on every gate list of the scenario runs that it does not exchange later; 0 if all do from the start.
  sim::Duration latest_of_all();

 private:
  sim::Duration latest(models::NodeIndex node, sim::LocalTime base_time, sim::Duration cycle, sim::Duration from);
  /// The node's clock shows that time, or a later one, at the start.
  bool is_over_at_the_start(models::NodeIndex node, sim::LocalTime time) const;
  const ClockQuality& quality_of(models::NodeIndex node);

  const scenario::Resolved& r_;
  const BoundOptions& options_;
  std::optional<ClockQuality> of_gptp_;  // the same for all that follow one time
  ClockQuality other_;
};

}  // namespace takt::analysis
