// SPDX-License-Identifier: Apache-2.0
// What topics, applications and gateways come down to. See scenario/resolved/resolved.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "application/topic_shape.hpp"
#include "gateway/content_filter.hpp"
#include "models/ethernet/frame.hpp"
#include "scenario/description/applications.hpp"
#include "sim/distribution.hpp"

namespace takt::scenario {

struct ResolvedTopic {
  const Topic* description = nullptr;
  application::TopicShape shape;
  std::uint16_t publisher_id = 0;  ///< of OPC UA
};

/// A publication that a subscribing thread hears.
struct ResolvedInput {
  std::uint32_t application = 0;  ///< that publishes
  std::uint32_t thread = 0;       ///< of it
  models::StreamIndex stream;     ///< of OPC UA; none of DDS, where participants hear streams
};

struct ResolvedThread {
  std::string name;
  bool publishes = false;
  std::uint32_t topic = 0;
  Duration every;
  Duration offset;
  sim::Distribution response = sim::Distribution::constant({});
  std::optional<std::uint64_t> tests;  ///< at most, of the scheduler
  Payload payload;                     ///< of what it publishes
  std::optional<std::uint32_t>
      copies;  ///< instead: the subscribing thread of the application whose last sample it publishes
  std::uint32_t buffer = 1;
  std::optional<std::uint32_t> signal;  ///< that it drives
  std::optional<std::uint32_t> round_trip =
      {};                                     ///< the publishing thread of the application whose values come back here
  bool is_measured = false;                   ///< it is such a one
  std::uint16_t writer_group = 0;             ///< of a publication over OPC UA: from 1 on among those of its topic
  std::optional<models::StreamIndex> stream;  ///< of such a publication that anybody hears
  std::optional<std::uint32_t> participant;   ///< of DDS, in resolved.dds
  Qos qos;                                    ///< of DDS: the topic's and its own
  const Qos* own_qos = nullptr;               ///< what the thread itself says; or null
  std::int32_t transport_priority = 0;        ///< of DDS: which streams carry its samples
  std::optional<gateway::ContentFilter> filter =
      {};  ///< of a subscription over DDS; how many values it lets pass nobody knows, so none are expected
  std::vector<ResolvedInput> inputs;             ///< of a subscription
  Duration window;                               ///< of criterion 1
  Duration value_window;                         ///< of criterion 2
  std::uint64_t values_expected = 0;             ///< in such a window
  std::optional<std::uint32_t> cpu_thread = {};  ///< of the host's processor, on which its calls run
  json::Source where;
};

/// A thread receives, another sends; between them a buffer.
struct ResolvedGateway {
  std::uint32_t capacity = 1;
  Overflow overflow = Overflow::overwrite_oldest;
  std::optional<Duration> stale_after;
};

/// Keeps topics of DDS for readers that come when their writers are gone.
struct ResolvedService {
  struct Kept {
    std::uint32_t topic = 0;
    std::optional<std::uint32_t> participant;  ///< in resolved.dds
    std::int32_t transport_priority = 0;
    Qos qos;  ///< the topic's
    json::Place where;
  };
  std::vector<Kept> topics;
};

struct ResolvedApplication {
  std::string name;
  models::NodeIndex node;
  std::vector<ResolvedThread> threads;  ///< of a gateway: receive, send; of a persistence service none
  const Scheduler* scheduler = nullptr;
  sim::Distribution scheduler_response = sim::Distribution::constant({});
  std::optional<ResolvedGateway> gateway;
  std::optional<ResolvedService> service;
  std::optional<std::uint32_t> cpu_thread =
      {};  ///< of the host's processor, on which it takes what comes, and its participants run
  json::Source where;
};

struct ResolvedSignal {
  std::string name;
  Duration pulse;  ///< nominal
  std::uint32_t application = 0;
  std::uint32_t thread = 0;
};

}  // namespace takt::scenario
