// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/dds_qos.hpp"

namespace takt::scenario {
namespace {

// The values of both sides have the same order.
template <class To, class From>
constexpr To same(From value) {
  return static_cast<To>(value);
}
static_assert(same<dds::ReliabilityKind>(plant::Reliability::reliable) == dds::ReliabilityKind::reliable);
static_assert(same<dds::DurabilityKind>(plant::Durability::persistent) == dds::DurabilityKind::persistent);
static_assert(same<dds::HistoryKind>(plant::History::keep_all) == dds::HistoryKind::keep_all);
static_assert(same<dds::LivelinessKind>(plant::Liveliness::manual_by_topic) == dds::LivelinessKind::manual_by_topic);
static_assert(same<dds::OwnershipKind>(plant::Ownership::exclusive) == dds::OwnershipKind::exclusive);
static_assert(same<dds::DestinationOrderKind>(plant::DestinationOrder::by_source) ==
              dds::DestinationOrderKind::by_source_timestamp);

std::int32_t limit(const std::optional<std::uint32_t>& value) {
  return value ? static_cast<std::int32_t>(*value) : dds::unlimited;
}

dds::ResourceLimits limits_of(const plant::ResourceLimits& limits) {
  return {limit(limits.max_samples), limit(limits.max_instances), limit(limits.max_samples_per_instance)};
}

/// What writers and readers have in common.
template <class To>
void set_common(const Qos& qos, std::uint32_t depth, To& made) {
  made.reliability.kind = same<dds::ReliabilityKind>(qos.reliability.value_or(Reliability::best_effort));
  if (qos.max_blocking_time) made.reliability.max_blocking_time = *qos.max_blocking_time;
  if (qos.durability) made.durability.kind = same<dds::DurabilityKind>(*qos.durability);
  if (qos.history) made.history.kind = same<dds::HistoryKind>(*qos.history);
  made.history.depth = static_cast<std::int32_t>(qos.depth.value_or(depth));
  if (qos.deadline) made.deadline.period = *qos.deadline;
  if (qos.latency_budget) made.latency_budget.duration = *qos.latency_budget;
  if (qos.liveliness) made.liveliness.kind = same<dds::LivelinessKind>(*qos.liveliness);
  if (qos.lease_duration) made.liveliness.lease_duration = *qos.lease_duration;
  if (qos.ownership) made.ownership.kind = same<dds::OwnershipKind>(*qos.ownership);
  if (qos.destination_order) made.destination_order.kind = same<dds::DestinationOrderKind>(*qos.destination_order);
  if (qos.resource_limits) made.resource_limits = limits_of(*qos.resource_limits);
  if (qos.partition) made.partition.names = *qos.partition;
}

}  // namespace

dds::DataWriterQos writer_qos(const Qos& qos, std::int32_t transport_priority) {
  dds::DataWriterQos made;
  set_common(qos, 1, made);
  if (qos.ownership_strength) made.ownership_strength.value = *qos.ownership_strength;
  if (qos.lifespan) made.lifespan.duration = *qos.lifespan;
  made.transport_priority.value = transport_priority;
  if (const auto& service = qos.durability_service) {
    made.durability_service.service_cleanup_delay = service->cleanup_delay.value_or(Duration());
    if (service->history) made.durability_service.history.kind = same<dds::HistoryKind>(*service->history);
    made.durability_service.history.depth = static_cast<std::int32_t>(service->depth.value_or(1));
    if (service->resource_limits) made.durability_service.resource_limits = limits_of(*service->resource_limits);
  }
  return made;
}

dds::DataReaderQos reader_qos(const Qos& qos, std::uint32_t buffer) {
  dds::DataReaderQos made;
  set_common(qos, buffer, made);
  if (qos.time_based_filter) made.time_based_filter.minimum_separation = *qos.time_based_filter;
  return made;
}

}  // namespace takt::scenario
