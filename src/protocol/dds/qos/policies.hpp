// SPDX-License-Identifier: Apache-2.0
// The QoS policies of DDS (DDS 1.4, 2.2.3) with the standard's defaults, and what each kind of entity has of them.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dds/message/time.hpp"
#include "sim/time.hpp"

namespace takt::dds {

/// RESOURCE_LIMITS: no limit.
inline constexpr std::int32_t unlimited = -1;

enum class ReliabilityKind : std::uint8_t { best_effort, reliable };
enum class DurabilityKind : std::uint8_t { volatile_, transient_local, transient, persistent };
enum class HistoryKind : std::uint8_t { keep_last, keep_all };
enum class LivelinessKind : std::uint8_t { automatic, manual_by_participant, manual_by_topic };
enum class OwnershipKind : std::uint8_t { shared, exclusive };
enum class DestinationOrderKind : std::uint8_t { by_reception_timestamp, by_source_timestamp };
enum class PresentationScope : std::uint8_t { instance, topic, group };

struct Reliability {
  ReliabilityKind kind = ReliabilityKind::best_effort;
  sim::Duration max_blocking_time =
      sim::Duration::from_ps(100'000'000'000);  ///< of a write when the history is full; 100 ms
  bool operator==(const Reliability&) const = default;
};
struct Durability {
  DurabilityKind kind = DurabilityKind::volatile_;
  bool operator==(const Durability&) const = default;
};
struct History {
  HistoryKind kind = HistoryKind::keep_last;
  std::int32_t depth = 1;  ///< samples of each instance, of KEEP_LAST
  bool operator==(const History&) const = default;
};
struct ResourceLimits {
  std::int32_t max_samples = unlimited;
  std::int32_t max_instances = unlimited;
  std::int32_t max_samples_per_instance = unlimited;
  bool operator==(const ResourceLimits&) const = default;
};
/// What the service that keeps TRANSIENT and PERSISTENT samples keeps.
struct DurabilityService {
  sim::Duration service_cleanup_delay{};
  History history;
  ResourceLimits resource_limits;
  bool operator==(const DurabilityService&) const = default;
};
struct Deadline {
  sim::Duration period = infinite;  ///< of each instance
  bool operator==(const Deadline&) const = default;
};
struct LatencyBudget {
  sim::Duration duration{};
  bool operator==(const LatencyBudget&) const = default;
};
struct Liveliness {
  LivelinessKind kind = LivelinessKind::automatic;
  sim::Duration lease_duration = infinite;
  bool operator==(const Liveliness&) const = default;
};
struct Ownership {
  OwnershipKind kind = OwnershipKind::shared;
  bool operator==(const Ownership&) const = default;
};
struct OwnershipStrength {
  std::int32_t value = 0;
  bool operator==(const OwnershipStrength&) const = default;
};
struct Lifespan {
  sim::Duration duration = infinite;  ///< from the source timestamp
  bool operator==(const Lifespan&) const = default;
};
struct TimeBasedFilter {
  sim::Duration minimum_separation{};  ///< of each instance
  bool operator==(const TimeBasedFilter&) const = default;
};
struct TransportPriority {
  std::int32_t value = 0;
  bool operator==(const TransportPriority&) const = default;
};
struct DestinationOrder {
  DestinationOrderKind kind = DestinationOrderKind::by_reception_timestamp;
  bool operator==(const DestinationOrder&) const = default;
};
/// Of the publisher and the subscriber; here with each of their endpoints, as on the wire.
struct Presentation {
  PresentationScope access_scope = PresentationScope::instance;
  bool coherent_access = false;
  bool ordered_access = false;
  bool operator==(const Presentation&) const = default;
};
/// Of the publisher and the subscriber. No name is the same as the one name "".
struct Partition {
  std::vector<std::string> names;
  bool operator==(const Partition&) const = default;
};
struct WriterDataLifecycle {
  bool autodispose_unregistered_instances = true;
  bool operator==(const WriterDataLifecycle&) const = default;
};
struct ReaderDataLifecycle {
  sim::Duration autopurge_nowriter_samples_delay = infinite;
  sim::Duration autopurge_disposed_samples_delay = infinite;
  bool operator==(const ReaderDataLifecycle&) const = default;
};
/// USER_DATA, TOPIC_DATA, GROUP_DATA: octets that discovery carries and nobody here reads.
struct OpaqueData {
  std::vector<std::byte> octets;
  bool operator==(const OpaqueData&) const = default;
};

struct TopicQos {
  Reliability reliability;
  Durability durability;
  DurabilityService durability_service;
  History history;
  ResourceLimits resource_limits;
  Deadline deadline;
  LatencyBudget latency_budget;
  Liveliness liveliness;
  Ownership ownership;
  Lifespan lifespan;
  TransportPriority transport_priority;
  DestinationOrder destination_order;
  OpaqueData topic_data;
  bool operator==(const TopicQos&) const = default;
};

/// A DataWriter's, with those of its publisher.
struct DataWriterQos {
  Reliability reliability{ReliabilityKind::reliable};
  Durability durability;
  DurabilityService durability_service;
  History history;
  ResourceLimits resource_limits;
  Deadline deadline;
  LatencyBudget latency_budget;
  Liveliness liveliness;
  Ownership ownership;
  OwnershipStrength ownership_strength;
  Lifespan lifespan;
  TransportPriority transport_priority;
  DestinationOrder destination_order;
  Presentation presentation;
  Partition partition;
  WriterDataLifecycle data_lifecycle;
  OpaqueData user_data;
  OpaqueData topic_data;
  OpaqueData group_data;
  bool operator==(const DataWriterQos&) const = default;
};

/// A DataReader's, with those of its subscriber.
struct DataReaderQos {
  Reliability reliability;
  Durability durability;
  History history;
  ResourceLimits resource_limits;
  Deadline deadline;
  LatencyBudget latency_budget;
  Liveliness liveliness;
  Ownership ownership;
  TimeBasedFilter time_based_filter;
  DestinationOrder destination_order;
  Presentation presentation;
  Partition partition;
  ReaderDataLifecycle data_lifecycle;
  OpaqueData user_data;
  OpaqueData topic_data;
  OpaqueData group_data;
  bool operator==(const DataReaderQos&) const = default;
};

/// What of a set of policies contradicts itself (DDS 1.4, INCONSISTENT_POLICY), each as "policy: what and why"; empty
/// if nothing does.
std::vector<std::string> problems_of(const TopicQos& qos);
std::vector<std::string> problems_of(const DataWriterQos& qos);
std::vector<std::string> problems_of(const DataReaderQos& qos);

}  // namespace takt::dds
