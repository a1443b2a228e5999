// SPDX-License-Identifier: Apache-2.0
// What interfaces are called at the devices themselves: kept beside a scenario, whose ports have numbers.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace takt::interchange {

/// For each node, the interfaces in the order of its ports, each with its neighbour.
using InterfaceNames = std::map<std::string, std::vector<std::pair<std::string, std::string>>, std::less<>>;

}  // namespace takt::interchange
