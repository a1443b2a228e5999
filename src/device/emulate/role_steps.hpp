// SPDX-License-Identifier: Apache-2.0
// Of what candidates have logged, which steps are those of a role's participant, by the observer that the simulator
// has, too.
#pragma once

#include <string>
#include <vector>

#include "emulate/log_reader.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::emulate {

/// Which nodes a role has had, in this order. "" is nobody.
struct RoleHistory {
  std::vector<std::string> nodes;
  bool operator==(const RoleHistory&) const = default;
};

struct RoleSteps {
  std::vector<LoggedStep> steps;  ///< of participants and in the order of time: without those that are nobody's
  std::vector<std::vector<RoleHistory>> histories;  ///< by Program and role
};

/// `steps` of all nodes; those of one node in its order.
RoleSteps steps_of_roles(const scenario::Resolved& resolved, std::vector<LoggedStep> steps);

}  // namespace takt::emulate
