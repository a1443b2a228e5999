// SPDX-License-Identifier: Apache-2.0
// What JSON files say of the quality of service of DDS (OMG DDS 1.4, 2.2.3), wherever it runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "sim/time.hpp"

namespace takt::plant {

using sim::Duration;

enum class Reliability : std::uint8_t { best_effort, reliable };
enum class Durability : std::uint8_t { volatile_, transient_local, transient, persistent };
enum class History : std::uint8_t { keep_last, keep_all };
enum class Liveliness : std::uint8_t { automatic, manual_by_participant, manual_by_topic };
enum class Ownership : std::uint8_t { shared, exclusive };
enum class DestinationOrder : std::uint8_t { by_reception, by_source };

/// Absent: no limit.
struct ResourceLimits {
  json::Source where;
  std::optional<std::uint32_t> max_samples;
  std::optional<std::uint32_t> max_instances;
  std::optional<std::uint32_t> max_samples_per_instance;
  bool operator==(const ResourceLimits&) const = default;
};

/// What a persistence service keeps of a topic. What is absent has the default of DDS.
struct DurabilityService {
  json::Source where;
  std::optional<Duration> cleanup_delay;
  std::optional<History> history;
  std::optional<std::uint32_t> depth;
  std::optional<ResourceLimits> resource_limits;
  bool operator==(const DurabilityService&) const = default;
};

/// Quality of service of a writer and of its readers. What is absent has the default of DDS, or what the topic says.
struct Qos {
  json::Source where;
  std::optional<Reliability> reliability;
  std::optional<Duration> max_blocking_time;
  std::optional<Durability> durability;
  std::optional<History> history;
  std::optional<std::uint32_t> depth;
  std::optional<Duration> deadline;
  std::optional<Duration> latency_budget;
  std::optional<Liveliness> liveliness;
  std::optional<Duration> lease_duration;
  std::optional<Ownership> ownership;
  std::optional<std::int32_t> ownership_strength;
  std::optional<Duration> lifespan;
  std::optional<Duration> time_based_filter;
  std::optional<DestinationOrder> destination_order;
  std::optional<ResourceLimits> resource_limits;
  std::optional<DurabilityService> durability_service;
  std::optional<std::vector<std::string>> partition;
  bool operator==(const Qos&) const = default;
};

const json::Enumeration& describe(json::Type<Reliability>);
const json::Enumeration& describe(json::Type<Durability>);
const json::Enumeration& describe(json::Type<History>);
const json::Enumeration& describe(json::Type<Liveliness>);
const json::Enumeration& describe(json::Type<Ownership>);
const json::Enumeration& describe(json::Type<DestinationOrder>);
const json::Object& describe(json::Type<ResourceLimits>);
const json::Object& describe(json::Type<DurabilityService>);
const json::Object& describe(json::Type<Qos>);

}  // namespace takt::plant
