#include "vocabulary/qos_of_thread.hpp"

namespace takt::vocabulary {

Qos merged(const std::optional<Qos>& topic, const std::optional<Qos>& thread) {
  Qos result = topic.value_or(Qos{});
  if (!thread) return result;
  const auto replace = [](auto& into, const auto& by) {
    if (by) into = by;
  };
  replace(result.reliability, thread->reliability);
  replace(result.max_blocking_time, thread->max_blocking_time);
  replace(result.durability, thread->durability);
  replace(result.history, thread->history);
  replace(result.depth, thread->depth);
  replace(result.deadline, thread->deadline);
  replace(result.latency_budget, thread->latency_budget);
  replace(result.liveliness, thread->liveliness);
  replace(result.lease_duration, thread->lease_duration);
  replace(result.ownership, thread->ownership);
  replace(result.ownership_strength, thread->ownership_strength);
  replace(result.lifespan, thread->lifespan);
  replace(result.time_based_filter, thread->time_based_filter);
  replace(result.destination_order, thread->destination_order);
  replace(result.resource_limits, thread->resource_limits);
  return result;
}

}  // namespace takt::vocabulary
