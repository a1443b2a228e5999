// SPDX-License-Identifier: Apache-2.0
#include "plant/qos_of_thread.hpp"

namespace takt::plant {
namespace {

/// Numbers and times that are out of range stand as zero, which the tables refuse for all of these.
template <class Value>
void drop_refused(std::optional<Value>& value) {
  if (value == Value{}) value.reset();
}

void drop_refused(std::optional<ResourceLimits>& limits) {
  if (!limits) return;
  drop_refused(limits->max_samples);
  drop_refused(limits->max_instances);
  drop_refused(limits->max_samples_per_instance);
}

void drop_refused(Qos& qos) {
  drop_refused(qos.depth);
  drop_refused(qos.deadline);
  drop_refused(qos.lease_duration);
  drop_refused(qos.lifespan);
  drop_refused(qos.resource_limits);
  if (!qos.durability_service) return;
  drop_refused(qos.durability_service->depth);
  drop_refused(qos.durability_service->resource_limits);
}

}  // namespace

Qos merged(const std::optional<Qos>& topic, const std::optional<Qos>& thread) {
  Qos result = topic.value_or(Qos{});
  drop_refused(result);
  if (!thread) return result;
  Qos own = *thread;
  drop_refused(own);
  const auto replace = [](auto& into, const auto& by) {
    if (by) into = by;
  };
  replace(result.reliability, own.reliability);
  replace(result.max_blocking_time, own.max_blocking_time);
  replace(result.durability, own.durability);
  replace(result.history, own.history);
  replace(result.depth, own.depth);
  replace(result.deadline, own.deadline);
  replace(result.latency_budget, own.latency_budget);
  replace(result.liveliness, own.liveliness);
  replace(result.lease_duration, own.lease_duration);
  replace(result.ownership, own.ownership);
  replace(result.ownership_strength, own.ownership_strength);
  replace(result.lifespan, own.lifespan);
  replace(result.time_based_filter, own.time_based_filter);
  replace(result.destination_order, own.destination_order);
  replace(result.resource_limits, own.resource_limits);
  replace(result.durability_service, own.durability_service);
  replace(result.partition, own.partition);
  return result;
}

}  // namespace takt::plant
