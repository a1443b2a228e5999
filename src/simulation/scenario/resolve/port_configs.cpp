// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/port_configs.hpp"

#include <algorithm>

namespace takt::scenario {

const models::PortConfig& port_config_of(const models::NetworkPlan& plan, const models::LinkPlan::End& end) {
  return plan.port_configs[end.port_config.value_or(plan.nodes[end.node.value].port_config)];
}

std::uint32_t port_config_index(models::NetworkPlan& plan, const models::PortConfig& config) {
  const auto found = std::find(plan.port_configs.begin(), plan.port_configs.end(), config);
  const auto index = static_cast<std::uint32_t>(found - plan.port_configs.begin());
  if (found == plan.port_configs.end()) plan.port_configs.push_back(config);
  return index;
}

}  // namespace takt::scenario
