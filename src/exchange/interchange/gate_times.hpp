// SPDX-License-Identifier: Apache-2.0
// Times of gate lists on their way in and out: base times that are folded, lists that are rotated.
#pragma once

#include <vector>

#include "models/egress/shaping_config.hpp"
#include "scenario/description/description.hpp"

namespace takt::interchange {

struct FoldedTime {
  sim::Duration base;
  bool is_folded = false;
};

/// A base time in ns since an epoch, for a run that begins at 0: folded to 0 <= base < cycle if it is that of a running
/// clock (earliest_running_clock_ns). A cycle of 0 is left alone.
FoldedTime fold_base_time(sim::int128 base_ns, sim::Duration cycle);

/// A gate list as a device gets it: entries that fill the cycle exactly, and the time of its first cycle from 0 on.
struct DeviceGates {
  std::vector<models::GateControlEntry> entries;
  sim::Duration cycle;
  sim::Duration base;  ///< at least 0
  sim::Duration extension;
  bool was_filled = false;  ///< a last entry was lengthened, or cut off, to fit the cycle
};

/// What a list of takt means: entries beyond the cycle are cut off, a last one is lengthened to its end; a base time
/// before 0 is moved by whole cycles, and a list that is running is rotated so that it is in force from 0 on.
DeviceGates device_gates(const models::GateConfig& gates);

/// Lengthens entries shorter than `least` at the cost of the one before, where that only closes gates sooner, after
/// neighbours with equal states were joined. An entry with a single class is left alone: it is a window that somebody
/// needs. Returns those that stay too short or were lengthened.
struct Widened {
  std::size_t lengthened = 0;
  std::size_t too_short = 0;
};
Widened widen_short_entries(std::vector<models::GateControlEntry>& entries, sim::Duration least);

/// The same list, begun `by` later in its cycle (0 <= by < cycle); the entry that runs then is split.
std::vector<models::GateControlEntry> rotated(const std::vector<models::GateControlEntry>& entries, sim::Duration by);

}  // namespace takt::interchange
