// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/port_configs.hpp"

#include <algorithm>

namespace takt::scenario {

const models::PortConfig& port_config_of(const models::NetworkPlan& plan, const models::LinkPlan::End& end) {
  return plan.port_configs[end.port_config.value_or(plan.nodes[end.node.value].port_config)];
}

models::PortConfig port_config_of(const NodePorts& ports) {
  models::PortConfig config;
  const Queues& queues = ports.queues;
  config.traffic_class_of_priority = class_of_priorities(ports.traffic_classes);
  for (models::QueueLimit& limit : config.queue_limits) {
    if (queues.frames) limit.frames = *queues.frames;
    if (queues.octets) limit.octets = queues.octets->count;
    limit.drops_oldest = queues.drop == FullQueue::oldest;
  }
  for (const Queues::PerClass& one : queues.classes) {
    models::QueueLimit& limit = config.queue_limits[one.traffic_class];
    if (one.frames) limit.frames = *one.frames;
    if (one.octets) limit.octets = one.octets->count;
    if (one.drop) limit.drops_oldest = *one.drop == FullQueue::oldest;
  }
  for (models::QueueLimit& limit : config.queue_limits)
    if (!limit.is_finite()) limit.drops_oldest = false;  // so that ports which act alike share their configuration
  return config;
}

std::uint32_t port_config_index(models::NetworkPlan& plan, const models::PortConfig& config) {
  const auto found = std::find(plan.port_configs.begin(), plan.port_configs.end(), config);
  const auto index = static_cast<std::uint32_t>(found - plan.port_configs.begin());
  if (found == plan.port_configs.end()) plan.port_configs.push_back(config);
  return index;
}

}  // namespace takt::scenario
