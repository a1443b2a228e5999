// SPDX-License-Identifier: Apache-2.0
// Best timeTransmitter selection as a pure function: from what each port knows to its role, IEEE 802.1AS-2020 10.3.13.
#pragma once

#include <optional>
#include <vector>

#include "models/gptp/output.hpp"
#include "models/gptp/priority_vector.hpp"

namespace takt::models::gptp {

/// Where a port's vector comes from (infoIs).
enum class InfoIs : std::uint8_t { disabled, aged, mine, received };

struct PortInformation {
  InfoIs info_is = InfoIs::disabled;
  PriorityVector priority = {};  // if received or mine
};

struct Selection {
  PriorityVector grandmaster = {};   // gmPriority: steps_removed counts from this instance
  PortNumber receiver = 0;           // the port that is time receiver; 0: this instance is the grandmaster
  std::vector<PortRole> roles = {};  // [port - 1]

  /// What this instance announces at a port (masterPriority).
  PriorityVector announced_at(PortNumber port, ClockIdentity self) const {
    return {grandmaster.root, grandmaster.steps_removed, {self, port}, port};
  }
};

/// The roles of the ports of the instance `self`; ports[n - 1] is port n. `selection` is overwritten and keeps its
/// memory.
void select_roles(const SystemIdentity& self, const std::vector<PortInformation>& ports, Selection& selection);

}  // namespace takt::models::gptp
