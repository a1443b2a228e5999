// SPDX-License-Identifier: Apache-2.0
// The files of nodes that run a scenario's applications and gateways: one process on each host that has some. Pure.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::emulate {

/// The process with all applications and gateways of a node of the topology.
struct PlannedApplications {
  std::uint32_t host = 0;  ///< in the topology
  std::string name;        ///< unique: what its file is called
  std::string config;      ///< its file
  std::string interface;   ///< that its messages go through
  std::string address;     ///< of that interface, with the length of the prefix
};

/// What real nodes cannot do goes into `refusals`; what they leave out, into `left_out`. `is_bridge` by node of the
/// topology.
std::vector<PlannedApplications> application_files_of(const scenario::Resolved& resolved,
                                                      const std::vector<bool>& is_bridge,
                                                      std::set<std::string>& left_out,
                                                      std::vector<std::string>& refusals);

}  // namespace takt::emulate
